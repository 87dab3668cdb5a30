"""What is known of machines by their recordings: the list of them, and one machine over time."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from jobs.health.alarms import Alarm, Assessment, assess, worst
from jobs.health.baselines import Baselines
from jobs.health.points import Point, points_of
from jobs.health.titles import NAMES, OCTAVE, title_of, unit_of
from jobs.health.words import State
from jobs.kept import Kept
from jobs.ports import ArtefactStore, JobCatalogue
from jobs.record import JobRecord
from jobs.recordings.words import RECORDING


@dataclass(frozen=True, kw_only=True)
class Watched:
    """A machine's recordings in the order of time, each judged."""

    name: str
    points: tuple[Point, ...]
    assessments: tuple[Assessment, ...]

    @property
    def state(self) -> State:
        """Of the latest recording; `unknown` while all that is well is baselines."""
        latest = self.assessments[-1].state if self.assessments else "unknown"
        return "unknown" if latest == "ok" and not self._judged else latest

    @property
    def worst(self) -> State:
        """Of all recordings."""
        gravest = worst([a.state for a in self.assessments], "unknown")
        return "unknown" if gravest == "ok" and not self._judged else gravest

    @property
    def _judged(self) -> bool:
        """Whether any recording was held against baselines. A baseline never is: it being `ok` says nothing more
        than that it has no defect and lies within fixed limits."""
        return any(a.limits for a in self.assessments)

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of all channels, in the order they came up."""
        return tuple(dict.fromkeys(name for point in self.points for name in point.channels))


@dataclass(frozen=True, kw_only=True)
class Trend:
    """One feature of one channel over some points; a value is None where a recording has none, a limit where there
    are too few baselines. `limits`: warning and alarm; `median`: of the baselines."""

    channel: str
    feature: str
    title: str
    unit: str
    values: tuple[float | None, ...]
    median: tuple[float | None, ...]
    warning: tuple[float | None, ...]
    alarm: tuple[float | None, ...]


def machine_names(catalogue: JobCatalogue) -> list[str]:
    """Every machine that a recording names."""
    return catalogue.names(RECORDING)


def watched(records: Sequence[JobRecord], artefacts: ArtefactStore, kept: Kept, name: str) -> Watched:
    """A machine by the records of its recordings."""
    points = points_of(records, artefacts, kept)
    baselines = Baselines(points)
    return Watched(name=name, points=tuple(points), assessments=tuple(assess(p, baselines) for p in points))


def chosen(machine: Watched, start: float | None, end: float | None) -> list[int]:
    """Places of the recordings taken from `start` up to and with `end`, s since the epoch."""
    return [
        place
        for place, point in enumerate(machine.points)
        if (start is None or point.time >= start) and (end is None or point.time <= end)
    ]


def trends(
    machine: Watched, places: Sequence[int], channels: Sequence[str], features: Sequence[str]
) -> tuple[Trend, ...]:
    """Of the channels and features named (all unless any is), in a settled order."""
    found = []
    for channel in (name for name in machine.channels if not channels or name in channels):
        held = [p.channels[channel] for p in (machine.points[i] for i in places) if channel in p.channels]
        known = sorted({feature for entry in held for feature in entry.features}, key=_rank)
        wanted = [name for name in known if not features or name in features]
        found += [_trend(machine, places, channel, name, unit_of(name, held[-1].unit)) for name in wanted]
    return tuple(found)


def alarms_at(machine: Watched, places: Sequence[int], channels: Sequence[str], features: Sequence[str]) -> list[Alarm]:
    """Of these recordings, the latest first; of a channel's defects whatever feature is asked for."""
    return [
        alarm
        for place in reversed(places)
        for alarm in machine.assessments[place].alarms
        if (not channels or alarm.channel in channels)
        and (not features or alarm.feature in features or alarm.kind == "measurement")
    ]


def _rank(feature: str) -> tuple[int, float, str]:
    """Plain features, then families by part, then octaves upwards."""
    if feature in NAMES:
        return 0, list(NAMES).index(feature), ""
    if feature.startswith(OCTAVE):
        return 2, float(feature.removeprefix(OCTAVE)), ""
    return 1, 0.0, feature


def _trend(machine: Watched, places: Sequence[int], channel: str, feature: str, unit: str) -> Trend:
    key = (channel, feature)
    points, judged = [machine.points[i] for i in places], [machine.assessments[i] for i in places]
    limits = [a.limits.get(key) for a in judged]
    return Trend(
        channel=channel,
        feature=feature,
        title=title_of(feature),
        unit=unit,
        values=tuple(p.channels[channel].features.get(feature) if channel in p.channels else None for p in points),
        median=tuple(a.medians.get(key) for a in judged),
        warning=tuple(None if x is None else x.warning for x in limits),
        alarm=tuple(None if x is None else x.alarm for x in limits),
    )
