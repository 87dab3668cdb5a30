"""Machines and their health as the API shows them."""

from __future__ import annotations

from datetime import UTC, datetime

from app.schemas import Reply
from jobs.health.alarms import Alarm, Assessment
from jobs.health.machines import Trend, Watched
from jobs.health.points import Point
from jobs.health.verdicts import Verdict
from jobs.health.words import AlarmKind, Severity, State


class MachineLinks(Reply):
    """Where to go from here."""

    health: str


class MachineView(Reply):
    """A machine that recordings name."""

    name: str
    recordings: int
    """That were read."""
    baselines: int
    """Of them, those said to be of the sound machine."""
    first_seen: datetime | None
    last_seen: datetime | None
    """Time of its latest recording."""
    state: State
    """Of the latest recording: `unknown` where there is nothing to judge it by, or only baselines are well."""
    worst: State
    """Of all its recordings; `unknown` where nothing but baselines was judged."""
    alarms: int
    """Of the latest recording."""
    links: MachineLinks


class MachinePage(Reply):
    """One page of the list, by name."""

    machines: list[MachineView]
    total: int
    next: str | None
    """Address of the next page."""


class PointOperating(Reply):
    """Operating point of a recording."""

    shaft: str
    speed_hz: float
    torque_nm: float | None
    speed_from: str
    """`tacho` or `harmonics`: measured; `stated`: as the description says."""


class PointLinks(Reply):
    """Where to go from here."""

    recording: str


class PointView(Reply):
    """One recording of the machine."""

    recording: str
    name: str
    time: datetime
    time_stated: bool
    """False: the recording does not say when it was taken; this is when it was sent in."""
    condition: str
    operating: PointOperating | None
    state: State
    alarms: int
    like_baselines: int
    """Baselines at its operating point."""
    reasons: list[str]
    """Why features are missing, and why it is not judged."""
    links: PointLinks


class TrendView(Reply):
    """A feature of a channel over the points, one value each; null where there is none."""

    channel: str
    feature: str
    title: str
    unit: str
    values: list[float | None]
    median: list[float | None]
    """Of the baselines at the operating point of each recording."""
    warning: list[float | None]
    """Limit, in the unit of the values; null where there are fewer than 8 baselines."""
    alarm: list[float | None]


class AlarmView(Reply):
    """What is out of the ordinary, with the rule that says so."""

    recording: str
    time: datetime
    channel: str
    feature: str
    kind: AlarmKind
    severity: Severity
    value: float | None
    limit: float | None
    unit: str
    rise_db: float | None
    """Over the median of the baselines."""
    baselines: int
    message: str
    rule: str


class VerdictLinks(Reply):
    """Where to go from here."""

    reconciliation: str


class VerdictView(Reply):
    """What a reconciliation said that used recordings of the machine."""

    reconciliation: str
    finished_at: datetime
    verdict: str
    sentence: str
    level: str
    recordings: list[str]
    baselines: list[str]
    links: VerdictLinks


class HealthOverTime(Reply):
    """A machine's recordings in the order of time, the latest on the first page."""

    machine: str
    state: State
    worst: State
    baselines_needed: int
    """Like a recording, for it to be judged."""
    channels: list[str]
    """All there are."""
    total: int
    """Recordings in the time asked for."""
    points: list[PointView]
    series: list[TrendView]
    alarms: list[AlarmView]
    """Of these points, the latest first."""
    verdicts: list[VerdictView]
    next: str | None
    """Address of the page before in time."""


def machine_view(machine: Watched) -> MachineView:
    """A line of the list."""
    points = machine.points
    return MachineView(
        name=machine.name,
        recordings=len(points),
        baselines=sum(p.baseline for p in points),
        first_seen=_time(points[0].time) if points else None,
        last_seen=_time(points[-1].time) if points else None,
        state=machine.state,
        worst=machine.worst,
        alarms=len(machine.assessments[-1].alarms) if points else 0,
        links=MachineLinks(health=f"/v1/machines/{machine.name}/health"),
    )


def point_view(point: Point, found: Assessment) -> PointView:
    """One recording."""
    return PointView(
        recording=point.recording,
        name=point.name,
        time=_time(point.time),
        time_stated=point.time_stated,
        condition="baseline" if point.baseline else "unknown",
        operating=None if point.operating is None else PointOperating(**vars(point.operating)),
        state=found.state,
        alarms=len(found.alarms),
        like_baselines=found.baselines,
        reasons=[*point.reasons, *found.reasons],
        links=PointLinks(recording=f"/v1/recordings/{point.recording}"),
    )


def trend_view(trend: Trend) -> TrendView:
    """One series."""
    return TrendView.model_validate(vars(trend))


def alarm_view(alarm: Alarm) -> AlarmView:
    """One alarm."""
    return AlarmView.model_validate({**vars(alarm), "time": _time(alarm.time)})


def verdict_view(found: Verdict) -> VerdictView:
    """One verdict."""
    return VerdictView(
        reconciliation=found.reconciliation,
        finished_at=_time(found.finished),
        verdict=found.verdict,
        sentence=found.sentence,
        level=found.level,
        recordings=list(found.recordings),
        baselines=list(found.baselines),
        links=VerdictLinks(reconciliation=f"/v1/reconciliations/{found.reconciliation}"),
    )


def _time(seconds: float) -> datetime:
    return datetime.fromtimestamp(seconds, UTC)
