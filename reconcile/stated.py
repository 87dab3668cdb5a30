"""What descriptions state, held against the machine: shafts, places of sensors, and speeds that look like rpm."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass

from reconcile.speed import estimate_speed
from reconcile.speed.estimate import ENOUGH
from reconcile.told import place
from signals.recording import Recording
from sim.core.errors import Problem, SpecError
from sim.core.near import did_you_mean, near

PER_MINUTE = 60.0
FAST_HZ = 200.0
"""12000 rpm: machines seldom turn faster, and rpm mistaken for Hz mostly lie above."""
FASTER = 5.0
"""Times `FAST_HZ` from which sixty times another speed is rpm without asking the lines."""
SAME = 0.05
"""By which a factor of 60 may be missed: slip and labels."""
ABOUT = 0.3
"""The same for the machine's own speed against what was recorded at another load or setting."""
PULSES = "the pulses"
USUAL = 0.1
"""A stated speed this near a nominal one is in the unit of the drawing."""
SURE = 0.99
"""Confidence from which lines at a sixtieth of the stated speed speak against it."""

KINDS = ("recording", "baseline")
SLIP = 0.85
"""Likeness (difflib's ratio) to a part's name from which a place is a misspelt part."""


@dataclass(frozen=True, kw_only=True)
class Given:
    """A recording and where it stands: `kind` (`recording`, `baseline`) and number from 0."""

    kind: str
    index: int
    recording: Recording

    def field(self, name: str) -> str:
        """A field of its description, as refusals say it."""
        return place(self.recording, self.kind, self.index, name)


def given(tests: Sequence[Recording], baselines: Sequence[Recording]) -> tuple[Given, ...]:
    """All recordings with their places."""
    groups = (("recording", tests), ("baseline", baselines))
    return tuple(Given(kind=kind, index=i, recording=r) for kind, group in groups for i, r in enumerate(group))


def check_shafts(known: Sequence[str], several: Sequence[Given]) -> None:
    """SpecError for shafts, of the operating point or the tacho, that are none of `known`."""
    problems = []
    for one in several:
        operating, tacho = one.recording.operating, one.recording.tacho
        said = [
            ("operating.shaft", operating.shaft if operating else ""),
            ("tacho.shaft", tacho.shaft if tacho else ""),
        ]
        problems += [
            Problem(
                field=one.field(field),
                message=f"is not a shaft of this machine{did_you_mean(name, known)}",
                given=name,
                allowed=", ".join(known),
            )
            for field, name in said
            if name and name not in known
        ]
    if problems:
        raise SpecError(problems)


def check_locations(parts: Sequence[str], several: Sequence[Given]) -> None:
    """SpecError for channels whose location is nearly the name of a part: a slip of the pen.

    An empty location is one that is not known; other places that are no part are told by `unplaced`.
    """
    problems = [
        Problem(
            field=one.field(f"channels.{c.name}.location"),
            message=f"is no part of this machine{did_you_mean(c.location, parts)}",
            given=c.location,
            allowed=f"{', '.join(parts)}, or none",
        )
        for one in several
        for c in one.recording.channels
        if c.location not in parts and _slipped(c.location, parts)
    ]
    if problems:
        raise SpecError(problems)


def _slipped(location: str, parts: Sequence[str]) -> bool:
    """Whether a place is a part's name with a slip of the pen: another number is another place, `bearing2`."""
    numbers = "".join(filter(str.isdigit, location))
    alike = [p for p in parts if "".join(filter(str.isdigit, p)) == numbers]
    return bool(near(location, alike, like=SLIP))


def unplaced(parts: Sequence[str], several: Sequence[Given]) -> tuple[str, ...]:
    """What the report says of channels at no part of the machine: they count, but at no place."""
    names: dict[str, list[str]] = {}
    for c in (c for one in several for c in one.recording.channels):
        if c.location and c.location not in parts and c.name not in names.setdefault(c.location, []):
            names[c.location].append(c.name)
    return tuple(
        f"{', '.join(channels)} at {location}: no part of this machine, so the place is taken as not known"
        for location, channels in names.items()
    )


def check_speeds(nominal: Mapping[str, float | None], field: str, several: Sequence[Given]) -> None:
    """SpecError for speeds that something contradicts by a factor of 60.

    `nominal`: speed of each shaft in Hz as the machine has it (None: not known), in `field`, `{shaft}` standing for
    the name. A stated speed is held against pulses, the nominal speed, the other recordings, Nyquist's frequency and,
    above 200 Hz, the lines of the shaft. A machine may be recorded at a slow roll too: a speed that its lines or the
    nominal speed confirm stands.
    """
    problems = []
    for one in several:
        stated = _stated(one)
        if stated is not None and (why := _contradicted(one, stated, nominal, several)) is not None:
            miscounted = _miscounted(one, stated, nominal)
            problems.append(miscounted or _rpm(one.field("operating.speed_hz"), stated[1], why))
    if not problems:
        problems += _nominal_in_rpm(nominal, field, several)
    if problems:
        raise SpecError(problems)


