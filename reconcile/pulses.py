"""Pulses held against the speed that a recording states: a wrong number of pulses per revolution shifts every order."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.kinematics.families import ties
from reconcile.kinematics.spec import KinematicSpec
from reconcile.report.words import percent
from reconcile.speed import estimate_speed
from reconcile.speed.estimate import ENOUGH, SEARCH, line_logs
from reconcile.speed.octave import ABSENT, LEAST_LINES, PRESENT, peak_near
from reconcile.stated import Given
from signals.angle.pulses import SCATTERED, UNEVEN, scattered
from signals.recording import Operating, Recording
from signals.series import FloatArray
from sim.core.errors import Problem, SpecError

SAME_SPEED = 0.05
"""Relative difference up to which pulses and statement may be of one speed: labels are that wrong."""
MOST_PER_REVOLUTION = 10_000
FEWEST_TURNS, TURNS_NEEDED = 2.0, 12
"""Turns below which pulses that contradict the stated speed are put down to the length; what the engines need."""
LINES = 4
"""Multiples of a speed that are looked for lines."""
COUNTED = "(pulses_per_revolution"
"""Begins what is allowed where another number of pulses fits."""
STATED = "are stated"
"""Who says a speed: the recording."""
MILLISECONDS = 1000.0
NEAR_WHOLE = 0.03
"""By which a number of pulses per revolution that would fit may miss a whole one."""
MISCOUNTED = 0.03
"""Difference from which pulses may be miscounted, where another whole number of them fits the label and the lines."""


def check_pulses(several: Sequence[Given], machine: KinematicSpec | None = None) -> None:
    """SpecError for pulses more than a tenth off the stated speed, all along, whose speed lines do not confirm.

    Labels are wrong by some per cent, and there pulses are right, unless another whole number of them a turn fits the
    label and lines of the shaft confirm that. Further off one of both is wrong. The pulses stand where lines of the
    shaft are at their speed and none at the stated one. With a `machine`, pulses of another shaft than the stated one
    are held against what that makes of it; where none is stated, against the machine's own, which a drive may leave:
    there they are refused only where another whole number a turn fits.
    """
    problems = []
    for one in several:
        field = one.field("tacho.pulses_per_revolution")
        held, said, ratio = _of_one_shaft(one.recording, machine)
        far = contradiction(held, field, SEARCH, all_along=True, said=said)
        short = _too_short(held, one.field("samples")) if far is not None else None
        if short is not None:
            problems.append(short)
            continue
        fits = far is not None and COUNTED in str(far.allowed)
        if far is not None and not _by_lines(held, ratio):
            problems += [_with_rate(far, held, ratio)] if fits or one.recording.operating is not None else []
        elif far is None and (near := contradiction(held, field, MISCOUNTED, said=said)) is not None:
            problems += [near] if COUNTED in str(near.allowed) and _miscounted(held) else []
    if problems:
        raise SpecError(problems)


def _too_short(recording: Recording, field: str) -> Problem | None:
    """What is wrong with a recording of less than a turn or two at the stated speed: nothing is told by pulses."""
    assert recording.operating is not None
    turns = recording.duration_s * recording.operating.speed_hz
    if turns >= FEWEST_TURNS:
        return None
    return Problem(
        field=field,
        message="are too short to hold turns of the shaft, or pulses of it",
        given=f"{recording.samples.shape[1]} samples, {turns:.2g} turns at the stated speed",
        allowed=f"at least {TURNS_NEEDED} turns",
    )


def _with_rate(problem: Problem, recording: Recording, ratio: float) -> Problem:
    """The problem, with what else would fit where lines of the vibration stand with the pulses.

    Pulses and vibration share their clock: where the vibration has lines at multiples of the pulses' speed alone, what
    is wrong is as well the sampling rate, or the stated speed.
    """
    operating, tacho = recording.operating, recording.tacho
    assert operating is not None and tacho is not None
    times = operating.speed_hz and _mean_hz(tacho.pulse_times_s, tacho.pulses_per_revolution) / operating.speed_hz
    if (
        COUNTED not in problem.allowed
        or round(times) < 2
        or not _only_with(recording, operating.speed_hz / ratio, round(times))
    ):
        return problem
    rate = recording.sampling_rate_hz / round(times)
    also = (
        f"; lines of the vibration stand at the pulses' speed too, so a sampling_rate_hz of {rate:.6g} or a speed_hz "
        f"of {operating.speed_hz * times:.4g} would fit as well)"
    )
    return replace(problem, allowed=problem.allowed.removesuffix(")") + also)


def _only_with(recording: Recording, speed_hz: float, times: int) -> bool:
    """Whether lines stand at multiples of `times` the speed, and none at its other multiples."""
    try:
        combs = line_logs(replace(recording, tacho=None))
    except SpecError:
        return False

    def level(order: int) -> float:
        return float(np.mean([peak_near(log, order * speed_hz / resolution) for log, resolution in combs]))

    of_pulses = [level(times * k) for k in range(1, LINES + 1)]
    others = [level(k) for k in range(1, times * LINES) if k % times][: 2 * LINES]
    return sum(x >= PRESENT for x in of_pulses) >= LEAST_LINES and sum(others) <= ABSENT * sum(of_pulses)


def _of_one_shaft(recording: Recording, machine: KinematicSpec | None) -> tuple[Recording, str, float]:
    """The recording with a speed of the shaft that the pulses are of, as far as it can be told, who says it, and how
    many times as fast as the shaft whose speed is known that shaft turns."""
    operating, tacho, plain = recording.operating, recording.tacho, STATED
    if tacho is None or machine is None or (operating is not None and operating.shaft == tacho.shaft):
        return recording, plain, 1.0
    known = {s.name: s.speed_hz for s in machine.shafts}
    shaft = operating.shaft if operating else next((n for n in (tacho.shaft, *known) if known.get(n)), None)
    hz = operating.speed_hz if operating else known.get(shaft or "")
    if shaft is None or hz is None:
        return recording, plain, 1.0
    try:
        ratio = ties(machine, shaft).shafts[tacho.shaft]
    except (SpecError, KeyError):
        return recording, plain, 1.0  # told where the shafts are tied
    said = "are in the machine file"
    if shaft != tacho.shaft:
        said = f"of {tacho.shaft} go with the {hz:.4g} Hz {'stated' if operating else 'in the machine file'} of {shaft}"
    return replace(recording, operating=Operating(shaft=tacho.shaft, speed_hz=hz * ratio)), said, ratio


def _miscounted(recording: Recording) -> bool:
    """Whether lines of the shaft stand nearer to the stated speed than to that of the pulses."""
    operating, tacho = recording.operating, recording.tacho
    assert operating is not None and tacho is not None
    hz = _mean_hz(tacho.pulse_times_s, tacho.pulses_per_revolution)
    try:
        found = estimate_speed(replace(recording, tacho=None), shaft=operating.shaft)
    except SpecError:
        return False
    sure = found.method == "harmonics" and found.confidence >= ENOUGH
    return sure and abs(found.speed_hz - operating.speed_hz) < 0.5 * abs(found.speed_hz - hz)


def _mean_hz(times: FloatArray, per_turn: int) -> float:
    return float((times.size - 1) / (times[-1] - times[0]) / per_turn)


def contradiction(
    recording: Recording,
    field: str,
    within: float = SAME_SPEED,
    *,
    all_along: bool = False,
    said: str = STATED,
) -> Problem | None:
    """What is wrong where the mean speed by the pulses of the stated shaft is further than `within` from the stated
    one, `all_along`: where the speed at every time is; None elsewhere. `said`: who says the latter."""
    operating, tacho = recording.operating, recording.tacho
    if operating is None or tacho is None or tacho.shaft != operating.shaft or tacho.pulse_times_s.size < 2:
        return None
    times, per_turn, stated = tacho.pulse_times_s, tacho.pulses_per_revolution, operating.speed_hz
    hz = _mean_hz(times, per_turn)
    slow, fast = _range_hz(times, per_turn) if all_along else (hz, hz)
    if min(slow, hz) / stated <= 1.0 + within and max(fast, hz) / stated >= 1.0 - within:
        return None
    message = f"its pulses make {hz:.4g} Hz, but {stated:.4g} Hz {said}"
    if abs(MILLISECONDS * hz / stated - 1.0) <= SAME_SPEED:
        return Problem(
            field=field.replace("pulses_per_revolution", "pulse_times_s"),
            message=f"{message}: the times look like milliseconds",
            given=f"{times[0]:.6g} to {times[-1]:.6g}",
            allowed="times in seconds",
        )
    uneven = scattered(times, per_turn, round(hz * per_turn / stated))
    if uneven > SCATTERED:
        return Problem(
            field=field,
            message=f"{message}, and they do not look like those of a tacho: {uneven:.0%} of the intervals between the "
            f"{times.size} pulses differ from the next by more than {UNEVEN:.0%}",
            given=per_turn,
            allowed="evenly spaced pulses: another column or threshold of the tacho, or none",
        )
    near, fits = f"pulses and speed_hz within {percent(within)} of each other", _would_fit(hz, stated, per_turn)
    if not fits and said == STATED:  # no number of pulses mends it
        named = field.replace("tacho.pulses_per_revolution", "operating.speed_hz")
        return Problem(field=named, message=message, given=stated, allowed=f"{near} (speed_hz {hz:.4g} would fit)")
    return Problem(field=field, message=message, given=per_turn, allowed=near + fits)


def _range_hz(times: FloatArray, per_turn: int) -> tuple[float, float]:
    """Slowest and fastest speed of a whole turn, Hz: single intervals jitter."""
    step = per_turn
    if times.size <= 3 * step:
        hz = _mean_hz(times, per_turn)
        return hz, hz
    turns = 1.0 / (times[step:] - times[:-step])
    low, high = np.quantile(turns, (0.05, 0.95))
    return float(low), float(high)


def _would_fit(hz: float, stated: float, per_turn: int) -> str:
    """The whole number of pulses per revolution that makes the stated speed, if there is one."""
    fit = hz * per_turn / stated
    whole = round(fit)
    if (
        not 1 <= whole <= MOST_PER_REVOLUTION
        or abs(fit / whole - 1.0) > min(NEAR_WHOLE, 0.25 / whole)
        or whole == per_turn
    ):
        return ""
    return f" {COUNTED} {whole} would fit)"


def _by_lines(recording: Recording, ratio: float) -> bool:
    """Whether lines of a shaft stand at the speed of the pulses, and none at the stated speed: of the one that turns
    1 / `ratio` times as fast as that of the pulses."""
    operating, tacho = recording.operating, recording.tacho
    assert operating is not None and tacho is not None
    hz, stated = _mean_hz(tacho.pulse_times_s, tacho.pulses_per_revolution) / ratio, operating.speed_hz / ratio
    bare = replace(recording, tacho=None)
    try:
        at_pulses = estimate_speed(bare, shaft=operating.shaft, stated_hz=hz).confidence
        at_stated = estimate_speed(bare, shaft=operating.shaft, stated_hz=stated).confidence
    except SpecError:
        return False
    return at_pulses >= ENOUGH > at_stated
