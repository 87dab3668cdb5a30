"""What looks doubtful in a recording before anything is asked of it: a speed in rpm, too few turns, noise alone."""

from __future__ import annotations

from learn.measured import measured
from learn.remarks import PER_MINUTE
from learn.speed import LOWEST_HZ
from reconcile.kinematics.slowest import MIN_TURNS, shortest_s
from reconcile.stated import check_speeds, confirmed, given
from signals.ingest.report import NOBODY_TURNS_HZ, asks_for_rpm
from signals.recording import Recording
from sim.core.errors import SpecError

LEAST_SAMPLES = 2048
"""In fewer too few bins are left to tell lines from noise."""


def doubts(recording: Recording) -> list[str]:
    """Sentences for whoever recorded it; none of them is a defect, and an empty list is no praise."""
    return [*_of_speed(recording), *_of_length(recording), *_of_noise(recording)]


def _of_length(recording: Recording) -> list[str]:
    """Whether it holds fewer turns than `reconcile` needs of the shaft whose speed is stated."""
    operating = recording.operating
    turns = operating.speed_hz * recording.duration_s if operating is not None else 0.0
    if operating is None or not 0.0 < turns < MIN_TURNS:
        return []
    least = f"{MIN_TURNS:g} turns or more are needed, {shortest_s(operating.speed_hz):g} s"
    return [f"{recording.duration_s:.4g} s are {turns:.3g} turns of {operating.shaft}: to look for its lines {least}"]


def _of_speed(recording: Recording) -> list[str]:
    """Whether the stated speed looks like revolutions per minute: by pulses, the sampling rate, lines, or its size."""
    try:
        check_speeds({}, "", given([recording], []))
    except SpecError as error:
        return [f"operating.speed_hz {problem.message}" for problem in error.problems]
    stated = recording.operating.speed_hz if recording.operating is not None else 0.0
    slow = stated / PER_MINUTE
    # pulses have been held against it above
    if slow < LOWEST_HZ or recording.tacho is not None:
        return []
    if stated >= NOBODY_TURNS_HZ or confirmed(recording, stated):
        return []  # the former is remarked on as it is read
    return [asks_for_rpm(stated, ", and no lines confirm it")]


def _of_noise(recording: Recording) -> list[str]:
    """Whether no channel of vibration holds a line; where nothing was measured for other reasons it is not asked."""
    if recording.samples.shape[1] < LEAST_SAMPLES:
        return []
    try:
        found = measured(recording).findings
    except SpecError:
        return []
    names = [finding.channel for finding in found if finding.kind == "noise"]
    told = "nothing stands out of noise: whether the sensor heard the machine cannot be told"
    return [f"{', '.join(names)}: {told}"] if names else []
