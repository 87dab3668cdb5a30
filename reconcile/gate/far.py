"""Recordings whose lines are those of a shaft far from the speed that is stated, and what is then the machine's own.

Asked before hum is taken off: a shaft at 25 or 30 Hz has its second harmonic at the supply's frequency, and with a
label of 40 Hz nothing says that the line is the shaft's.
"""

from __future__ import annotations

from collections.abc import Sequence

from reconcile.speed import SpeedEstimate
from reconcile.speed.elsewhere import Elsewhere, harmonics_of, lines_elsewhere, lines_near
from signals.recording import Recording

HARDLY = 0.95
"""Confidence below which lines near the stated speed may be some of another fundamental's: every third multiple of one
is every second of another."""


def far_speeds(
    recordings: Sequence[Recording],
    speeds: Sequence[SpeedEstimate | None],
    *,
    ratios: Sequence[float] = (),
    teeth: Sequence[float] = (),
    seed: int = 0,
) -> list[Elsewhere | None]:
    """Of each recording whose stated speed nothing confirms, where its lines stand if that is clear: by themselves, or
    near the speed that the lines of another recording tell.

    `ratios`: speeds of other shafts over the stated one's; `teeth`: orders of the meshes, which take long.
    """
    found: list[Elsewhere | None] = [None] * len(recordings)
    rest = []
    for i, (one, speed) in enumerate(zip(recordings, speeds, strict=True)):
        if speed is None or speed.stated_hz is None or speed.method == "tacho":
            continue
        if speed.method != "stated" and _sure(speed):
            continue
        far = lines_elsewhere(one, speed.stated_hz, ratios=ratios, teeth=teeth, seed=seed)
        if far is not None and (speed.method == "stated" or not far.own):
            found[i] = far
        else:
            rest.append((i, one, speed))
    told = [_told_by(*row) for row in zip(recordings, speeds, found, strict=True)] if rest else []
    for i, one, speed in rest:
        stated = speed.stated_hz or 0.0
        places = [(f * stated if f else hz, harmonics) for f, hz, harmonics in told if harmonics]
        near = lines_near(one, stated, places, ratios=ratios) if places else None
        if near is not None and (speed.method == "stated" or not near.own):
            found[i] = near
    return found


def _told_by(
    one: Recording, speed: SpeedEstimate | None, found: Elsewhere | None
) -> tuple[float | None, float, tuple[int, ...]]:
    """What a recording tells of the others: by which factor stated speeds are wrong, its speed where it is as stated,
    and which harmonics of it are lines; none where it tells nothing."""
    if speed is None:
        return None, 0.0, ()
    if found is not None and speed.stated_hz:
        return found.speed_hz / speed.stated_hz, 0.0, () if found.own else found.harmonics
    sure = speed.method != "stated" and _sure(speed)
    return None, speed.speed_hz, harmonics_of(one, speed.speed_hz) if sure else ()


def _sure(speed: SpeedEstimate) -> bool:
    return speed.confidence >= HARDLY or speed.rival_hz is not None
