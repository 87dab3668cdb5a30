"""Whether the place of a pit hangs on a play in the same bearing, which is told beside it.

A ring loose in its seat makes its bearing louder, and so speaks for a pit there rather than in the next bearing of the
same lines. What tells the place must be left once the play's change is taken off.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reconcile.judge.screen import looked
from reconcile.machine.decide import Decision
from reconcile.machine.direct import ALIKE
from reconcile.machine.second import Beside, fitted_change, has_play, strikes
from reconcile.machine.setting import Found, Setting
from reconcile.machine.weigh import LEAST_EVIDENCE
from reconcile.report.action import PLACE_OPEN


def placed_beside_play(
    setting: Setting, found: Found, decision: Decision, other: Beside | None
) -> tuple[Decision, Beside | None]:
    """The decision with what is told beside it; a set of the places, and nothing beside them, where a pit is named
    with a play of its own bearing, and in what that leaves another place of the same impacts is as good.

    An outer race's pit beside a loose ring of the next bearing was named at the latter's (z042 of the proof): 10 ahead
    by all features, 1 by what the loose ring left.
    """
    if other is None or decision.word != "explained":
        return decision, other
    first, second = decision.chosen[0], other.names[0]
    if not (strikes(first) and has_play(second) and _site(first) == _site(second)):
        return decision, other
    names = found.screen.names
    left = setting.changes.left(np.nan_to_num(fitted_change(found, second, setting.changes.observed)))
    told = dict(zip(names, map(float, looked(found.fitted, left).evidence), strict=True))
    heard = setting.direct.evidence
    like_it = [n for n in names if n != first and n.split("@")[0] == first.split("@")[0]]
    twins = [n for n in like_it if heard.get(n, 0.0) > 0.0 and heard[n] >= ALIKE * heard.get(first, 0.0)]
    near = [n for n in twins if told[n] > told[first] - LEAST_EVIDENCE]
    if not near:
        return decision, other
    why = f"{second} beside it explains what speaks for its place"
    return replace(decision, word="ambiguous", chosen=(first, *near), reasons=(PLACE_OPEN, why)), None


def _site(name: str) -> str:
    return name.split("@")[1]
