"""Rows by their numbers, without any folder."""

from __future__ import annotations

import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from sideband_datasets.make.about import columns_of
from sideband_datasets.make.batch import Failure, Made, failed, recorded
from sideband_datasets.make.beside import recorded_beside
from sideband_datasets.make.peaks import Predicted, peaks_of, predicted
from sideband_datasets.plan.check import window_length_s
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.size import batch_size
from sideband_datasets.plan.tried import make_plan
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.row import Row
from signals.features import features
from signals.sensors.clock import stretch
from signals.sensors.spec import Tacho
from signals.series import Series
from sim.core.errors import Problem, SidebandError, SpecError
from sim.core.speed import mean_ratio


def rows(
    recipe: Recipe,
    indices: Sequence[int] | None = None,
    *,
    failed: Callable[[Failure], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    made: Callable[[int], None] | None = None,
) -> Iterator[Row]:
    """The rows `indices` of a dataset in their order (none: all), made as they are asked for, in constant memory.

    Row i is a pure function of (recipe, i): the same bytes alone, in any order and beside any others. A recording that
    cannot be made (diverged, meaningless, impossible) is told to `failed`, or warned of, and its rows are left out.
    `made` is told how many rows were done, ahead of the rows themselves, which come in their order.
    Raises SpecError for a recipe that cannot be planned or an index beyond it, Cancelled.
    """
    return rows_of(make_plan(recipe), indices, failed=failed, cancelled=cancelled, made=made)


def rows_of(
    plan: Plan,
    indices: Sequence[int] | None = None,
    *,
    failed: Callable[[Failure], None] | None = None,
    cancelled: Callable[[], bool] | None = None,
    made: Callable[[int], None] | None = None,
) -> Iterator[Row]:
    """`rows` of a plan that was made before: only the machines of these rows are built."""
    wanted = range(plan.rows) if indices is None else [int(i) for i in indices]
    beyond = [i for i in wanted if not 0 <= i < plan.rows] if indices is not None else []
    if beyond:
        raise SpecError(
            Problem(field="indices", message="no such row", given=beyond[0], allowed=f"0 to {plan.rows - 1}")
        )
    return _rows(plan, wanted, _Told(failed=failed or _warn, made=made or _nobody), cancelled)


@dataclass(frozen=True, kw_only=True)
class _Told:
    failed: Callable[[Failure], None]
    made: Callable[[int], None]


def _nobody(count: int) -> None:
    """Nobody counts."""


def _warn(failure: Failure) -> None:
    message = f"recording {failure.recording_id} failed, its rows are left out ({failure.kind}): {failure.reason}"
    warnings.warn(message, stacklevel=4)


def _rows(plan: Plan, wanted: Sequence[int], told: _Told, cancelled: Callable[[], bool] | None) -> Iterator[Row]:
    size = plan.rows_per_recording
    source = recorded_beside if plan.recipe.beside_sound else recorded
    for batch in _batches(wanted, size, batch_size(plan)):
        members: dict[int, list[int]] = {}
        for i in dict.fromkeys(batch):
            members.setdefault(i // size, []).append(i)
        found: dict[int, Row] = {}
        failures: dict[int, Failure] = {}
        for number, one in source(plan, list(members), cancelled):
            made = one if isinstance(one, Failure) else _cut_or_failed(plan, one, members[number])
            if isinstance(made, Failure):
                failures[number] = made
            else:
                found |= {row.row: row for row in made}
            told.made(len(members[number]))
        for number in sorted(failures):
            told.failed(failures[number])
        yield from (found[i] for i in batch if i in found)


def _batches(wanted: Sequence[int], size: int, most: int) -> Iterator[list[int]]:
    """Rows in their order, as many at once as are of `most` recordings of `size` rows."""
    batch: list[int] = []
    recordings: set[int] = set()
    for i in wanted:
        if i // size not in recordings and len(recordings) == most:
            yield batch
            batch, recordings = [], set()
        batch.append(i)
        recordings.add(i // size)
    if batch:
        yield batch


def _cut_or_failed(plan: Plan, made: Made, members: Sequence[int]) -> list[Row] | Failure:
    try:
        return cut(plan, made, members)
    except SidebandError as error:
        return failed(plan, made, error)


def speed_ratio(made: Made, first_s: float, last_s: float) -> float:
    """Mean speed in a stretch over the mean of all that was simulated; 1 where it holds."""
    profile = made.response.speed
    if profile[0] == 0:
        return 1.0
    end_s = float(made.recording.start_s + made.recording.duration_s)
    return mean_ratio(profile, first_s, last_s) / max(mean_ratio(profile, 0.0, end_s), 1e-12)


def bases_of(made: Made, first_s: float, last_s: float) -> Mapping[str, float]:
    """Base frequencies at the mean speed of a stretch, as the recorder's clock has them if there is a tacho, Hz."""
    response, chain = made.response, made.drawing.chain
    ratio = speed_ratio(made, first_s, last_s)
    bases = {name: hz * ratio for name, hz in response.bases_hz.items()} if ratio != 1.0 else response.bases_hz
    if chain is not None and any(isinstance(channel, Tacho) for channel in chain.channels):
        bases = {name: hz / stretch(chain.clock) for name, hz in bases.items()}
    return bases


def _places(plan: Plan, made: Made) -> tuple[int, list[int]]:
    """Length of a window and the first sample of each; SpecError where they do not fit."""
    recipe, rate = plan.recipe, made.recording.sampling_rate_hz
    operating = made.recording.operating
    length_s = window_length_s(recipe, operating.speed_hz if operating else None)
    span_s = recipe.windows.span(length_s)
    slack_s = recipe.duration_s - span_s
    if slack_s < -1e-9 * recipe.duration_s:
        message = f"{recipe.windows.per_recording} windows need {span_s:.6g} s; the recording is shorter"
        raise SpecError(Problem(field="duration_s", message=message, given=recipe.duration_s, unit="s"))
    length = round(length_s * rate)
    hop_s = length_s * (1.0 - recipe.windows.overlap)
    start_s = recipe.settle_s + max(slack_s, 0.0) * made.drawing.shift
    total = made.recording.samples.shape[1]
    firsts = [round((start_s + k * hop_s) * rate) for k in range(recipe.windows.per_recording)]
    # Rounding may put the last window a sample beyond the end.
    return length, [min(first, total - length) for first in firsts]


def cut(plan: Plan, made: Made, members: Sequence[int]) -> list[Row]:
    """Rows `members` of a recording."""
    length, firsts = _places(plan, made)
    recording = made.recording
    if length < 2 or min(firsts) < 0:
        message = "is too short for two samples, or longer than the recording"
        raise SpecError(Problem(field="windows", message=message, given=length, unit="samples"))
    found = []
    known: dict[int, tuple[Mapping[str, float], Predicted | None]] = {}
    for member in members:
        window, row = divmod(member % plan.rows_per_recording, len(recording.channels))
        if row >= len(recording.channels):
            raise SpecError(Problem(field="indices", message="no such channel", given=member))
        start_s = recording.start_s + firsts[window] / recording.sampling_rate_hz
        if window not in known:
            bases = bases_of(made, start_s, start_s + length / recording.sampling_rate_hz)
            known[window] = bases, predicted(made, bases) if plan.recipe.peaks.spectra else None
        found.append(_row(plan, made, member, (window, row, firsts[window], length), known[window]))
    return found


def _row(
    plan: Plan,
    made: Made,
    number: int,
    place: tuple[int, int, int, int],
    known: tuple[Mapping[str, float], Predicted | None],
) -> Row:
    window, channel_row, first, length = place
    bases_hz, lines = known
    recording = made.recording
    channel = recording.channels[channel_row]
    signal = recording.samples[channel_row, first : first + length].astype(np.float32)
    start_s = recording.start_s + first / recording.sampling_rate_hz
    ratio = speed_ratio(made, start_s, start_s + length / recording.sampling_rate_hz)
    # Features and peaks are those of the samples as they are stored.
    series = Series(
        samples=signal.astype(np.float64),
        sampling_rate_hz=recording.sampling_rate_hz,
        unit=channel.unit,
        name=channel.name,
        quantity=channel.quantity,
        start_s=start_s,
    )
    said = features(series)
    columns = columns_of(made, channel, bases_hz, ratio)
    return Row(
        **columns,  # type: ignore[arg-type]
        signal_id=f"{made.drawing.recording_id}-w{window:03d}-{channel.name}",
        row=number,
        window=window,
        start_s=start_s,
        samples=length,
        rms=said.rms,
        peak=said.peak,
        peak_to_peak=said.peak_to_peak,
        kurtosis=said.kurtosis,
        skewness=said.skewness,
        crest_factor=said.crest_factor,
        peaks=peaks_of(series, made, lines, bases_hz, plan.recipe.peaks),
        signal=signal,
    )
