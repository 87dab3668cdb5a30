"""Alarms of one recording, each with the rule that gave it."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Any

from jobs.health.baselines import OF_ANY_LENGTH, Baselines, Like
from jobs.health.points import ChannelPoint, Point
from jobs.health.rules import FAMILY_RULE, LEAST_BASELINES, LEVEL_RULE, Judged, judge
from jobs.health.standard import SOURCE, zones_for
from jobs.health.titles import is_family, title_of, unit_of
from jobs.health.words import STATES, AlarmKind, Severity, State

CLIPPING = "clipping"
JUDGED_CLIPPED = ("rms", "peak", "velocity_rms")
"""A clipped level is at least what it reads. Its harmonics are made by the clipping, as other defects make features of
their own: those are not judged."""

UNHELD = "not held against baselines: "
"""How the reason begins that a recording is not judged."""


@dataclass(frozen=True, kw_only=True)
class Alarm:
    """What is out of the ordinary in a channel. `limit` in `unit`; `rise_db` over the baselines' median."""

    recording: str
    time: float
    channel: str
    feature: str
    kind: AlarmKind
    severity: Severity
    value: float | None
    limit: float | None
    unit: str
    rise_db: float | None
    baselines: int
    message: str
    rule: str


@dataclass(frozen=True, kw_only=True)
class Assessment:
    """A recording judged: limits by (channel, feature) where there are baselines enough, and the alarms."""

    state: State
    alarms: tuple[Alarm, ...]
    limits: Mapping[tuple[str, str], Judged]
    medians: Mapping[tuple[str, str], float]
    baselines: int
    """Like recordings that there are."""
    reasons: tuple[str, ...] = ()
    """Why it is not held against baselines, where it is not."""


def assess(point: Point, baselines: Baselines) -> Assessment:
    """Judge a recording. Baselines themselves are held against fixed limits and defects only."""
    like, any_length = (Like(()),) * 2 if point.baseline else (baselines.like(point), baselines.of_any_length(point))
    limits: dict[tuple[str, str], Judged] = {}
    medians: dict[tuple[str, str], float] = {}
    alarms = list(_measurement(point))
    for channel, entry in point.channels.items():
        defects = {f["kind"] for f in point.findings if f["channel"] == channel}
        for feature, value in entry.features.items():
            if value is None or (defects and not (defects == {CLIPPING} and feature in JUDGED_CLIPPED)):
                continue
            found = (any_length if feature in OF_ANY_LENGTH else like).of(channel, entry.place, feature)
            if found is None:
                continue
            judged = judge(value, found, family=is_family(feature))
            limits[channel, feature] = judged
            medians[channel, feature] = 10 ** (found.median_db / 20)
            if judged.severity is not None:
                alarms.append(_risen(point, channel, feature, value, judged, found.recordings))
        alarms = [_beside_clearer(a, entry, limits) if a.channel == channel else a for a in alarms]
        if defects <= {CLIPPING}:
            alarms += _fixed(point, channel)
    # A velocity within its class says nothing of a bearing, nor does the RMS of a short recording: no "ok" by them.
    too_short = len(like) < LEAST_BASELINES <= len(any_length)
    compared = point.baseline or (bool(limits) and not too_short)
    return Assessment(
        state=worst([a.severity for a in alarms], "ok" if compared else "unknown"),
        alarms=tuple(sorted(alarms, key=lambda a: (-STATES.index(a.severity), -(a.rise_db or 0.0)))),
        limits=limits,
        medians=medians,
        baselines=len(like),
        reasons=() if compared else (_too_short(point, any_length) if too_short else _not_compared(len(like)),),
    )


def _too_short(point: Point, any_length: Like) -> str:
    """Both lengths, and what is held against them all the same."""
    return (
        f"{UNHELD}it lasts {point.duration_s:.3g} s, and of the {len(any_length)} baselines otherwise like it, which "
        f"last up to {any_length.longest_s:.3g} s, fewer than {LEAST_BASELINES} are at most twice as long: lines that "
        "are not there read higher in a short recording, so its RMS alone is judged"
    )


