"""Recordings during which the speed rises or falls, without pulses to follow it: no order of a line is known."""

from __future__ import annotations

import time
from collections.abc import Sequence

from reconcile.origin import origin
from reconcile.shares import percent
from reconcile.speed.run_up import WINDOW_S, speed_change
from reconcile.verdict import Level, NextExperiment, Report
from signals.recording import Recording


def unsteady(tests: Sequence[Recording], baselines: Sequence[Recording], level: Level, seed: int) -> Report | None:
    """The report where the speed of a recording without a tacho changes by more than machines wander, else None."""
    begun = time.process_time()
    named = [
        *((f"test {k}", t) for k, t in enumerate(tests, 1)),
        *((f"baseline {k}", b) for k, b in enumerate(baselines, 1)),
    ]
    found = [(name, change, one) for name, one in named if (change := speed_change(one)) is not None]
    if not found:
        return None
    told = " and ".join(_told(name, change, one) for name, change, one in found)
    left_out = ", ".join(name for name, _, _ in found)
    some = len(found) < len(named)
    return Report(
        verdict="not_decidable",
        sentence=f"The speed {told}, and no pulses say how: lines are smeared, so nothing can be told by them.",
        level=level,
        undecidable=("anything that hangs on the order of a line",),
        next_experiment=NextExperiment(
            sentence="Record at a held speed, or with a tacho" + (f"; or leave {left_out} out." if some else ".")
        ),
        stages=({"name": "speed", "found": [f"{name}: changes by {c:+.0%}" for name, c, _ in found]},),
        provenance=origin(seed, time.process_time() - begun),
    )


def _told(name: str, change: float, one: Recording) -> str:
    within = f"{WINDOW_S:g} s of " if one.duration_s > WINDOW_S else ""
    return f"{'rises' if change > 0 else 'falls'} by about {percent(abs(change), 0)} during {within}{name}"
