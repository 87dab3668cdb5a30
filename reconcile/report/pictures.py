"""Shapes of `Report.pictures`: what the page can draw, in one place. All keys are optional; unknown ones are kept.

Every list of one picture has the same length; values that are no numbers leave a gap. Levels are in dB re the unit
the engine used throughout (it cancels in differences).
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import NotRequired, TypedDict, cast

from reconcile.report.strict import Plain, plain


class Point(TypedDict, total=False):
    """Operating point of a picture: speed of the drive shaft, factor on all torques."""

    speed_hz: float
    torque_ratio: float


class Spectrum(Point):
    """`spectra`: one panel a channel and operating point. `before_db`/`after_db`: the baseline (or the model, where
    there is none) without and with what was found; `reference` of the levels, where it is known."""

    channel: str
    reference: str
    frequency_hz: Sequence[float | None]
    observed_db: Sequence[float | None]
    before_db: Sequence[float | None]
    after_db: Sequence[float | None]


class Heat(Point, total=False):
    """`heat`: `value[row][angle]` over a shaft's turn; a row is an order of the shaft or has a name (`rows`: sensors).

    `value_label` says what the colours are, else a change in dB.
    """

    shaft: str
    angle_deg: Sequence[float]
    order: Sequence[float]
    rows: Sequence[str]
    value: Sequence[Sequence[float | None]]
    value_label: str


class Change(TypedDict):
    """`changes`: a feature, its change against what was expected, the null's 90 % band, and what the answer gives."""

    feature: str
    observed_db: float
    low: float
    high: float
    fitted_db: float | None


class Ranked(TypedDict):
    """`ranking`: predictive score of a candidate over nothing missing, with its 90 % interval.

    `form_of`: label of the stronger form of the same effect that it counts with; empty where it stands for itself.
    """

    label: str
    score: float
    low: float
    high: float
    named: bool
    form_of: str


class Path(TypedDict):
    """`paths`: gain from the machine's motion to a channel, in dB, read off sound recordings, and the power of noise in
    each third octave at the first operating point."""

    channel: str
    frequency_hz: Sequence[float]
    gain_db: Sequence[float]
    noise_db: Sequence[float]


class EnvelopeCurve(TypedDict):
    """`depth`: amplitude over the mean of the squared envelope, from order 0 on, a value every `order_step`."""

    label: str
    order_step: float
    depth: Sequence[float]


class EnvelopeLine(TypedDict):
    """`kind`: `own` of the family shown, its `sideband`, or an `other` part's."""

    label: str
    order: float
    kind: str


class Envelope(TypedDict, total=False):
    """`envelope`: the band in which a family of bearing lines stands out most, over orders of `shaft`."""

    family: str
    order: float
    band_hz: Sequence[float]
    channel: str
    shaft: str
    speed_hz: float
    lines: Sequence[EnvelopeLine]
    test: EnvelopeCurve
    baseline: EnvelopeCurve


class MeanTurn(TypedDict, total=False):
    """`mean_turn`: power of what comes back with every turn of a gear, without the lines of its teeth, in windows of
    `window_deg` over the middle of them, at each of `angle_deg` of its `shaft`; `start`: what angles count from, for
    the baseline's only where it has the `same_start`."""

    gear: str
    shaft: str
    speed_hz: float
    turns: int
    window_deg: float
    start: str
    same_start: bool
    angle_deg: Sequence[float]
    test_db: Sequence[float]
    baseline_db: Sequence[float]


class Trace(TypedDict):
    """`traces`: a stretch of held-out signal; `before` and `after` as predicted without and with the answer."""

    title: str
    unit: str
    time_s: Sequence[float]
    observed: Sequence[float | None]
    before: Sequence[float | None]
    after: Sequence[float | None]


class ForceMap(TypedDict):
    """`force_map`: mean estimated force in bins, `value[y][x]`, None where no data fell."""

    x_label: str
    y_label: str
    value_label: str
    x: Sequence[float]
    y: Sequence[float]
    value: Sequence[Sequence[float | None]]


class Law(TypedDict):
    """`law`: force over one argument with its 90 % band, and through it (`fitted`, or None) the named law, or, not
    `named`, the nearest."""

    x_label: str
    y_label: str
    x: Sequence[float]
    force: Sequence[float | None]
    low: Sequence[float | None]
    high: Sequence[float | None]
    fitted: Sequence[float | None] | None
    named: NotRequired[bool]


class Pictures(TypedDict, total=False):
    """`Report.pictures`."""

    spectra: list[Spectrum]
    envelope: list[Envelope] | Envelope
    mean_turn: list[MeanTurn] | MeanTurn
    heat: list[Heat] | Heat
    changes: list[Change]
    ranking: list[Ranked]
    paths: list[Path]
    traces: list[Trace]
    force_map: list[ForceMap] | ForceMap
    law: list[Law] | Law


def several(pictures: Mapping[str, object], key: str) -> list[dict[str, Plain]]:
    """The pictures under a key as a list of plain mappings; a single one counts as a list of one."""
    found = plain(pictures.get(key))
    items = found if isinstance(found, list) else [found]
    return [item for item in items if isinstance(item, dict)]


def numbers(value: Plain) -> list[float]:
    """A list of numbers, NaN where there is none."""
    if not isinstance(value, list):
        return []
    return [float(cast("float", x)) if isinstance(x, int | float) else float("nan") for x in value]


def number(value: Plain, default: float = float("nan")) -> float:
    """A number, or the default."""
    return float(value) if isinstance(value, int | float) else default


def rows(value: Plain) -> list[list[float]]:
    """A table of numbers."""
    return [numbers(row) for row in value] if isinstance(value, list) else []


def text(value: Plain, default: str = "") -> str:
    """A text."""
    return value if isinstance(value, str) else default