def _not_compared(like: int) -> str:
    """How many baselines there are, and how many are needed."""
    if like >= LEAST_BASELINES:
        return (
            f"{UNHELD}no feature of a whole channel is in {LEAST_BASELINES} of the {like} baselines like it "
            "(same channel, quantity, unit, location, axis; no defect)"
        )
    there = "is 1 baseline" if like == 1 else f"are {like or 'no'} baselines"
    return f"{UNHELD}there {there} like it (rate, shaft, speed, torque), and {LEAST_BASELINES} are needed"


def worst(states: Sequence[State], least: State) -> State:
    """The gravest of several, or `least`."""
    return max((*states, least), key=STATES.index)


def _risen(point: Point, channel: str, feature: str, value: float, judged: Judged, baselines: int) -> Alarm:
    assert judged.severity is not None
    family = is_family(feature)
    limit = judged.alarm if judged.severity == "alarm" else judged.warning
    message = f"{title_of(feature)} on {channel} is {judged.rise_db:.1f} dB above the median of {baselines} baselines"
    return Alarm(
        recording=point.recording,
        time=point.time,
        channel=channel,
        feature=feature,
        kind="family" if family else "level",
        severity=judged.severity,
        value=value,
        limit=limit,
        unit=unit_of(feature, point.channels[channel].unit),
        rise_db=judged.rise_db,
        baselines=baselines,
        message=message,
        rule=FAMILY_RULE if family else LEVEL_RULE,
    )


def _beside_clearer(alarm: Alarm, entry: ChannelPoint, limits: Mapping[tuple[str, str], Judged]) -> Alarm:
    """A line that may be the sideband of a family that has risen more gives a warning at most, and says so."""
    other = entry.sideband_of.get(alarm.feature)
    judged = None if other is None else limits.get((alarm.channel, other))
    if other is None or judged is None or alarm.rise_db is None or judged.rise_db < alarm.rise_db:
        return alarm
    own = limits[alarm.channel, alarm.feature]
    message = (
        f"{alarm.message}; it may be a sideband of {title_of(other)}, which is {judged.rise_db:.1f} dB above its own"
    )
    return replace(alarm, severity="warning", limit=own.warning, message=message)


def _zoned(point: Point, channel: str) -> float | None:
    """The velocity that fixed limits apply to."""
    speed = point.operating.speed_hz if point.operating is not None else None
    if zones_for(point.vibration_class, speed) is None:
        return None
    return point.channels[channel].features.get("velocity_rms")


def _fixed(point: Point, channel: str) -> Iterator[Alarm]:
    velocity = _zoned(point, channel)
    if velocity is None or point.operating is None:
        return
    zones = zones_for(point.vibration_class, point.operating.speed_hz)
    assert zones is not None
    severity = zones.severity(velocity)
    if severity is None:
        return
    limit = zones.c_d if severity == "alarm" else zones.b_c
    place = f"zone {zones.zone(velocity)} of {point.vibration_class}"
    yield Alarm(
        recording=point.recording,
        time=point.time,
        channel=channel,
        feature="velocity_rms",
        kind="limit",
        severity=severity,
        value=velocity,
        limit=limit,
        unit="m/s",
        rise_db=None,
        baselines=0,
        message=f"{velocity * 1e3:.2f} mm/s on {channel} lies in {place}",
        rule=f"{SOURCE}, {point.vibration_class}: {limit * 1e3:g} mm/s",
    )


def _measurement(point: Point) -> Iterator[Alarm]:
    for finding in point.findings:
        yield _defect(point, finding)


def _defect(point: Point, finding: Mapping[str, Any]) -> Alarm:
    clipped = finding["kind"] == CLIPPING
    rest = "its RMS and peak are at least what they read" if clipped else "its features are not judged"
    return Alarm(
        recording=point.recording,
        time=point.time,
        channel=str(finding["channel"]),
        feature=str(finding["kind"]),
        kind="measurement",
        severity="measurement",
        value=None,
        limit=None,
        unit="",
        rise_db=None,
        baselines=0,
        message=f"{finding['channel']}: {finding['message']} ({finding['count']} places); {rest}",
        rule="a defect of the samples that was found when the recording was read",
    )
