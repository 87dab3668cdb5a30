"""Pictures of a driven analysis, in the shapes of `reconcile.report.pictures`."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import scipy

from reconcile.driven.channels import FloatArray
from reconcile.driven.forced import Analysis
from reconcile.driven.model import Model, Run, bounded, ready, simulated
from reconcile.driven.nominate import score_nats
from reconcile.driven.split import strongest
from reconcile.force_law.picture import Curve, curve, surface
from reconcile.force_law.samples import ForceSamples

SHOWN = 600
"""Samples of the stretch shown."""
FLOOR_DB = -300.0
UNKNOWN_FORCE = "unit of the model"
"""Of a force whose channel carries no unit of force: one of the channel's own is read as 1 N."""


@dataclass(frozen=True, kw_only=True)
class Shown:
    """A stretch of held-out data: input from rest through a warm-up, and what is shown of the output after it."""

    drive: FloatArray
    time_s: FloatArray
    observed: FloatArray
    before: FloatArray
    after: FloatArray


def _shown(run: Run) -> tuple[int, int]:
    """First sample after the warm-up, and count, of the liveliest stretch."""
    count = min(SHOWN, run.data.answer.size - run.skip)
    return strongest(run.data.answer[run.skip :], count), count


def _times(run: Run, count: int) -> FloatArray:
    return np.asarray(np.arange(run.skip, run.skip + count) * run.data.step_s, dtype=np.float64)


def shown_stretch(found: Analysis) -> Shown:
    """The liveliest `SHOWN` samples of the held-out part, with a warm-up so that a run from rest is the same there."""
    data = found.held_run.data
    warm = found.held_run.skip
    first, count = _shown(found.held_run)
    part = data.part(first, first + warm + count)
    run = ready(part, 0.0)

    def run_of(model: Model) -> FloatArray:
        return bounded(simulated(model, run), run)[warm:]

    return Shown(
        drive=part.drive,
        time_s=_times(found.held_run, count),
        observed=part.answer[warm:],
        before=run_of(found.linear.model),
        after=run_of(found.published),
    )


@dataclass(frozen=True, kw_only=True)
class Freed:
    """The latent force without the linear part that goes with the laws, and the laws over displacement alone."""

    samples: ForceSamples
    over: Curve
    fitted: FloatArray | None
    rate: bool
    """Whether the picture is over velocity."""


def freed_force(found: Analysis, mass_kg: float, seed: int) -> Freed:
    """Force in N: latent force less the linear law that, beside the named laws, fits it best."""
    samples = found.latent
    z, v = samples.displacement_m, samples.velocity_m_per_s
    model = found.final.model
    rate = bool(model.laws) and all(law.rate for law in model.laws)

    def named(x: FloatArray, y: FloatArray) -> FloatArray:
        parts = [c * law.values(x, y) for law, c in zip(model.laws, model.coefficients, strict=True)]
        return np.asarray(np.sum(parts, axis=0)) if parts else np.zeros(x.size)

    columns = np.column_stack([np.ones(z.size), z, v])
    scale = np.linalg.norm(columns, axis=0)
    linear = columns / scale @ np.linalg.lstsq(columns / scale, samples.force_n - named(z, v), rcond=None)[0]
    free = ForceSamples(
        force_n=mass_kg * (samples.force_n - linear),
        displacement_m=z,
        velocity_m_per_s=v,
        blocks=samples.blocks,
        step_s=samples.step_s,
    )
    over = curve(free, v if rate else z, np.random.default_rng([seed, 11]))
    zero = np.zeros(over.argument.size)
    fitted = named(zero, over.argument) if rate else named(over.argument, zero)
    return Freed(samples=free, over=over, fitted=mass_kg * fitted if model.laws else None, rate=rate)


def _spectra(found: Analysis, before: FloatArray, after: FloatArray) -> dict[str, object]:
    """Of what was measured and of two simulated outputs of the held-out part, (n - skip,) each."""
    run = found.held_run
    rate = 1.0 / run.data.step_s
    n = min(2048, run.compared.size)

    def level(values: FloatArray) -> FloatArray:
        power = scipy.signal.welch(values, rate, nperseg=n)[1]
        return np.asarray(10.0 * np.log10(np.maximum(power, 10.0 ** (FLOOR_DB / 10.0))))

    frequency = np.fft.rfftfreq(n, 1.0 / rate)
    return {
        "channel": f"{run.data.answer_channel.name}, held-out part",
        "reference": f"1 ({run.data.answer_channel.unit})^2/Hz",
        "frequency_hz": frequency,
        "observed_db": level(run.compared),
        "before_db": level(before),
        "after_db": level(after),
    }


