"""Tests during which the speed rises or falls, without pulses to follow it: nothing that hangs on orders is known."""

from __future__ import annotations

import time
from collections.abc import Sequence

from reconcile.origin import origin
from reconcile.speed.run_up import speed_change
from reconcile.verdict import Level, NextExperiment, Report
from signals.recording import Recording


def unsteady(tests: Sequence[Recording], level: Level, seed: int) -> Report | None:
    """The report where the speed of a test without a tacho changes by more than machines wander, else None."""
    begun = time.process_time()
    found = [(f"test {k}", change) for k, t in enumerate(tests, 1) if (change := speed_change(t)) is not None]
    if not found:
        return None
    told = " and ".join(f"{'rises' if c > 0 else 'falls'} by about {abs(c):.0%} during {name}" for name, c in found)
    some = len(found) < len(tests)
    return Report(
        verdict="not_decidable",
        sentence=f"The speed {told}, and no pulses say how: lines are smeared, so nothing can be told by them.",
        level=level,
        undecidable=("anything that hangs on the order of a line",),
        next_experiment=NextExperiment(
            sentence="Record at a held speed, or with a tacho"
            + (f"; or leave {', '.join(name for name, _ in found)} out." if some else ".")
        ),
        stages=({"name": "speed", "found": [f"{name}: changes by {c:+.0%}" for name, c in found]},),
        provenance=origin(seed, time.process_time() - begun),
    )
