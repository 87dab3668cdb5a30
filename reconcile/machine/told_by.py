"""By what a second effect may be told: the teeth's own lines beside a pit, and impacts beside what does not strike."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.machine.direct import HEARD
from reconcile.machine.second import by_play, has_play, strikes, sure
from reconcile.machine.setting import Found, Setting
from sim.terms import REGISTRY

HALF_HEARD = 3.0
"""Log evidence of impacts from which a pit of a bearing is asked beside what does not strike. The pit beside a loose
seat of n018 has 3.9, and added 37 where all else added nothing."""

LOST_ELSEWHERE = 0.25
"""Of what a second effect adds at all operating points, the share that those but its best may take together: right ones
(e053, n001) add 5 and 9 of 79 and 69 there. Beside a play nothing: beside one alone a ring rattles at one speed as no
law has it, where waves of a race added 122 and took 65 at two others (w024), a torque 172 and took 3 (t007)."""

SHARED, ALONE = 0.1, 2.0
"""Share that the others must add, or the whole be so many times what a second must add: right ones of one speed (e053)
add 79 of 30. A rub beside an unbalance alone added 41, of which 39 at one speed (m008)."""


def teeth_tell(setting: Setting, found: Found, first: str) -> bool:
    """Whether the teeth's own lines say what stands beside a first effect that strikes: a pit of a bearing, which
    hardly moves them, and which is there by its impacts whatever else is."""
    term = REGISTRY.get(first.split("@", maxsplit=1)[0])
    on_teeth = term is None or term.strikes == "tooth"
    return bool(setting.machine.gears) and not on_teeth and sure(found, first)


def own_lines(setting: Setting) -> np.ndarray:
    """(F,): the teeth's own lines, with their phases between sensors where these are compared."""
    changes = setting.changes
    mask = np.zeros(changes.observed.size, dtype=bool)
    mask[(changes.phased or (changes.single,))[0].columns] = True
    return mask


def heard(setting: Setting, name: str) -> bool:
    """Whether a striking effect is heard well enough to be asked as a second one."""
    term = REGISTRY.get(name.split("@", maxsplit=1)[0])
    least = HEARD if term is None or term.strikes == "tooth" else HALF_HEARD
    return setting.direct.evidence.get(name, 0.0) >= least


def impacts_beside(setting: Setting, first: str, second: str) -> float:
    """Log evidence of a second effect's impacts beside the first; 0 where they may be those of the first's play."""
    evidence = setting.direct.evidence.get(second, 0.0)
    if not strikes(second) or by_play(setting, first, {second: evidence}):
        return 0.0
    return max(evidence, 0.0)


def repeats(setting: Setting, first: str, second: str, parts: Sequence[float], least: float) -> bool:
    """Whether a second effect that adds `parts` of log likelihood at several operating points, `least` or more in all,
    takes less elsewhere than `LOST_ELSEWHERE` of the whole, and beside a play nothing, and is not of one point alone
    with little to spare; beside a pit, or where its impacts are heard, it may be."""
    if strikes(first) or len(parts) < 2 or impacts_beside(setting, first, second) > 0.0:
        return True
    whole, others = sum(parts), sum(parts) - max(parts)
    if others < SHARED * whole and whole < ALONE * least:
        return False
    return -others < (0.0 if has_play(first) else LOST_ELSEWHERE) * whole


def counted(setting: Setting, first: str, second: str, gain: float, parts: Sequence[float], least: float) -> float:
    """What a second effect adds, `gain`; less than the `least` where it would strike and does not repeat."""
    again = not strikes(second) or repeats(setting, first, second, parts, least)
    return gain if again else min(gain, float(np.nextafter(least, 0.0)))
