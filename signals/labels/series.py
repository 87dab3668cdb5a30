"""Series of local defects to the end of the spectrum: k f_i +- n f_r, 2k f_b +- n f_c, k f_o; k f_m +- n f_r of teeth.

Balls strike a pit within microseconds and ring the resonances of the machine, so that the strong lines are those of
high order near a resonance, not the first multiples: R. B. Randall and J. Antoni, "Rolling element bearing
diagnostics - a tutorial", Mech. Syst. Signal Process. 25 (2011) 485-520, sections 2 and 5. A pit on the inner race is
carried through the load zone once a turn of the shaft, one on a ball once a turn of the cage: sidebands. A wheel whose
teeth differ repeats itself once a turn only: every multiple of its shaft's speed, the sidebands of the mesh up to half
its teeth (P. D. McFadden, J. Vib. Acoust. Stress Reliab. Des. 108 (1986) 165-170).

A series goes on beyond the bound of the families where a term of the machine predicts its base, or, where no term is
known at all, where its family was found.
"""

from __future__ import annotations

from collections.abc import Collection, Iterator, Mapping, Sequence

import numpy as np

from signals.labels.canonical import Told, told_series
from signals.labels.combinations import RANK_STEP, Carrier, Grid, Modulator
from signals.labels.families import MECHANISM, Bound
from signals.labels.kinematics import BearingKinematics, Kinematics
from sim.core.lines import Line

FAMILIES = {"o": "outer", "i": "inner", "b": "ball"}
EVERY = {"o": 1, "i": 1, "b": 2}
"""Multiples of the base that a defect makes: one on a ball strikes both races in a turn of the ball."""


def series_grids(
    kinematics: Kinematics,
    bases_hz: Mapping[str, float],
    lines: Sequence[Line],
    *,
    found: Collection[str],
    top_hz: float,
    bound: Bound,
) -> Iterator[Grid]:
    """Series of every defect that a term predicts; without any term, of those whose base is among the `found`.

    Bearings of one frequency are one: the series is named after the first that a term speaks of. The ball pass that a
    term predicts is a carrier of `combinations`.
    """
    told = told_series(lines)
    for letter, family in FAMILIES.items():
        for alike in _alike(kinematics, bases_hz, letter):
            spoken = [b for b in alike if frozenset({b.base(letter)}) in told and letter != "o"]
            acting = spoken if told else [b for b in alike if b.base(letter) in found]
            if not acting:
                continue
            base = acting[0].base(letter)
            words = told.get(frozenset({base}), Told(mechanisms=(MECHANISM,), family=family))
            # which of equal bearings it is, a term alone can say
            sites = tuple(b.site for b in (acting if told else alike))
            makers = tuple((site, m) for site in sites for m in words.mechanisms)
            carrier = Carrier(base=base, makers=makers, family=words.family, strong=True)
            yield _grid(carrier, _side(acting[0], letter, bases_hz, sites, bound), bases_hz, EVERY[letter], top_hz)


def tooth_grids(
    kinematics: Kinematics, bases_hz: Mapping[str, float], lines: Sequence[Line], *, top_hz: float
) -> Iterator[Grid]:
    """Sidebands of each mesh to half the teeth of each wheel of which a term predicts more than the first sidebands:
    what varies smoothly over a turn, as run-out does, makes the first alone.
    """
    uneven = {line.mechanism for line in lines if len(line.orders) > 1 and line.orders[-1][1] not in (-1, 0, 1)}
    told = told_series(line for line in lines if line.mechanism in uneven)
    for mesh in kinematics.meshes:
        wheels = (
            (mesh.pinion_shaft, mesh.pinion_teeth, mesh.pinion),
            (mesh.gear_shaft, mesh.gear_teeth, mesh.gear),
        )
        for shaft, teeth, wheel in wheels:
            words = told.get(frozenset({mesh.base, shaft}))
            if words is None or mesh.base not in bases_hz or shaft not in bases_hz:
                continue
            makers = tuple((wheel, mechanism) for mechanism in words.mechanisms)
            carrier = Carrier(base=mesh.base, makers=makers, family=words.family, strong=True)
            side = Modulator(base=shaft, frequency_hz=bases_hz[shaft], reach=(teeth + 1) // 2, components=(wheel,))
            yield _grid(carrier, side, bases_hz, 1, top_hz)


def _alike(
    kinematics: Kinematics, bases_hz: Mapping[str, float], letter: str
) -> tuple[tuple[BearingKinematics, ...], ...]:
    """Bearings that share a base's frequency."""
    places: dict[int, list[BearingKinematics]] = {}
    for bearing in kinematics.bearings:
        if bearing.base(letter) in bases_hz:
            places.setdefault(round(bases_hz[bearing.base(letter)] * 1e6), []).append(bearing)
    return tuple(tuple(bearings) for bearings in places.values())


def _side(
    bearing: BearingKinematics, letter: str, bases_hz: Mapping[str, float], sites: tuple[str, ...], bound: Bound
) -> Modulator | None:
    """What carries the defect through the load zone; nothing where it stands still."""
    base, reach = {
        "o": ("", 0),
        "i": (bearing.shaft, bound.series_shaft_sidebands),
        "b": (bearing.base("c"), bound.series_cage_sidebands),
    }[letter]
    if not reach or base not in bases_hz:
        return None
    return Modulator(base=base, frequency_hz=bases_hz[base], reach=reach, components=sites)


def _grid(carrier: Carrier, side: Modulator | None, bases_hz: Mapping[str, float], every: int, top_hz: float) -> Grid:
    """All multiples with their sidebands; ranked by the sidebands alone, for the order of the series is free."""
    hz = bases_hz[carrier.base]
    over = side.reach * side.frequency_hz if side else 0.0
    multiples = np.arange(every, int((top_hz + over) / hz) + 1, every, dtype=np.int64)
    axes = [multiples] + ([np.arange(-side.reach, side.reach + 1, dtype=np.int64)] if side else [])
    orders = np.stack(np.meshgrid(*axes, indexing="ij"), axis=-1).reshape(-1, len(axes))
    signed = orders @ np.array([hz, side.frequency_hz] if side else [hz])
    # one that folds at zero is the line of another multiple
    kept = (signed > 1e-6 * hz) & (signed <= top_hz)
    sidebands = np.abs(orders[:, 1:]).sum(axis=1)
    return Grid(
        carrier=carrier,
        modulators=(side,) if side else (),
        orders=np.asarray(orders[kept], dtype=np.int64),
        frequency_hz=np.asarray(signed[kept], dtype=np.float64),
        rank=np.asarray(RANK_STEP + sidebands[kept], dtype=np.int64),
        mechanisms=tuple(dict.fromkeys(mechanism for _, mechanism in carrier.makers)),
        family=carrier.family,
        series=True,
    )