def check_turning(several: Sequence[Given]) -> None:
    """SpecError for a stated standstill without pulses that say otherwise."""
    problems = [
        Problem(
            field=one.field("operating.speed_hz"),
            message="says that the machine stands still, and there is no tacho",
            given=operating.speed_hz,
            allowed="> 0",
            unit="Hz",
        )
        for one in several
        if (operating := one.recording.operating) is not None
        and operating.speed_hz == 0.0
        and one.recording.tacho is None
    ]
    if problems:
        raise SpecError(problems)


def exchanged(several: Sequence[Given]) -> tuple[str, ...]:
    """What the report says where a test is described as a baseline, and no baseline is."""
    called = {kind: [o.recording.condition == "baseline" for o in several if o.kind == kind] for kind in KINDS}
    if not any(called["recording"]) or not called["baseline"] or any(called["baseline"]):
        return ()
    return ("a test is described as `baseline`, and no baseline is: check which recording is which",)


def _stated(one: Given) -> tuple[str, float] | None:
    operating = one.recording.operating
    return (operating.shaft, operating.speed_hz) if operating is not None and operating.speed_hz > 0 else None


def _rpm(field: str, speed: float, why: str) -> Problem:
    message = f"looks like rpm: {speed:g} rpm = {speed / PER_MINUTE:.4g} Hz ({why})"
    return Problem(field=field, message=message, given=speed, allowed="revolutions per second")


def _miscounted(one: Given, stated: tuple[str, float], nominal: Mapping[str, float | None]) -> Problem | None:
    """Where several pulses a turn make the difference: the stated speed is about the machine's own."""
    tacho, (shaft, speed) = one.recording.tacho, stated
    pulses = pulses_hz(one.recording, shaft)
    several = tacho is not None and tacho.pulses_per_revolution > 1 and speed <= FAST_HZ
    if tacho is None or pulses is None or not several or not _is_usual(shaft, speed, nominal):
        return None
    counted = tacho.pulses_per_revolution * pulses / speed
    message = f"its pulses make {pulses:.4g} Hz, but {speed:g} Hz are stated, about the machine's own speed"
    field, allowed = one.field("tacho.pulses_per_revolution"), f"about {max(counted, 1.0):.3g} with this speed"
    return Problem(field=field, message=message, given=tacho.pulses_per_revolution, allowed=allowed)


def sixty_times(large: float, small: float) -> bool:
    """Whether `large` may be `small` in rpm."""
    return abs(large / (PER_MINUTE * small) - 1.0) <= SAME


def _contradicted(
    one: Given, stated: tuple[str, float], nominal: Mapping[str, float | None], several: Sequence[Given]
) -> str | None:
    """What says that the stated speed is in rpm, or None."""
    shaft, speed = stated
    pulses = pulses_hz(one.recording, shaft)
    if pulses is not None:
        return f"its tacho says {pulses:.4g} Hz" if sixty_times(speed, pulses) else None
    if _is_usual(shaft, speed, nominal):
        return None
    why = _sixtieth(shaft, speed, nominal, several)
    if why is not None:
        # sixty times what the drawing says and faster than machines turn: lines of impacts are found at any speed
        return why if speed > FAST_HZ * FASTER or not confirmed(one.recording, speed) else None
    if speed >= one.recording.sampling_rate_hz / 2:
        return f"half the sampling rate is {one.recording.sampling_rate_hz / 2:.4g} Hz"
    return _by_lines(one.recording, speed) if speed > FAST_HZ else None


def _is_usual(shaft: str, speed: float, nominal: Mapping[str, float | None]) -> bool:
    """Whether the speed is about the shaft's nominal one; where that is not known, about one of the machine."""
    own = nominal.get(shaft)
    known = [own] if own else [n for n in nominal.values() if n]
    return any(abs(speed / n - 1.0) <= USUAL for n in known)


