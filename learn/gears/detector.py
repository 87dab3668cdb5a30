"""The classical way, for comparison: FM4 of the mean turn of each gear, with a fixed rule.

FM4 is the kurtosis of the difference signal (`signals.gear`; R. M. Stewart, Proc. ISVR, Southampton, 1977): about 3 for
a sound gear, higher where one or two teeth stand out. No limit is standard; half as much again is taken.
"""

from __future__ import annotations

from collections.abc import Sequence

from learn.gears.angle import mesh_angle
from learn.gears.assess import CLASSES, REACH
from learn.gears.turns import both_gears
from signals.gear import gear_indicators
from signals.series import FloatArray
from signals.synchronous import SynchronousAverage

RULE = 4.5
FEWEST_TURNS = 2


def fm4_detector(
    channels: Sequence[FloatArray], rate_hz: float, speed_hz: float, teeth: tuple[int, int]
) -> tuple[str, tuple[float, float]]:
    """(class, largest FM4 of each gear over the channels) at the true speed."""
    angle = mesh_angle(channels, rate_hz, speed_hz, teeth[0], REACH)
    levels = []
    for gear in both_gears(channels, angle, teeth):
        found = [0.0]
        for one in gear:
            if one.count < FEWEST_TURNS:
                continue
            mean = SynchronousAverage(
                samples=one.samples.mean(axis=0),
                unit="1",
                shaft="gear",
                revolutions=one.count,
                mean_speed_hz=speed_hz,
                scatter_rms=0.0,
            )
            found.append(gear_indicators(mean, teeth=(one.teeth,)).fm4 or 0.0)
        levels.append(max(found))
    return CLASSES[int(max(levels) >= RULE)], (levels[0], levels[1])
