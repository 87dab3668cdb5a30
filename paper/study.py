"""Which cases the page needs, and sweeps put together from results."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace

import numpy as np

from paper.cases import GAPS_UM, RUNOUT_M, Case, Setting, all_settings, clearance_sweep, healthy_of, speed_sweep
from paper.changes import CHANGES
from paper.run import Result
from paper.verdict.parts import PARTS
from paper.verdict.rules import Judgement
from paper.verdict.sweep import Sweep

SPEED_CHANGES = ("masses/4", "masses*4", "balls 1e9", "balls 1e10", "damping 1.8e4", "te 5")
"""Changes whose speed sweep is made too: they move the resonance the speed sweep crosses."""
CHANGE_GAPS_UM = (5.0, 10.0, 20.0, 30.0, 45.0, 50.0)
STUDIED = (
    Setting(preset="paper", runout_m=RUNOUT_M),
    Setting(preset="paper-lightly-damped", runout_m=RUNOUT_M),
)
"""Where the unstated parameters are changed: both presets as printed, with run-out so that every trend can appear."""


def changed_settings() -> tuple[Setting, ...]:
    """Every change on every studied setting, and the settings themselves."""
    return tuple(replace(s, change=c) for s in STUDIED for c in ("", *CHANGES))


def main_cases() -> tuple[Case, ...]:
    """Clearance and speed sweeps of all sixteen settings."""
    return tuple(c for s in all_settings() for c in (*clearance_sweep(s), *speed_sweep(s)))


def sensitivity_cases() -> tuple[Case, ...]:
    """Coarse clearance sweeps of the changed machines, speed sweeps of some."""
    fast = tuple(c for s in changed_settings() if s.change in SPEED_CHANGES for c in speed_sweep(s))
    return fast + tuple(c for s in changed_settings() for c in clearance_sweep(s, CHANGE_GAPS_UM) if c.gap_um != 0.0)


def _numbers(result: Result) -> dict[str, float]:
    """Measures of a run and the largest distance of the shaft from the bearing's centre over the stored revolutions."""
    reach = {f"reach_{axis}": float(np.max(np.abs(result.trace[f"ring_{axis}"]))) for axis in "xy"}
    return {**result.numbers, **reach}


def sweep_of(setting: Setting, results: Mapping[Case, Result], gaps_um: tuple[float, ...] = GAPS_UM) -> Sweep:
    """The numbers of a setting at the given clearances and at every speed that was computed."""
    healthy = results[Case(setting=healthy_of(setting), gap_um=None)]
    mine = [r for c, r in results.items() if c.setting == setting and c.gap_um is not None]
    gaps = {r.case.gap_um or 0.0: _numbers(r) for r in mine if r.case.speed_hz == 30.0 and r.case.gap_um in gaps_um}
    fast = {r.case.speed_hz: _numbers(r) for r in mine if r.case.gap_um == 20.0}
    return Sweep(
        healthy=_numbers(healthy),
        by_gap=dict(sorted(gaps.items())),
        by_speed=dict(sorted(fast.items())) if len(fast) > 1 else {},
        f_o1_hz=healthy.numbers["f_o1_hz"],
        f_r1_hz=30.0,
    )


def judged(sweep: Sweep) -> dict[str, Judgement]:
    """Judgement on every part that the sweep can answer, by key."""
    return {p.key: p.judge(sweep) for p in PARTS if sweep.by_speed or not p.needs_speed}


def judged_main(setting: Setting, results: Mapping[Case, Result]) -> dict[str, Judgement]:
    """Verdicts of one of the sixteen settings."""
    return judged(sweep_of(setting, results))


def judged_changes(setting: Setting, results: Mapping[Case, Result]) -> dict[str, dict[str, Judgement]]:
    """Verdicts of a studied setting under every change, unchanged ("") first, all on the coarse clearances."""
    found = {}
    for change in ("", *CHANGES):
        sweep = sweep_of(replace(setting, change=change), results, CHANGE_GAPS_UM)
        found[change] = judged(sweep)
    return found
