"""How large a pit of a race is where both of its edges are heard: the angle between a ball's two strikes.

What the second strike is told by: `reconcile.observe.second_strike`. A ball between sharp edges is unloaded and loaded
again over lengths of its own, the longer the deeper it is pressed in, so its strikes are nearer than the edges: of the
product's pits (docs/physics/outer_spall.md) 0.45 to 0.8 of the width, between steep walls nearly all of it, and a ball
with mass strikes from half of the way on (N. Sawalhi and R. B. Randall, Mech. Syst. Signal Process. 25 (2011) 846-870).
The interval holds all of these (docs/decisions/reconcile-strikes.md).
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.atlas.candidates import already
from reconcile.kinematics.families import Family, Race, Ties, ties
from reconcile.kinematics.spec import of_machine
from reconcile.machine.injected import Base, base_at
from reconcile.machine.rolling import kind_of, known_family, rate_of
from reconcile.machine.setting import Setting
from reconcile.machine.severity import parameter_of
from reconcile.observe.impact_bands import bands_of
from reconcile.observe.second_strike import Struck, second_strike
from reconcile.verdict import Severity
from sim.parts.bearing.spall_terms import PITCH

MOST = 4
"""Pits of an answer that are sized."""
STRIKES, LEAST, LARGEST = 0.85, 0.42, 1.1
"""Angle between the strikes over that between the edges, and its least and largest, with what the strikes' angle is
off."""


def strike_sizes(setting: Setting, names: Sequence[str]) -> dict[str, Severity]:
    """Sizes of those of the effects that are pits of races whose edges are both heard, of such as the baseline has
    not."""
    if any(d.baseline is None or d.spectra[1] is None for d in setting.data):
        return {}
    pits = [n for n in names if kind_of(n) in ("outer", "inner") and not _old(setting, n)][:MOST]
    return {n: size for n in pits if (size := _size_of(setting, n)) is not None}


def _old(setting: Setting, name: str) -> bool:
    """Whether the machine file has the pit already, so that the baseline has its strikes."""
    return already(setting.plan.machine, *name.split("@")) is not None


def _size_of(setting: Setting, name: str) -> Severity | None:
    family = known_family(setting.machine, name)
    if family is None:
        return None
    tie = ties(of_machine(setting.machine), setting.machine.operating.shaft if setting.machine.operating else None)
    points = [p for p, d in enumerate(setting.data) if bands_of(d.spectra[0].rate_hz)]
    bases = [(p, base_at(setting, p, family)) for p in points]
    share = second_strike([_struck(setting, p, base, family, tie) for p, base in bases if base.out])
    return None if share is None else _severity(name, share * between_balls_m(tie.races[family.site], family))


def _severity(name: str, strikes_m: float) -> Severity:
    size = parameter_of(name)
    low, value, high = (float(np.clip(strikes_m / part, size.low, size.high)) for part in (LARGEST, STRIKES, LEAST))
    return Severity(name=size.name, value=value, unit=size.unit, low=low, high=high)


def between_balls_m(race: Race, family: Family) -> float:
    """Along the race, from one ball to the next; of a bearing without lengths of the diameter that pits have then."""
    side = 1.0 + race.ratio if family.kind == "outer" else 1.0 - race.ratio
    return float(np.pi * (race.pitch_m or PITCH.default) * side / race.balls)


def _struck(setting: Setting, point: int, base: Base, family: Family, tie: Ties) -> Struck:
    test, baseline = setting.data[point].spectra
    assert baseline is not None
    slip = base.test.hz / rate_of(family, test.speed_hz).hz
    return Struck(
        test=base.heard,
        baseline=base.ground.white,
        count=base.ground.count,
        rate_hz=base.ground.rate_hz,
        test_hz=base.test.hz,
        baseline_hz=slip * rate_of(family, baseline.speed_hz).hz,
        speed_hz=test.speed_hz,
        teeth_hz=tuple(order * test.speed_hz for order in tie.mesh_orders),
    )
