"""Force and motion a part of a sample apart, as two converters or filters leave them: put in step, and said.

A linear model leaves what a delay turns, and two resonances near one another turn alike: without this a sound mass was
told to lack a second one. So a delay is asked first, and where it explains what follows the force, nothing else is.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from reconcile.driven.measured import Look, look
from reconcile.driven.model import errors, ready
from reconcile.driven.second import LEAST_FOLLOWS, followed, second
from reconcile.driven.step import closer, in_step

EXPLAINS, EXPLAINS_BESIDE = 0.9, 0.5
"""Share of what follows the force that a delay must explain to be the cause; the second where a second resonance
explains half of the rest. Of made sound masses on springs (noise 0.1 to 1 %, 0.05 to 1.2 samples either way) it
explained all of it (1.01 to 1.03), of 18 with a second one on them (mass ratio 0.01 to 0.2) in step at most 0.42, and
0.54 and 0.67 of two on a mount that relaxes, which is no delay. A faint second one that is a tenth of a sample late as
well (0.6 and 0.9) is found at its own frequency once it is in step, and was not, or at another, before."""
REST = 0.5
LONGEST = 1.5
"""Samples: longer ones are looked for by the averaged response (`reconcile.driven.step`)."""
ROUNDS = 3


@dataclass(frozen=True, kw_only=True)
class Skew:
    """A recording in step, the delay of its motion, and the shares of the output that are left as it is and in step."""

    look: Look
    delay_s: float
    before: float
    after: float

    @property
    def samples(self) -> float:
        """The delay over the time between samples."""
        return self.delay_s / self.look.data.step_s

    def remark(self, recording: str) -> str:
        """For the report."""
        data, way = self.look.data, "late" if self.delay_s > 0 else "early"
        return (
            f"{recording}: {data.answer_channel.name} comes {abs(self.samples):.2g} of a sample "
            f"({1e6 * abs(self.delay_s):.3g} µs) too {way} for {data.drive_channel.name}, as of two converters or "
            "filters; put in step."
        )


def skewed(one: Look) -> Skew | None:
    """The recording in step, where a delay of a sample or so explains what follows the force of what a model leaves."""
    data = one.data
    if data.prescribed or data.moved:
        return None
    run = ready(data, one.model.memory_s)
    left = errors(one.model, run)
    follows = followed(data.drive[run.skip :], left, data.step_s)
    if follows < LEAST_FOLLOWS:
        return None
    delay, now = 0.0, one
    for _ in range(ROUNDS):
        delay += closer(now)
        if abs(delay) > LONGEST * data.step_s:
            return None
        now = look(in_step(data, delay))
    before, after = _power(one), _power(now)
    explained = (1.0 - after / max(before, 1e-300)) / follows
    if explained < EXPLAINS_BESIDE or (explained < EXPLAINS and not _two(now)):
        return None
    return Skew(look=now, delay_s=delay, before=one.left, after=now.left)


def _two(one: Look) -> bool:
    """Whether a second resonance explains what is left in step."""
    run = ready(one.data, one.model.memory_s)
    found = second(one.model, run, run)
    return found is not None and found.share >= REST * found.follows


def _power(one: Look) -> float:
    """Mean square of what a model leaves of the whole recording, most of which it was not fitted to."""
    return float(np.mean(errors(one.model, ready(one.data, one.model.memory_s)) ** 2))
