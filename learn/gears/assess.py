"""From samples to an answer about a gear stage: is a tooth damaged, of which gear."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from learn.gears import features
from learn.gears.angle import TOP, mesh_angle
from learn.gears.features import Gear, Place
from learn.gears.turns import both_gears
from learn.model import Head, Model
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

CLASSES = ("healthy", "tooth")
SHORT, LONG = "gear_short", "gear_long"
"""Heads for stretches of about ten turns and for longer recordings."""
SHORT_TURNS = 20.0
MOST_TURNS = 112.0
"""As long as the recordings of the training; longer ones are read in equal parts."""
LEAST_TURNS = 6.0
REACH = 0.004
"""A speed that is taken as exact is off by this much, or wanders."""
DOUBTS = 2.0
"""Deviations of a speed in doubt that are searched."""
LEAST_PROBABILITY = 1e-3


@dataclass(frozen=True, kw_only=True)
class StageAnswer:
    """`probabilities` by class; `gear` (0 or 1) whose peak stands out most, and `place`: channel, band, share of the
    turn; `turns` of the first gear, its speed, and in how many parts they were read."""

    label: str
    probabilities: dict[str, float]
    gear: int
    place: Place | None
    turns: float
    speed_hz: float
    parts: int


def knows_gears(model: Model) -> bool:
    """Whether a model has the heads for gears."""
    return {SHORT, LONG} <= set(model.heads)


def look(
    channels: Sequence[FloatArray], rate_hz: float, speed_hz: float, teeth: tuple[int, int], doubt: float = 0.0
) -> tuple[Gear, Gear]:
    """Both gears of a stage whose first turns at `speed_hz`."""
    angle = mesh_angle(channels, rate_hz, speed_hz, teeth[0], REACH + DOUBTS * doubt)
    first, second = both_gears(channels, angle, teeth)
    return features.gear(first), features.gear(second)


def parts_of(channels: Sequence[FloatArray], rate_hz: float, speed_hz: float) -> list[list[FloatArray]]:
    """Equal parts of at most `MOST_TURNS`; SpecError where there are too few turns."""
    samples = min(c.size for c in channels)
    turns = samples / rate_hz * speed_hz
    if turns < LEAST_TURNS:
        allowed = f"at least {LEAST_TURNS / speed_hz:.3g}"
        raise SpecError(
            Problem(field="samples", message="are too few turns", given=samples / rate_hz, allowed=allowed, unit="s")
        )
    count = int(np.ceil(turns / MOST_TURNS))
    size = samples // count
    return [[np.asarray(c[i * size : (i + 1) * size], dtype=np.float64) for c in channels] for i in range(count)]


def assess_stage(
    channels: Sequence[FloatArray],
    rate_hz: float,
    speed_hz: float,
    model: Model,
    teeth: tuple[int, int],
    doubt: float = 0.0,
) -> StageAnswer:
    """Whether a tooth of either gear is damaged; channels are looked at together. SpecError where the mesh is beyond
    the sampling rate, or turns are too few."""
    mesh_hz = teeth[0] * speed_hz
    if mesh_hz > TOP * rate_hz:
        problem = "is too low to hold the mesh of the teeth"
        allowed = f"at least {mesh_hz / TOP:.4g}"
        raise SpecError(Problem(field="sampling_rate_hz", message=problem, given=rate_hz, allowed=allowed, unit="Hz"))
    parts = parts_of(channels, rate_hz, speed_hz)
    turns = min(c.size for c in channels) / rate_hz * speed_hz
    head = model.heads[SHORT if turns <= SHORT_TURNS else LONG]
    seen = [look(part, rate_hz, speed_hz, teeth, doubt) for part in parts]
    p = _together(head, np.stack([features.vector(gears)[0] for gears in seen]))
    which = int(np.argmax(np.mean([[sum(g.most("alone")) for g in gears] for gears in seen], axis=0)))
    shown = [gears[which].best for gears in seen]
    place = max((one for one in shown if one is not None), key=lambda one: one.peak + one.alone, default=None)
    return StageAnswer(
        label=head.classes[int(np.argmax(p))],
        probabilities=dict(zip(head.classes, (float(x) for x in p), strict=True)),
        gear=which,
        place=place,
        turns=float(turns),
        speed_hz=speed_hz,
        parts=len(parts),
    )


def _together(head: Head, rows: FloatArray) -> FloatArray:
    """Probabilities (classes,) of parts taken together: geometric mean."""
    mean = np.exp(np.mean(np.log(np.maximum(head.probabilities(rows), LEAST_PROBABILITY)), axis=0))
    return np.asarray(mean / np.sum(mean), dtype=np.float64)
