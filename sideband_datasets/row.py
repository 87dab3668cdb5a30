"""A row: one window of one channel, with everything that is known of it. One list declares the columns."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

SignalArray = NDArray[np.float32]
Kind = Literal["text", "whole", "number", "truth", "texts", "numbers", "peaks", "signal"]


@dataclass(frozen=True, kw_only=True)
class Peak:
    """A labelled peak: predicted sum of orders, frequency in Hz (measured where found), amplitude (peak value)."""

    label: str
    frequency_hz: float
    amplitude: float | None
    """In the unit of the row; None where nothing was found."""
    status: str
    component: str | None
    spectrum: str
    """`amplitude` or `envelope`."""


@dataclass(frozen=True, kw_only=True)
class Row:
    """One window of one channel. Fields in the order of `COLUMNS`, which says what each means."""

    signal_id: str
    recording_id: str
    row: int
    recording: int
    window: int
    start_s: float
    channel: str
    sensor_location: str
    axis: str
    quantity: str
    unit: str
    sampling_rate_hz: float
    samples: int
    speed_hz: float | None
    load_nm: float | None
    fault_type: str
    fault_location: str | None
    fault_origin: str
    fault_severity: float | None
    fault_severity_name: str | None
    fault_severity_unit: str | None
    labels: tuple[str, ...]
    severities: tuple[float, ...]
    bearing_id: str | None
    bpfo_hz: float | None
    bpfi_hz: float | None
    bsf_hz: float | None
    ftf_hz: float | None
    mesh_hz: float | None
    split: str
    machine_id: str
    machine: str
    path_id: str
    measurement: str
    seed: int
    warnings: tuple[str, ...]
    rms: float
    peak: float
    peak_to_peak: float
    kurtosis: float | None
    skewness: float | None
    crest_factor: float | None
    peaks: tuple[Peak, ...]
    signal: SignalArray
    """Shape (samples,), in `unit`."""


@dataclass(frozen=True, kw_only=True)
class Column:
    """Name, kind, unit (of numbers that have one) and meaning of a column."""

    name: str
    kind: Kind
    sentence: str
    unit: str = ""


def _c(name: str, kind: Kind, sentence: str, unit: str = "") -> Column:
    return Column(name=name, kind=kind, sentence=sentence, unit=unit)


COLUMNS: tuple[Column, ...] = (
    _c("signal_id", "text", "Name of the row, unique in the dataset."),
    _c("recording_id", "text", "Name of the recording it was cut from."),
    _c("row", "whole", "Number of the row in the plan."),
    _c("recording", "whole", "Number of the recording in the plan."),
    _c("window", "whole", "Number of the window in the recording."),
    _c("start_s", "number", "Start of the window since the machine started from rest.", "s"),
    _c("channel", "text", "Name of the channel."),
    _c("sensor_location", "text", "Part of the machine the sensor sits on."),
    _c("axis", "text", "Sensitive axis, x or y; empty where it is oblique."),
    _c("quantity", "text", "What is measured."),
    _c("unit", "text", "Unit of the signal."),
    _c("sampling_rate_hz", "number", "Sampling rate of the signal.", "Hz"),
    _c("samples", "whole", "Length of the signal."),
    _c("speed_hz", "number", "Mean speed of the driven shaft in the window, revolutions a second.", "Hz"),
    _c("load_nm", "number", "Torque of the driven shaft, where there is one.", "N m"),
    _c("fault_type", "text", "Class of the recording."),
    _c("fault_location", "text", "Part that the (first) effect of the fault acts on."),
    _c("fault_origin", "text", "Where the fault comes from: simulated."),
    _c("fault_severity", "number", "Size of the (first) effect, in fault_severity_unit."),
    _c("fault_severity_name", "text", "Parameter that fault_severity is the value of."),
    _c("fault_severity_unit", "text", "Unit of fault_severity; 1 is a pure number."),
    _c("labels", "texts", "Every effect of the fault with its place, effect@part (multi-label)."),
    _c("severities", "numbers", "Size of each effect in labels, in the unit of its parameter; NaN without one."),
    _c(
        "bearing_id",
        "text",
        "Bearing that the four frequencies are of: the faulty one, else the sensor's, else the first.",
    ),
    _c("bpfo_hz", "number", "Ball pass frequency, outer race.", "Hz"),
    _c("bpfi_hz", "number", "Ball pass frequency, inner race.", "Hz"),
    _c("bsf_hz", "number", "Ball spin frequency; a ball's defect shows at twice this.", "Hz"),
    _c("ftf_hz", "number", "Cage frequency.", "Hz"),
    _c("mesh_hz", "number", "Tooth mesh frequency of the first mesh, or of the one whose gear is faulty.", "Hz"),
    _c("split", "text", "Split that the machine belongs to."),
    _c("machine_id", "text", "The machine; no machine occurs in two splits."),
    _c("machine", "text", "Family of the machine."),
    _c("path_id", "text", "Hash of the transfer path to the sensors; no path occurs in two splits."),
    _c("measurement", "text", "Name of the measurement chain; empty: outputs of the simulation as they are."),
    _c("seed", "whole", "Seed of what is random in the measurement."),
    _c("warnings", "texts", "What the simulation said about its own numbers."),
    _c("rms", "number", "Root mean square of the signal, mean included."),
    _c("peak", "number", "Largest deviation from the mean."),
    _c("peak_to_peak", "number", "Largest minus smallest value."),
    _c("kurtosis", "number", "Pearson's kurtosis, 3 for a Gaussian."),
    _c("skewness", "number", "Skewness."),
    _c("crest_factor", "number", "Peak over standard deviation."),
    _c(
        "peaks",
        "peaks",
        "Labelled peaks of the spectra that the recipe names, amplitude or envelope; each peak says of which.",
    ),
    _c("signal", "signal", "The samples."),
)
