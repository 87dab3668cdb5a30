"""Labelled peaks: what was found, what was predicted, and how the two met."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Literal

from signals.floor import FloorSettings
from signals.labels.families import Bound
from signals.spectra.types import Band, Scaling

Status = Literal["present", "absent", "ambiguous", "unexplained", "above_nyquist"]


@dataclass(frozen=True, kw_only=True)
class Matching:
    """How near a found peak must be to a predicted line.

    Tolerance = (`tie_bins` + doubt, at most `bins`) * resolution + `relative` * frequency, where doubt is three
    standard deviations of the measured frequency plus the pull of stronger lines' sidelobes: a strong peak is held
    to its exact place, a weak one is not. `relative` is the uncertainty of the speeds (0 for a simulation; 0.01-0.02
    for a bearing of a real machine, whose cage slips). Between several lines within the tolerance, those further
    off than the nearest by once more the tolerance are ruled out. `max_chance`: combinations (sums beyond the
    predicted families) explain a peak only when chance would bring one so near with no more than this probability.

    Evidence: `family_chance` bounds the probability that chance brings as many lines of a family that nothing is known
    to excite, `lone_chance` that it brings a single one; of the lines called present, by families or by combinations,
    no more than the share `false_share` is false, as counted by the lines missed.
    """

    bins: float = 0.5
    relative: float = 0.0
    tie_bins: float = 0.05
    max_chance: float = 0.05
    family_chance: float = 1e-3
    lone_chance: float = 1e-4
    false_share: float = 0.05


@dataclass(frozen=True, kw_only=True)
class LabelledPeak:
    """One label. `frequency_hz` is predicted (measured when unexplained); None means nothing was measured.

    present: found, no other sum within the bound fits, and there is `evidence` that the line can be there: `term`, one
    predicts it; `family`, enough lines of its family were found; `sum`, a combination that chance would hardly bring
    so near. ambiguous: found, but the sums in `alternatives` fit as well, or (`evidence` is `chance`) nothing but its
    place speaks for it. `chance_coincidence` is the probability that a peak anywhere near meets some other line of the
    prediction by chance; with evidence `chance` that chance alone brings what was found of the family, with `sum` one
    so near a combination. absent: predicted and not found; `detection_limit` is the amplitude that would have been
    seen, and `masked_by` the peak too close to look past. unexplained: found, not predicted (empty label).
    above_nyquist: predicted beyond the end of the spectrum.
    `mechanism` is the first of the `mechanisms` that predict the line, or, once counterfactual runs were made, the one
    shown to cause it (`mechanism_basis` says which); `component` is None while several `components` are possible.
    """

    label: str
    status: Status
    frequency_hz: float
    order: float
    """Frequency over that of the reference shaft."""
    unit: str
    scaling: Scaling
    """`peak` or `rms`: the kind of `amplitude`."""
    measured_frequency_hz: float | None = None
    amplitude: float | None = None
    db_over_floor: float | None = None
    detection_limit: float | None = None
    component: str | None = None
    components: tuple[str, ...] = ()
    family: str = ""
    mechanism: str = ""
    mechanism_basis: Literal["predicted", "counterfactual"] = "predicted"
    mechanisms: tuple[str, ...] = ()
    aliases: tuple[str, ...] = ()
    alternatives: tuple[str, ...] = ()
    masked_by: str | None = None
    chance_coincidence: float | None = None
    evidence: Literal["", "term", "family", "sum", "chance"] = ""


@dataclass(frozen=True, kw_only=True)
class FalseMatch:
    """Share of lines at random places that would have been called present, 0..1.

    `families`: as a predicted line with evidence; `combinations`: as a sum beyond them. `ambiguous`: that would have
    been given a name without evidence; the sums among them are kept at or below `bound` by construction.
    """

    families: float
    combinations: float
    ambiguous: float
    bound: float


@dataclass(frozen=True, kw_only=True)
class LabelSet:
    """All labels of one spectrum, sorted by frequency, with the settings that decided."""

    frequencies_hz: Mapping[str, float]
    reference: str
    peaks: tuple[LabelledPeak, ...]
    channel: str
    kind: str
    unit: str
    scaling: Scaling
    window: str
    resolution_hz: float
    bound: Bound
    matching: Matching
    floor: FloorSettings
    found: int
    """Peaks found in the spectrum."""
    unexplained: int
    """Peaks found that nothing predicted; `peaks` lists the strongest of them."""
    truncated: int
    """Unexplained peaks that `peaks` does not list."""
    false_match: FalseMatch
    band: Band | None = field(default=None)

    def with_status(self, status: Status) -> tuple[LabelledPeak, ...]:
        """The peaks of one status."""
        return tuple(p for p in self.peaks if p.status == status)

    def __getitem__(self, label: str) -> LabelledPeak:
        """The peak of a label or of one of its aliases; KeyError when neither is predicted."""
        for peak in self.peaks:
            if label and (peak.label == label or label in peak.aliases):
                return peak
        raise KeyError(label)
