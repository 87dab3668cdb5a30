"""Runs of a prescribed motion: which is fitted, its motion, and its force without a zero that wanders."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
from scipy.ndimage import median_filter

from reconcile.driven.channels import FloatArray
from reconcile.driven.noise import power_lines
from reconcile.driven.prescribed.motion import motion_of
from reconcile.driven.prescribed.resistance import Motion
from reconcile.driven.prescribed.rich import Rich, drift, rich
from reconcile.driven.split import Part

START = 0.15
"""Share of a run in which the memory's start is forgotten: a reversal or two of a run of several cycles."""
CHOOSING = 0.4
"""Share of the fitted run on which structures are compared."""
LEAST_DRIFT = 0.05
"""Way of a zero that wanders, over the force's standard deviation, from which it is taken off and told."""
LINES_BESIDE = 32
"""Lines on either side by whose median the noise between the lines of an error is told."""
MEDIAN = 0.69
"""Of lines of noise, over their mean."""


@dataclass(frozen=True, kw_only=True)
class Setup:
    """A run: motion, force N, and the samples left for the start."""

    name: str
    motion: Motion
    force: FloatArray
    drift: float = 0.0
    """Way of its zero that was taken off, over the force's standard deviation."""

    @property
    def skip(self) -> int:
        """Samples at the start that do not count."""
        return int(START * self.force.size)

    @property
    def cut(self) -> int:
        """First sample of the stretch that is kept for choosing."""
        return int((1.0 - CHOOSING) * self.force.size)

    def part(self, first: int, last: int) -> Setup:
        """Samples first <= i < last."""
        return Setup(name=self.name, motion=self.motion.part(first, last), force=self.force[first:last])


def beyond_noise(error: FloatArray) -> float:
    """Share of an error's power that stands in lines: noise has as much between them."""
    power = power_lines(error)
    between = median_filter(power, 2 * LINES_BESIDE + 1, mode="nearest") / MEDIAN
    return max(1.0 - float(between.sum() / max(float(power.sum()), 1e-300)), 0.0)


def _told(run: Setup) -> Rich:
    return rich(run.motion, run.force, run.skip, run.cut)


def _steadied(run: Setup) -> Setup:
    course = drift(run.motion, run.force, run.skip)
    way = 0.0 if course is None else float(np.ptp(course)) / (float(run.force.std()) or 1.0)
    return replace(run, force=run.force - course, drift=way) if course is not None and way > LEAST_DRIFT else run


def setups(fit_part: Part, held_part: Part) -> tuple[Setup, Setup, Rich]:
    """Run to fit, run to hold out, and what the motion foretells of the force of the first.

    The run that is fitted shows what is missing: one that does not reach it cannot tell its law. A zero that wanders
    is taken off only where the motion then foretells nothing beyond a spring and damper: slow friction makes a force
    wander too.
    """
    zero = float(np.median(fit_part.data.drive))
    fitted, held = (
        Setup(name=p.name, motion=motion_of(p.data, zero), force=p.data.answer) for p in (fit_part, held_part)
    )
    told = [_told(r) for r in (fitted, held)]
    steadied = [_steadied(r) for r in (fitted, held)]
    if any(r.drift > 0.0 for r in steadied):
        again = [_told(r) for r in steadied]
        if not any(t.foretells for t in again):
            (fitted, held), told = steadied, again
    if told[1].foretells and not told[0].foretells:
        return held, fitted, told[1]
    return fitted, held, told[0]
