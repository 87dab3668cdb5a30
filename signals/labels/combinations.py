"""Sums beyond the families: j f_m with one or two modulating bases, for peaks that nothing else explains.

A nonlinear machine makes every such intermodulation product, so a family of them all would explain any peak by
chance. They are ranked by how many bases modulate the mesh, then by the sum of those |orders|; the order of the mesh
itself is free, for its harmonics are the carriers and their number does not make a neighbourhood denser. Whether a
sum of some rank explains anything is decided in `signals.labels.explain`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass
from itertools import combinations as pairs

import numpy as np

from signals.labels.families import MECHANISM, Bound
from signals.labels.kinematics import Kinematics
from signals.series import FloatArray, IntArray
from sim.core.lines import Line

FAMILY = "combination"
INTERMODULATION = "intermodulation"
RANK_STEP = 1000
"""Rank of one modulating base more; sums of orders stay below it."""
MAX_SUMS = 500_000
"""Sums looked at; machines of many different bearings leave out the pairs listed last."""


@dataclass(frozen=True, kw_only=True)
class Modulator:
    """A base that may modulate the mesh: its largest |order| and the components it may belong to."""

    base: str
    frequency_hz: float
    reach: int
    components: tuple[str, ...]


@dataclass(frozen=True, kw_only=True)
class Grid:
    """All sums of one mesh and its modulators: `orders` shape (sums, bases), frequencies and ranks (sums,)."""

    carrier: str
    component: str
    modulators: tuple[Modulator, ...]
    orders: IntArray
    frequency_hz: FloatArray
    rank: IntArray

    def lines(self, row: int) -> Iterator[Line]:
        """The sum with each component that takes part, so that merging collects them."""
        numbers = self.orders[row].tolist()
        bases = [*([self.carrier] if self.carrier else []), *(m.base for m in self.modulators)]
        kept = tuple((base, n) for base, n in zip(bases, numbers, strict=True) if n)
        # the mesh is the carrier: it counts as a component only where nothing modulates it
        names = [c for m in self.modulators for c in m.components] or [self.component]
        for name in names:
            yield Line(orders=kept, component=name, mechanism=INTERMODULATION, family=FAMILY)


def rank_of(orders: Sequence[tuple[str, int]], carriers: Sequence[str]) -> int:
    """Rank of a sum: modulating bases first, then the sum of their |orders|."""
    modulating = [abs(n) for base, n in orders if n and base not in carriers]
    return RANK_STEP * len(modulating) + sum(modulating)


def modulators(
    kinematics: Kinematics, bases_hz: Mapping[str, float], lines: Sequence[Line], bound: Bound
) -> tuple[Modulator, ...]:
    """Shafts and ball passes that may modulate; bases of one frequency are one.

    Where terms of the physics say which bases they excite, only those count; lines of mere kinematics say nothing
    about that, so without terms (a measured signal) every shaft and every ball pass counts.
    """
    told = {base for line in lines if line.mechanism != MECHANISM for base, _ in line.orders}
    wheels = {m.pinion_shaft: m.pinion for m in kinematics.meshes} | {m.gear_shaft: m.gear for m in kinematics.meshes}
    known = [(s.base, bound.combination_shaft, wheels.get(s.base, s.component)) for s in kinematics.shafts]
    known += [(shaft, bound.combination_shaft, wheel) for shaft, wheel in wheels.items()]
    for bearing in kinematics.bearings:
        known.append((bearing.base("o"), bound.combination_outer, bearing.site))
        if told:
            known += [(bearing.base(x), bound.combination_outer, bearing.site) for x in "ibc"]
    found: dict[int, Modulator] = {}
    for base, reach, component in known:
        if base not in bases_hz or (told and base not in told):
            continue
        place = round(bases_hz[base] * 1e6)
        other = found.get(place)
        components = (component,) if other is None else tuple(dict.fromkeys((*other.components, component)))
        name = base if other is None else other.base
        found[place] = Modulator(base=name, frequency_hz=bases_hz[base], reach=reach, components=components)
    return tuple(found.values())


def grids(
    kinematics: Kinematics, bases_hz: Mapping[str, float], lines: Sequence[Line], *, top_hz: float, bound: Bound
) -> tuple[Grid, ...]:
    """Sums of every mesh with none, one and two modulators below `top_hz`; without a mesh, of the modulators alone."""
    available = modulators(kinematics, bases_hz, lines, bound)
    carriers = [(m.base, m.component) for m in kinematics.meshes if m.base in bases_hz] or [("", "")]
    sets: list[tuple[Modulator, ...]] = [(), *((m,) for m in available), *pairs(available, 2)]
    result: list[Grid] = []
    total = 0
    for chosen in sets:
        for carrier, component in carriers:
            grid = _grid(carrier, component, chosen, bases_hz, top_hz)
            total += grid.rank.size
            if total > MAX_SUMS:
                return tuple(result)
            if grid.rank.size:
                result.append(grid)
    return tuple(result)


def _grid(
    carrier: str, component: str, chosen: tuple[Modulator, ...], bases_hz: Mapping[str, float], top_hz: float
) -> Grid:
    axes = [_both(m.reach) for m in chosen]
    hz = [m.frequency_hz for m in chosen]
    if carrier:
        # modulation may fold harmonics beyond the axis back into it
        over = sum(m.reach * m.frequency_hz for m in chosen)
        axes.insert(0, np.arange(int((top_hz + over) / bases_hz[carrier]) + 1))
        hz.insert(0, bases_hz[carrier])
    if not axes:
        orders = np.zeros((0, 0), dtype=np.int64)
    else:
        orders = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes)).astype(np.int64)
    signed = orders @ np.array(hz) if axes else np.zeros(0)
    frequency = np.abs(signed)
    modulating = np.abs(orders[:, 1:] if carrier else orders)
    # a sum that is zero by construction comes out as rounding
    kept = (frequency > 1e-6 * min(hz, default=1.0)) & (frequency <= top_hz)
    return Grid(
        carrier=carrier,
        component=component,
        modulators=chosen,
        orders=orders[kept],
        frequency_hz=frequency[kept],
        rank=np.asarray(RANK_STEP * len(chosen) + modulating.sum(axis=1), dtype=np.int64)[kept],
    )


def _both(reach: int) -> IntArray:
    """-reach .. -1, 1 .. reach: a modulator of order zero belongs to a smaller grid."""
    return np.asarray([n for n in range(-reach, reach + 1) if n], dtype=np.int64)
