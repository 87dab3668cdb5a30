"""What rose together at a shaft's turns, where no pattern and no group of features was unusual."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from reconcile.judge.adequacy import Rest
from reconcile.judge.nulls import resting
from reconcile.judge.screen import Screen
from reconcile.judge.space import Fitted
from reconcile.judge.turns import Turned, evidence_of_turns, turned
from reconcile.machine.decide import CLEAR_P, DETECT_P, chance
from reconcile.machine.setting import Found, Setting
from reconcile.machine.sidebands import apart
from reconcile.observe.watch import watch_list
from signals.series import FloatArray


def risen(setting: Setting, fitted: Fitted) -> Turned:
    """On machines that agree with the baseline."""
    if not setting.changes.with_baseline:
        return Turned()
    sound, observed = _sound(setting), setting.changes.observed
    speeds = apart([d.point.speed_hz for d in setting.data])
    return turned(watch_list(setting.machine), observed, sound, fitted.whiten, speeds, len(setting.channels))


def clear(seen: Turned) -> bool:
    """Whether it says something of itself."""
    return seen.p <= CLEAR_P


def by_turns(setting: Setting, found: Found, seen: Turned) -> Screen:
    """The screen of `found`; where nothing but this is unusual the effects count by how well they show what rose."""
    screen = replace(found.screen, p_turns=seen.p)
    if not clear(seen) or chance(found.screen) <= DETECT_P:
        return screen
    known = found.unled.library
    told = evidence_of_turns(
        watch_list(setting.machine), setting.changes.observed, _sound(setting), known.changes, known.groups,
        found.fitted.whiten, _shape(setting),
    )  # fmt: skip
    evidence = np.array([told.get(name, 0.0) for name in screen.names])
    weights = np.exp(evidence - evidence.max())
    return replace(
        screen, evidence=evidence, direct=np.zeros(evidence.size), weights=weights / weights.sum(), by_turns=True,
        misfit=0.0, rest=Rest(), unmoved=None, likelihoods={}, heard={}, yields={}, bursts={},
    )  # fmt: skip


def _sound(setting: Setting) -> FloatArray:
    return resting(setting.changes, setting.changes.null, np.random.default_rng([setting.seed, 47]))


def _shape(setting: Setting) -> tuple[int, int]:
    return len(setting.data), len(setting.channels)
