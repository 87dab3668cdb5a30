"""Labelled peaks of a window: what its spectra show of the lines that the machine and its fault predict."""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from sideband_datasets.make.batch import Made
from sideband_datasets.plan.doubtful import STEADY
from sideband_datasets.recipe.model import Peaks
from sideband_datasets.row import Peak
from signals.labels.canonical import Candidate, merge_lines
from signals.labels.families import kinematic_lines
from signals.labels.kinematics import Kinematics
from signals.labels.machine import machine_kinematics
from signals.labels.match import label_peaks
from signals.labels.types import LabelledPeak
from signals.series import Series
from signals.spectra.amplitude import amplitude_spectrum
from signals.spectra.envelope import envelope_spectrum
from signals.spectra.types import Spectrum
from sim.core.lines import Line
from sim.core.speed import warped_times

REFERENCE = "f_r1"
LABELLED = ("acceleration", "velocity", "displacement")
LEAST_SAMPLES = 256
SPECTRA: Mapping[str, Callable[[Series], Spectrum]] = {"amplitude": amplitude_spectrum, "envelope": envelope_spectrum}


@dataclass(frozen=True, kw_only=True)
class Predicted:
    """What the lines of a recording are predicted from; `mechanisms` are those of its fault."""

    lines: Sequence[Line]
    merged: Sequence[Candidate]
    kinematics: Kinematics
    step_hz: float
    mechanisms: frozenset[str]


def predicted(made: Made, bases_hz: Mapping[str, float]) -> Predicted | None:
    """Lines of a machine; None where nothing turns."""
    if REFERENCE not in bases_hz:
        return None
    kinematics = machine_kinematics(made.drawing.spec, bases_hz)
    lines = [*kinematic_lines(kinematics, bases_hz, max_frequency_hz=math.inf), *made.system.lines]
    effects = frozenset(effect.term for effect in made.drawing.effects)
    return Predicted(
        lines=lines,
        merged=merge_lines(lines, bases_hz, kinematics),
        kinematics=kinematics,
        step_hz=1.0 / made.response.quality.step_s,
        mechanisms=effects,
    )


def steady(series: Series, made: Made) -> bool:
    """Whether lines stand still in a window."""
    if made.response.speed[0] == 0:
        return True
    t = series.start_s + np.arange(series.samples.size) / series.sampling_rate_hz
    _, ratio = warped_times(made.response.speed, t)
    return float(ratio.max() - ratio.min()) <= STEADY


def peaks_of(
    series: Series, made: Made, known: Predicted | None, bases_hz: Mapping[str, float], wanted: Peaks
) -> tuple[Peak, ...]:
    """Peaks of a window; none where there is nothing to label."""
    moves = series.samples.size >= LEAST_SAMPLES and float(series.samples.std()) > 0
    if known is None or series.quantity not in LABELLED or not moves or not steady(series, made):
        return ()
    found: list[Peak] = []
    for name in wanted.spectra:
        labels = label_peaks(
            SPECTRA[name](series),
            known.lines,
            bases_hz,
            kinematics=known.kinematics,
            reference=REFERENCE,
            max_unexplained=0,
            step_hz=known.step_hz,
            merged=known.merged,
        )
        found += [_peak(peak, name) for peak in _kept(labels.peaks, known, wanted.most)]
    return tuple(found)


def _kept(peaks: Sequence[LabelledPeak], known: Predicted, most: int) -> list[LabelledPeak]:
    """The strongest that were found, and the fault's own lines that were not; sorted by frequency."""
    seen = [p for p in peaks if p.status in ("present", "ambiguous")]
    seen = sorted(seen, key=lambda p: (-(p.amplitude or 0.0), p.frequency_hz, p.label))[:most]
    absent = [p for p in peaks if p.status == "absent" and known.mechanisms & set(p.mechanisms)][:most]
    return sorted([*seen, *absent], key=lambda p: (p.frequency_hz, p.label))


def _peak(peak: LabelledPeak, spectrum: str) -> Peak:
    measured = peak.measured_frequency_hz
    return Peak(
        label=peak.label,
        frequency_hz=peak.frequency_hz if measured is None else measured,
        amplitude=peak.amplitude,
        status=peak.status,
        component=peak.component,
        spectrum=spectrum,
    )
