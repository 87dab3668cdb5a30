"""A change that one sensor shows at one operating point, others there a little of it, and nothing elsewhere.

A motion across the load that sets in by itself at one speed looks so, and a sound machine has it as well
(`judge/lone.py`). Effects that would be one part's at every speed are alike in it by chance: several at several places,
or none of the known.
"""

from __future__ import annotations

from dataclasses import replace

from reconcile.judge.lone import loudest_cell
from reconcile.machine.decide import AT_ONE, DETECT_P, Decision
from reconcile.machine.setting import Found, Setting
from reconcile.verdict import operating_point


def unless_confined(decision: Decision, setting: Setting, found: Found) -> Decision:
    """Not decidable, where effects of several places or none of the known would explain such a change, and no impacts
    tell. A name, and a set of one place, stay: a play may rattle at one speed alone. As `machine/lone.py` only against
    a baseline and with teeth."""
    several = decision.word == "ambiguous" and len({name.split("@")[1] for name in decision.chosen}) > 1
    if not (several or decision.word == "unknown_physics") or setting.direct.p <= DETECT_P:
        return decision
    if not setting.changes.with_baseline or not setting.machine.gears:
        return decision
    cell = loudest_cell(found.fitted, setting.changes, len(setting.data), len(setting.channels))
    if cell is None:
        return decision
    point = setting.data[cell.point].point
    at = operating_point(point.speed_hz, point.torque_ratio)
    reason = (
        f"{AT_ONE}, {at}, and there by far the most on {setting.channels[cell.channel]}; sound machines change so "
        "where a motion across the load sets in by itself"
    )
    return replace(decision, word="not_decidable", reasons=(reason,))
