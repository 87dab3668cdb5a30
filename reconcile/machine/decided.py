"""The decision on what was found."""

from __future__ import annotations

from reconcile.machine.confined import unless_confined
from reconcile.machine.decide import Decision, decide
from reconcile.machine.of_teeth import of_teeth
from reconcile.machine.setting import Found, Setting
from reconcile.machine.unstruck import unless_silent


def decided(setting: Setting, found: Found) -> Decision:
    """By all views of the recordings, and whether there is a baseline."""
    views = len(setting.channels) * len(setting.data)
    decision = decide(found.screen, views=views, measured=setting.changes.with_baseline)
    told = dict(zip(found.screen.names, map(float, found.screen.evidence), strict=True))
    decision = unless_silent(decision, setting.direct, told, points=len(setting.data), views=views)
    return unless_confined(of_teeth(decision, found.screen), setting, found)
