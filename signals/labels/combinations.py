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

from signals.labels.canonical import Told, told_series
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
class Carrier:
    """A base whose harmonics go on without bound, and what they are called: a mesh, or the balls of a bearing that a
    term makes felt (each ball that enters or leaves the load zone makes a kink).
    """

    base: str
    makers: tuple[tuple[str, str], ...]
    """Components, each with a mechanism that makes the series there."""
    family: str
    strong: bool
    """Whether the order is free, as that of a mesh; the passing of balls is weak and ranks as a modulation does."""

    @property
    def components(self) -> tuple[str, ...]:
        """Where the series may come from."""
        return tuple(dict.fromkeys(name for name, _ in self.makers))


@dataclass(frozen=True, kw_only=True)
class Grid:
    """All sums of a carrier and its modulators: `orders` shape (sums, bases), frequencies and ranks (sums,).

    `mechanisms`, `family`: what modulated sums are called. `series`: a defect's own lines, no product of others.
    """

    carrier: Carrier | None
    modulators: tuple[Modulator, ...]
    orders: IntArray
    frequency_hz: FloatArray
    rank: IntArray
    mechanisms: tuple[str, ...] = (INTERMODULATION,)
    family: str = FAMILY
    series: bool = False

    def lines(self, row: int) -> Iterator[Line]:
        """The sum with each component that takes part, so that merging collects them."""
        numbers = self.orders[row].tolist()
        bases = [*([self.carrier.base] if self.carrier else []), *(m.base for m in self.modulators)]
        kept = tuple((base, n) for base, n in zip(bases, numbers, strict=True) if n)
        if self.carrier and not self.modulators:
            for name, mechanism in self.carrier.makers:
                yield Line(orders=kept, component=name, mechanism=mechanism, family=self.carrier.family)
        # the carrier counts as a component only where nothing modulates it
        for name in (c for m in self.modulators for c in m.components):
            for mechanism in self.mechanisms:
                yield Line(orders=kept, component=name, mechanism=mechanism, family=self.family)


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
    """Harmonics of every carrier below `top_hz`, then sums of two meshes, then of every mesh with one and two
    modulators; without a mesh, of the modulators alone.
    """
    available = modulators(kinematics, bases_hz, lines, bound)
    meshes, balls = carriers(kinematics, bases_hz, lines)
    sets: list[tuple[Modulator, ...]] = [*((m,) for m in available), *pairs(available, 2)]
    plan: list[tuple[Carrier | None, tuple[Modulator, ...]]] = [(carrier, ()) for carrier in (*meshes, *balls)]
    plan += [(first, (_second(mesh, bases_hz, bound),)) for first, mesh in pairs(meshes, 2)]
    plan += [(carrier, chosen) for chosen in sets for carrier in (meshes or (None,))]
    result: list[Grid] = []
    total = 0
    for carrier, chosen in plan:
        grid = _grid(carrier, chosen, bases_hz, top_hz)
        total += grid.rank.size
        if total > MAX_SUMS:
            return tuple(result)
        if grid.rank.size:
            result.append(grid)
    return tuple(result)


def _second(mesh: Carrier, bases_hz: Mapping[str, float], bound: Bound) -> Modulator:
    """A mesh that modulates another: the shaft between them carries the motion of both."""
    return Modulator(
        base=mesh.base, frequency_hz=bases_hz[mesh.base], reach=bound.combination_mesh, components=mesh.components
    )


def carriers(
    kinematics: Kinematics, bases_hz: Mapping[str, float], lines: Sequence[Line]
) -> tuple[tuple[Carrier, ...], tuple[Carrier, ...]]:
    """Meshes, and ball passes that a term predicts; bearings of one frequency are one."""
    told = told_series(lines)

    def made(base: str, sites: Sequence[tuple[str, str]], family: str) -> Carrier:
        known = told.get(frozenset({base}), Told(mechanisms=(MECHANISM,), family=family))
        makers = tuple((site, m) for own, site in sites for m in told.get(frozenset({own}), known).mechanisms)
        return Carrier(base=base, makers=makers, family=known.family, strong=family == "mesh")

    meshes = tuple(made(m.base, [(m.base, m.component)], "mesh") for m in kinematics.meshes if m.base in bases_hz)
    sites: dict[int, list[tuple[str, str]]] = {}
    for bearing in kinematics.bearings:
        base = bearing.base("o")
        if base in bases_hz:
            sites.setdefault(round(bases_hz[base] * 1e6), []).append((base, bearing.site))
    balls = []
    for found in sites.values():
        known = [base for base, _ in found if frozenset({base}) in told]
        balls += [made(known[0], found, "outer")] if known else []
    return meshes, tuple(balls)


def _grid(carrier: Carrier | None, chosen: tuple[Modulator, ...], bases_hz: Mapping[str, float], top_hz: float) -> Grid:
    axes = [_both(m.reach) for m in chosen]
    hz = [m.frequency_hz for m in chosen]
    if carrier:
        # modulation may fold harmonics beyond the axis back into it
        over = sum(m.reach * m.frequency_hz for m in chosen)
        axes.insert(0, np.arange(int((top_hz + over) / bases_hz[carrier.base]) + 1))
        hz.insert(0, bases_hz[carrier.base])
    if not axes:
        orders = np.zeros((0, 0), dtype=np.int64)
    else:
        orders = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes)).astype(np.int64)
    signed = orders @ np.array(hz) if axes else np.zeros(0)
    frequency = np.abs(signed)
    modulating = np.abs(orders[:, 1:] if carrier else orders)
    rank = RANK_STEP * len(chosen) + modulating.sum(axis=1)
    if carrier and not carrier.strong:
        rank = rank + RANK_STEP + np.abs(orders[:, 0])
    # a sum that is zero by construction comes out as rounding
    kept = (frequency > 1e-6 * min(hz, default=1.0)) & (frequency <= top_hz)
    return Grid(
        carrier=carrier,
        modulators=chosen,
        orders=orders[kept],
        frequency_hz=frequency[kept],
        rank=np.asarray(rank, dtype=np.int64)[kept],
    )


def _both(reach: int) -> IntArray:
    """-reach .. -1, 1 .. reach: a modulator of order zero belongs to a smaller grid."""
    return np.asarray([n for n in range(-reach, reach + 1) if n], dtype=np.int64)
