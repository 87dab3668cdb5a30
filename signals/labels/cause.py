"""Causes of lines, shown by taking an effect away: the same machine simulated with one term at zero."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from signals.labels.types import LabelledPeak, LabelSet


@dataclass(frozen=True, kw_only=True)
class Cause:
    """What a label's line loses when `term` at `site` is at zero.

    `share_removed` is 1 - amplitude without / amplitude with: 1 the line is gone, 0 nothing changes, negative it grows.
    When the line is not found without the term its detection limit stands for it, so `share_removed` is then a
    lower bound (`at_least`). `zero` says which machine stands for "without".
    """

    label: str
    term: str
    site: str
    zero: str
    amplitude_with: float
    amplitude_without: float
    share_removed: float
    drop_db: float
    at_least: bool


def find_causes(
    labels: LabelSet, without: LabelSet, *, term: str, site: str, zero: str = "the term at zero"
) -> tuple[Cause, ...]:
    """Causes for every line found in `labels`; `without` labels the counterfactual, same channel and settings."""
    same = (labels.channel, labels.unit, labels.scaling, labels.kind) == (
        without.channel,
        without.unit,
        without.scaling,
        without.kind,
    )
    if not same:
        raise ValueError("the two label sets must come from the same channel, unit, scaling and kind of spectrum")
    known = {p.label: p for p in without.peaks if p.label}
    found = (p for p in labels.peaks if p.label and p.amplitude is not None)
    return tuple(_cause(p, known[p.label], term, site, zero) for p in found if p.label in known)


def _cause(peak: LabelledPeak, other: LabelledPeak, term: str, site: str, zero: str) -> Cause:
    amplitude = peak.amplitude or 0.0
    rest = other.amplitude if other.amplitude is not None else (other.detection_limit or 0.0)
    ratio = rest / amplitude
    return Cause(
        label=peak.label,
        term=term,
        site=site,
        zero=zero,
        amplitude_with=amplitude,
        amplitude_without=rest,
        share_removed=1 - ratio,
        drop_db=float(-20 * np.log10(max(ratio, 1e-15))),
        at_least=other.amplitude is None,
    )
