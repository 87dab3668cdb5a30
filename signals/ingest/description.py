"""The description of a recording: the JSON that says what the numbers in a file are."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from datetime import datetime
from typing import Annotated, Literal, Self

from pydantic import BaseModel, ConfigDict, Field, ValidationError, field_validator, model_validator

from signals.validation import problems_of, shown
from sim.core.errors import Problem, SpecError
from sim.core.near import near
from sim.core.spec.base import WHOLE

MAX_CHANNELS = 512
MAX_PULSES = 1_000_000
MOST_NAME = 80
ALIKE = 0.8
WORDS = "operating."
"""Before the keys of an operating point in words."""
"""An unknown key this similar to a known one (difflib's ratio) is taken for a slip of the pen and refused."""

Text = Annotated[str, Field(max_length=200)]
ColumnName = Annotated[str, Field(min_length=1, max_length=200)]
ColumnIndex = Annotated[int, Field(ge=0, lt=100_000)]
Column = ColumnName | ColumnIndex
MachineName = Annotated[str, Field(min_length=1, max_length=80, pattern=r"^[A-Za-z0-9][A-Za-z0-9._-]*$")]
BearingName = Annotated[str, Field(min_length=1, max_length=MOST_NAME)]
VibrationClass = Literal["group1-rigid", "group1-flexible", "group2-rigid", "group2-flexible"]
Pulses = Annotated[tuple[Annotated[float, Field(allow_inf_nan=False)], ...], Field(max_length=MAX_PULSES, strict=False)]


class _Part(BaseModel):
    """Frozen and strict about types. Further keys are kept as a person's own remarks, unless they look like a slip."""

    model_config = ConfigDict(
        frozen=True, extra="allow", strict=True, allow_inf_nan=False, use_attribute_docstrings=True
    )


class Sensitivity(_Part):
    """What a sensor puts out per unit of what it senses, as `{"value": 10.2, "unit": "mV/(m/s^2)"}` or 100 `mV/g`."""

    value: Annotated[float, Field(gt=0, allow_inf_nan=False)]
    unit: Annotated[str, Field(min_length=3, max_length=40)]


class ChannelEntry(_Part):
    """One channel. `unit` is that of the stored numbers."""

    name: Annotated[str, Field(min_length=1, max_length=120)]
    column: Column | None = None
    """Array or column of the file (default: the channel's name), with an index where an array holds several channels:
    `data[:,0]`; a whole number counts columns from 0."""
    quantity: Text = ""
    """`acceleration`, `velocity`, `displacement`, `force` ...; default: what the unit measures."""
    unit: Annotated[str, Field(min_length=1, max_length=80)]
    """`g`, `m/s^2`, `mm/s`, `um`, `V` ...; `1`: dimensionless; `uncalibrated`: the scale is not known."""
    location: Text = ""
    axis: Text = ""
    sensitivity: Sensitivity | float | None = None
    """Of the sensor. A channel stored in volts is turned into what the sensor senses; elsewhere it is information."""


class OperatingEntry(_Part):
    """The operating point: the shaft's name, its speed in revolutions per second, its torque."""

    shaft: Annotated[str, Field(min_length=1, max_length=80)] = "shaft"
    """Left out: that of the tacho, else the only one of `kinematics`, else `shaft`."""
    speed_hz: Annotated[float, Field(ge=0, le=1e5, allow_inf_nan=False)]
    torque_nm: Annotated[float, Field(allow_inf_nan=False)] | None = None


class TachoEntry(_Part):
    """Pulses of a shaft: a `channel` (or `column`) with the pulse signal, or their times."""

    shaft: Annotated[str, Field(min_length=1, max_length=80)]
    channel: Column | None = None
    """Name of a channel above, else an array or column of the file."""
    column: Column | None = None
    pulse_times_s: Pulses | ColumnName | None = None
    """Times on the clock of the samples, s: a list, or the name of an array in the file."""
    pulses_per_revolution: Annotated[int, WHOLE, Field(ge=1, le=100_000, strict=False)] = 1
    threshold: Annotated[float, Field(allow_inf_nan=False)] | None = None
    """Level whose rising crossing is a pulse, as stored; default: half way between low and high."""

    @model_validator(mode="after")
    def _one_source(self) -> Self:
        if sum(x is not None for x in (self.channel, self.column, self.pulse_times_s)) != 1:
            raise ValueError("give exactly one of `channel`, `column` and `pulse_times_s`")
        return self


class TimeEntry(_Part):
    """A column of time stamps."""

    column: Column
    unit: Annotated[str, Field(max_length=10)] = "s"


class Description(_Part):
    """What the numbers of a file are."""

    sampling_rate_hz: Annotated[float, Field(ge=1e-3, le=1e9, allow_inf_nan=False)] | None = None
    """May be left out only where the file itself states it (wav, flac, uff, tdms, mf4, `sampling_rate_hz` in npz and
    mat) or a `time` column gives it."""
    channels: Annotated[tuple[ChannelEntry, ...], Field(max_length=MAX_CHANNELS, strict=False)]
    operating: OperatingEntry | None = None
    tacho: TachoEntry | None = None
    time: TimeEntry | None = None
    machine: MachineName | None = None
    """Short name of the machine it is of: recordings of one name are followed together (`/v1/machines`)."""
    recorded_at: Annotated[str, Field(max_length=40)] | None = None
    """When the first sample was taken: ISO 8601 with its offset from UTC, `2026-03-01T08:30:00Z`."""
    kinematics: dict[str, object] | None = None
    """Shafts, bearings and teeth of the machine, by which its lines are named: what docs/reconcile.md puts behind
    `kinematics`."""
    bearing: BearingName | dict[str, object] | None = None
    """The one bearing of the machine, in place of `kinematics`: a catalogue number (`6205`), or an object as in
    `kinematics.bearings` without name and shaft."""
    vibration_class: VibrationClass | None = None
    """Group and foundation of ISO 10816-3:2009, where its limits are to be applied: `group1` above 300 kW, `group2`
    from 15 to 300 kW, channels on bearing housings."""
    condition: Literal["baseline", "unknown"] = "unknown"
    origin: Literal["measured", "simulated"] = "measured"
    start_s: Annotated[float, Field(ge=-1e12, le=1e12, allow_inf_nan=False)] = 0.0
    """Time of the first sample, s."""
    notes: Annotated[str, Field(max_length=20_000)] = ""
    data: Annotated[str, Field(min_length=1, max_length=400)] | None = None
    """The file, relative to the description; default: the one beside it with the same stem."""

    @model_validator(mode="before")
    @classmethod
    def _only_shaft(cls, given: object) -> object:
        if not isinstance(given, Mapping):
            return given
        if _tells_no_speed(given.get("operating")):
            return {**given, "operating": None, **_in_words(given["operating"])}
        operating, shaft = given.get("operating"), _only_shaft(given)
        if not isinstance(operating, Mapping) or "shaft" in operating or shaft is None:
            return given
        return {**given, "operating": {**operating, "shaft": shaft}}

    @field_validator("recorded_at")
    @classmethod
    def _moment(cls, text: str | None) -> str | None:
        if text is not None and moment(text) is None:
            raise ValueError("must be ISO 8601 with an offset from UTC, as 2026-03-01T08:30:00Z")
        return text

    @field_validator("bearing", mode="before")
    @classmethod
    def _one_bearing(cls, given: object) -> object:
        named = isinstance(given, str) and 0 < len(given) <= MOST_NAME
        if given is not None and not isinstance(given, Mapping) and not named:
            raise ValueError("must be a catalogue number, or an object as in kinematics.bearings")
        return given

    @field_validator("channels")
    @classmethod
    def _some(cls, channels: tuple[ChannelEntry, ...]) -> tuple[ChannelEntry, ...]:
        if not channels:
            raise ValueError("give at least one channel")
        return channels


def _only_shaft(document: Mapping[str, object]) -> str | None:
    """The shaft of a description that names but one: that of its tacho, else the only one of its kinematics."""
    tacho, kinematics = document.get("tacho"), document.get("kinematics")
    shafts = kinematics.get("shafts") if isinstance(kinematics, Mapping) else None
    named = [tacho, *(shafts if isinstance(shafts, list) and len(shafts) == 1 else ())]
    names = [x.get(key) for x, key in zip(named, ("shaft", "name"), strict=False) if isinstance(x, Mapping)]
    return next((name for name in names if isinstance(name, str) and name), None)


def moment(text: str) -> datetime | None:
    """A point in time with its offset from UTC; None for what is none."""
    try:
        found = datetime.fromisoformat(text)
        return found if found.tzinfo is not None and found.timestamp() is not None else None
    except (ValueError, OverflowError):
        return None


def read_description(document: object) -> Description:
    """The description in a JSON value; SpecError names every field that must change."""
    if not isinstance(document, Mapping):
        given = shown(document)
        raise SpecError(Problem(field="description", message="is not an object", given=given, allowed="a JSON object"))
    try:
        found = Description.model_validate(document)
    except ValidationError as error:
        raise SpecError([*problems_of(error, model=Description), *_slips(document)]) from error
    problems = [*_slips(document), *_doubled(found)]
    if problems:
        raise SpecError(problems)
    return found


def remarks(description: Description) -> tuple[str, ...]:
    """Keys that mean nothing here, by place: they are kept out of the recording, and this is said."""
    return tuple(f"{place}: is not used here{_belongs(place)}" for place in _unknown(description, ""))


def _belongs(place: str) -> str:
    """Where a field of the operating point was meant, that stands at the top; why one in words counts for nothing."""
    if place.startswith(WORDS):
        return ": it is no number, so no operating point is stated"
    if place in ("rpm", "speed_rpm"):
        return "; it belongs under `operating`, as `operating.speed_hz`: revolutions a minute over 60"
    return f"; it belongs under `operating`, as `operating.{place}`" if place in OperatingEntry.model_fields else ""


def _unknown(part: BaseModel, prefix: str) -> Iterator[str]:
    for key in part.model_extra or {}:
        yield f"{prefix}{key[:80]}"
    for name in type(part).model_fields:
        value = getattr(part, name)
        members = enumerate(value) if isinstance(value, tuple) else [(None, value)]
        for i, member in members:
            if isinstance(member, BaseModel):
                yield from _unknown(member, f"{prefix}{name}." if i is None else f"{prefix}{name}[{i}].")


_PARTS: tuple[tuple[str, type[BaseModel]], ...] = (
    ("operating", OperatingEntry),
    ("tacho", TachoEntry),
    ("time", TimeEntry),
)


def _slips(document: Mapping[str, object]) -> list[Problem]:
    """Unknown keys that look like known ones."""
    found = _alike(document, Description, "")
    for name, model in _PARTS:
        found += _alike(document.get(name), model, f"{name}.")
    channels = document.get("channels")
    for i, entry in enumerate(channels if isinstance(channels, list) else []):
        found += _alike(entry, ChannelEntry, f"channels.{i}.")
    return found


def _tells_no_speed(operating: object) -> bool:
    """Whether an operating point holds no number, under whatever name, nor one in words (`29,5`) under a name that is
    its own or like one: as if it had been left out."""
    if not isinstance(operating, Mapping) or not isinstance(operating.get("shaft", ""), str):
        return False
    return all(value is None or (isinstance(value, str) and not _number(k, value)) for k, value in operating.items())


def _in_words(operating: Mapping[str, object]) -> dict[str, object]:
    """What stands there in words, as keys that mean nothing here, so that it is said; but for the shaft's name."""
    return {f"{WORDS}{k}": v for k, v in operating.items() if v is not None and k != "shaft"}


def _number(key: object, text: str) -> bool:
    numbers = [name for name in OperatingEntry.model_fields if name != "shaft"]
    return any(map(str.isdigit, text)) and bool(near(str(key), numbers, most=1))


def _alike(part: object, model: type[BaseModel], prefix: str) -> list[Problem]:
    if not isinstance(part, Mapping):
        return []
    problems = []
    for key in part:
        if isinstance(key, str) and key not in model.model_fields:
            alike = near(key, model.model_fields, most=1, like=ALIKE)
            if alike:
                message = f"is not a known field (did you mean {alike[0]}?)"
                given = shown(part[key])
                problems.append(Problem(field=f"{prefix}{key[:80]}", message=message, given=given, allowed=alike[0]))
    return problems


def _doubled(description: Description) -> list[Problem]:
    names = [entry.name for entry in description.channels]
    message = "is the name of another channel too"
    return [
        Problem(field=f"channels.{i}.name", message=message, given=name)
        for i, name in enumerate(names)
        if names.index(name) != i
    ]
