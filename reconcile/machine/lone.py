"""A sensor that changed at one operating point alone is left out of the comparison, and told."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reconcile.judge.lone import LOUD_P, Cell, features_of, lone_cell
from reconcile.machine.search import fit_views
from reconcile.machine.setting import Found, Setting
from reconcile.verdict import operating_point

Look = tuple[Setting, Found]
"""A setting and what its candidates say."""


def without_lone(of_kind: Look, closer: Look) -> tuple[Look, Look]:
    """Both looks, on machines of the kind and on those that agree with the baseline, without the only sensor and
    operating point that changed by what the latter show; as they are where there is none, or where a known effect's
    pattern is what changed there."""
    setting, seen = closer
    shape = (len(setting.data), len(setting.channels))
    cell = lone_cell(seen.fitted, setting.changes, *shape)
    if cell is None or seen.screen.p_best <= LOUD_P:
        return of_kind, closer
    return _again(of_kind, cell), _again(closer, cell)


def _again(look: Look, cell: Cell) -> Look:
    setting, found = look
    changes = setting.changes
    here = features_of(changes, cell, len(setting.data), len(setting.channels))
    rest = replace(changes, measured=np.where(here, np.nan, changes.measured))
    left = replace(setting, changes=rest, lone=(told_lone(setting, cell),))
    return left, fit_views(left, found.known)


def told_lone(setting: Setting, cell: Cell) -> str:
    """What changed alone, and what would tell more."""
    point = setting.data[cell.point].point
    return (
        f"left out: {setting.channels[cell.channel]} at {operating_point(point.speed_hz, point.torque_ratio)}, which "
        "changed alone: no other sensor there shows anything, nor does this one at another operating point. Sound "
        "machines do so where a motion across the load sets in by itself; a further baseline at this operating point "
        "tells whether it was so before"
    )