def _traces(shown: Shown, unit: str) -> list[dict[str, object]]:
    return [
        {
            "title": "Held-out stretch, free run",
            "unit": unit,
            "time_s": shown.time_s,
            "observed": shown.observed,
            "before": shown.before,
            "after": shown.after,
        },
        {
            "title": "Error of the free run",
            "unit": unit,
            "time_s": shown.time_s,
            "observed": np.full(shown.observed.size, np.nan),
            "before": shown.observed - shown.before,
            "after": shown.observed - shown.after,
        },
    ]


def redrawn(
    drawn: Mapping[str, object], found: Analysis, before: FloatArray, after: FloatArray
) -> Mapping[str, object]:
    """The pictures with what two other models leave of the held-out part, (n - skip,) each, in stretch and spectrum."""
    run = found.held_run
    first, count = _shown(run)
    stretch = slice(first, first + count)
    shown = Shown(
        drive=run.data.drive[run.skip :][stretch],
        time_s=_times(run, count),
        observed=run.compared[stretch],
        before=(run.compared - before)[stretch],
        after=(run.compared - after)[stretch],
    )
    spectra = _spectra(found, run.compared - before, run.compared - after)
    return {**drawn, "traces": _traces(shown, run.data.answer_channel.unit), "spectra": [spectra]}


def _ranking(found: Analysis) -> list[dict[str, object]]:
    if found.nominated is None:
        return []
    rows = []
    for trial in found.nominated.singles:
        score, error = score_nats(found.nominated.linear.squares, trial.squares)
        law = trial.laws[0]
        named = law.key in {x.key for x in found.final.model.laws}
        row = {"label": f"{law.words}, {law.shown()}", "score": score, "named": named}
        rows.append(row | {"low": score - 1.645 * error, "high": score + 1.645 * error})
    return rows


def motion_units(unit: str, order: int) -> tuple[str, str]:
    """Units of displacement and velocity where the output measures the `order`-th derivative in `unit`: `m/s^2`, 2 ->
    `m`, `m/s`; of a unit that is none over time the seconds are told."""
    rate = ("", "/s", "/s^2")[order]
    if unit.endswith(rate):
        plain = unit.removesuffix(rate)
        return plain, f"{plain}/s"
    return (f"{unit} s", unit) if order == 1 else (f"{unit} s^2", f"{unit} s")


def pictures(found: Analysis, shown: Shown, freed: Freed | None) -> dict[str, object]:
    """All pictures of the analysis; without a force (`freed` is None) those of it are left out."""
    run = found.held_run
    drawn: dict[str, object] = {
        "traces": _traces(shown, run.data.answer_channel.unit),
        "spectra": [_spectra(found, found.held_before[run.skip :], found.held_after[run.skip :])],
        "ranking": _ranking(found),
    }
    if freed is None:
        return drawn
    known = run.data.calibrated
    return drawn | force_pictures(freed, run.data.answer_channel.unit, run.data.order, calibrated=known)


def force_pictures(freed: Freed, unit: str, order: int, *, calibrated: bool = True) -> dict[str, dict[str, object]]:
    """The force over one argument, and over displacement and velocity; in newtons only where it was `calibrated`."""
    newtons = "N" if calibrated else UNKNOWN_FORCE
    displacement, velocity = motion_units(unit, order)
    labels = f"displacement, {displacement}", f"velocity, {velocity}"
    over = freed.over
    plane = surface(freed.samples)
    return {
        "law": {
            "x_label": labels[freed.rate],
            "y_label": f"force beyond linear, {newtons}",
            "x": over.argument,
            "force": over.force_n,
            "low": over.low_n,
            "high": over.high_n,
            "fitted": freed.fitted,
        },
        "force_map": {
            "x_label": labels[0],
            "y_label": labels[1],
            "value_label": newtons,
            "x": plane.displacement_m,
            "y": plane.velocity_m_per_s,
            "value": plane.force_n,
        },
    }