def _sixtieth(shaft: str, speed: float, nominal: Mapping[str, float | None], several: Sequence[Given]) -> str | None:
    """What else has the shaft at a sixtieth of the speed, or None."""
    usual = nominal.get(shaft)
    if usual and sixty_times(speed, usual):
        return f"the machine's nominal speed is {usual:.4g} Hz"
    for other in several:
        there = _stated(other)
        # a slow run beside a usual one may well differ by that factor
        if there is not None and there[0] == shaft and speed > FAST_HZ and sixty_times(speed, there[1]):
            return f"{other.field('operating.speed_hz')} is {there[1]:.4g}"
    return None


def pulses_hz(recording: Recording, shaft: str) -> float | None:
    """Mean speed of a shaft by its pulses, if there are enough."""
    tacho = recording.tacho
    if tacho is None or tacho.shaft != shaft or tacho.pulse_times_s.size < 3:
        return None
    span = float(tacho.pulse_times_s[-1] - tacho.pulse_times_s[0])
    return (tacho.pulse_times_s.size - 1) / span / tacho.pulses_per_revolution if span > 0 else None


def _certainty(recording: Recording, speed: float) -> float:
    """Confidence of the lines (or pulses) of the shaft at about this speed; 0 where it cannot be read."""
    try:
        return estimate_speed(recording, stated_hz=speed).confidence
    except SpecError:
        return 0.0


def confirmed(recording: Recording, speed: float) -> bool:
    """Lines of a shaft at the speed, Hz, and none at a sixtieth, of which they might be high harmonics or teeth."""
    return _certainty(recording, speed) >= ENOUGH and _certainty(recording, speed / PER_MINUTE) < SURE


def _by_lines(recording: Recording, speed: float) -> str | None:
    """Lines of a shaft at a sixtieth of the speed where there are none at the speed."""
    if _certainty(recording, speed) >= ENOUGH or _certainty(recording, speed / PER_MINUTE) < SURE:
        return None
    slow = estimate_speed(recording, stated_hz=speed / PER_MINUTE)
    return f"lines of a shaft stand at multiples of {slow.speed_hz:.4g} Hz, none at those of {speed:.4g} Hz"


def _nominal_in_rpm(nominal: Mapping[str, float | None], field: str, several: Sequence[Given]) -> Iterator[Problem]:
    """Speeds of the machine that are about 60 times those of a recording (by pulses, else as stated), and high; slow
    rolls of fast machines are none: one whose own lines confirm it, or beside which the nominal speed is recorded.

    A shaft whose speed no recording tells is held against Nyquist's frequency and its lines.
    """
    for shaft, usual in nominal.items():
        if usual is None or usual <= FAST_HZ:
            continue
        here = [(one, *found) for one in several if (found := _turned(one, shaft)) is not None]
        if not here:
            why = _unrecorded(usual, several)
            if why is not None:
                yield _rpm(field.format(shaft=shaft), usual, why)
            continue
        slow = next((x for x in here if abs(usual / (PER_MINUTE * x[1]) - 1.0) <= ABOUT), None)
        if slow is None or any(_runs_at(usual, one.recording, speed) for one, speed, _ in here):
            continue
        one, speed, why = slow
        pulsed = why.startswith(PULSES)
        # just a sixtieth is no slow roll if pulses count it, or if the nominal speed is faster than machines turn
        certain = sixty_times(usual, speed) and (pulsed or usual > FAST_HZ * FASTER)
        if certain or not (pulsed or _certainty(one.recording, speed) >= ENOUGH):
            yield _rpm(field.format(shaft=shaft), usual, why)


def _turned(one: Given, shaft: str) -> tuple[float, str] | None:
    """Speed of a shaft in a recording, Hz, by pulses or else as stated, and what says so; None where nothing does."""
    pulses = pulses_hz(one.recording, shaft)
    if pulses is not None:
        return pulses, f"{PULSES} of {one.field('tacho')} say {pulses:.4g} Hz"
    stated = _stated(one)
    if stated is None or stated[0] != shaft:
        return None
    return stated[1], f"{one.field('operating.speed_hz')} is {stated[1]:.4g}"


def _unrecorded(usual: float, several: Sequence[Given]) -> str | None:
    """What says that a shaft's speed is in rpm where no recording states or counts it, or None."""
    slowest = min(several, key=lambda one: one.recording.sampling_rate_hz).recording
    if usual >= slowest.sampling_rate_hz / 2:
        return f"half the sampling rate is {slowest.sampling_rate_hz / 2:.4g} Hz"
    found = [_by_lines(one.recording, usual) for one in several]
    return found[0] if found and all(why is not None for why in found) else None


def _runs_at(usual: float, recording: Recording, speed: float) -> bool:
    """Whether it states about this speed and its lines don't speak against that."""
    return abs(speed / usual - 1.0) <= USUAL and _by_lines(recording, speed) is None
