"""What a reconciliation says: typed results, ready for `report.json`. SI units throughout."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import asdict, dataclass, field
from typing import Literal

Word = Literal["nothing_missing", "explained", "ambiguous", "unknown_physics", "measurement_fault", "not_decidable"]
Level = Literal["machine", "kinematics", "driven"]
"""What the engine could stand on: a simulated machine, frequencies of a drawing only, or a measured input."""


def operating_point(speed_hz: float | None, torque_ratio: float = 1.0) -> str:
    """`30 Hz`, or `30 Hz at 0.5 of the torque`; nothing where the speed is not known."""
    if speed_hz is None:
        return ""
    return f"{speed_hz:.5g} Hz" if torque_ratio == 1.0 else f"{speed_hz:.5g} Hz at {torque_ratio:g} of the torque"


@dataclass(frozen=True, kw_only=True)
class PlaceWeight:
    """A site of the machine spec and the share of the evidence that points there, 0..1."""

    site: str
    weight: float


@dataclass(frozen=True, kw_only=True)
class LineChange:
    """A line whose level differs from what was expected; `change_db` = observed - expected."""

    label: str
    frequency_hz: float
    change_db: float
    channel: str = ""
    locked_to: str = ""
    """`input`, `bearing1.cage`, `mesh1`, `mains` or empty for nothing known."""
    speed_hz: float | None = None
    """Operating point: the drive shaft's speed, None where it is not known, and the factor on all torques."""
    torque_ratio: float = 1.0


@dataclass(frozen=True, kw_only=True)
class AngleWindow:
    """Where in a revolution the residual sits, degrees of `shaft` from the tacho's pulse on, else the first sample."""

    shaft: str
    centre_deg: float
    low_deg: float
    high_deg: float


@dataclass(frozen=True, kw_only=True)
class Where:
    """Location in the machine, in frequency and in angle; `limits` says what could not be told apart and why."""

    sites: tuple[PlaceWeight, ...] = ()
    lines: tuple[LineChange, ...] = ()
    angle_window: AngleWindow | None = None
    limits: tuple[str, ...] = ()

    @property
    def likeliest(self) -> tuple[str, ...]:
        """The site of the largest weight, or all that share it; empty where no place is told."""
        most = max((s.weight for s in self.sites), default=0.0)
        return tuple(s.site for s in self.sites if s.weight >= most * (1.0 - 1e-9))


@dataclass(frozen=True, kw_only=True)
class Severity:
    """Size of an effect with a 90 % interval [low, high], in the unit of the term's severity parameter."""

    name: str
    value: float
    unit: str
    low: float
    high: float


@dataclass(frozen=True, kw_only=True)
class Cause:
    """A candidate: a registered term at a site. `score`, in `score_unit`, ranks the causes of one report: its
    predictive log score over nothing missing (nats), or, at level `kinematics`, how many robust deviations its lines
    stand above what foreign orders show, weighted by place. Scores of different units do not compare.

    `named` is true only when all rules for giving a name hold; `reasons` says which did not.
    """

    term: str
    site: str
    score: float
    severity: Severity | None = None
    named: bool = False
    reasons: tuple[str, ...] = ()
    values: Mapping[str, float] = field(default_factory=dict)
    forms: Mapping[str, float] = field(default_factory=dict)
    """Scores of other forms of the effect at this site: terms that exclude this one there; judged together with it."""
    score_unit: str = "nats"


NOT_JUDGED = (
    "No channel is usable, so nothing is said of the machine: cut the recordings where they are sound, or record anew.",
)


@dataclass(frozen=True, kw_only=True)
class Faintest:
    """From which size on an effect would have been seen at a place: `seen` of the `simulated` sizes were, all of those
    from `seen_from` on (None: the `largest` was not either). `name` and `unit` are those of its size."""

    term: str
    site: str
    name: str
    unit: str
    seen: int
    simulated: int
    seen_from: float | None
    largest: float
    strikes: bool = False
    """Whether it makes impacts, which are looked for apart and may tell smaller ones."""


@dataclass(frozen=True, kw_only=True)
class SensorFault:
    """The mismatch is in the measurement. `channel`: empty where it is all of them or not known which."""

    kind: str
    channel: str
    detail: str = ""
    recordings: tuple[str, ...] = ()
    """In which it was seen: `test 1`, `baseline 2`."""
    left_out: bool = False
    """Whether the channel was left out of the analysis."""
    doubtful: bool = False
    """Whether the machine itself may look like that on one channel: a damaged part beside a sensor as a loose one."""


@dataclass(frozen=True, kw_only=True)
class Placebo:
    """The right law at a wrong place, or a wrong law at the right place, forecast from so many simulated `draws`."""

    term: str
    site: str
    gain: float
    draws: int


@dataclass(frozen=True, kw_only=True)
class HeldOut:
    """Fit on data the fit never saw. `gain` = 1 - after/before with a 90 % interval; rivals as gains too."""

    metric: str
    unit: str
    before: float
    after: float
    gain: float
    gain_low: float
    gain_high: float
    retuned: float | None
    black_box: float | None
    placebo: float | None
    held: str = ""
    """What was held out: an unseen speed, load, a later time."""
    ceiling: float | None = None
    """Gain expected of a perfect model: drift between the recordings and noise stay, known from healthy machines; no
    bound, as less may have drifted on the machine at hand."""
    numbers: int | None = None
    """Free numbers of the black box: as many as the effect's forecast uses."""
    effects: tuple[str, ...] = ()
    """Whose forecast it is, `effect@site`; two where both were fitted together."""
    placebos: tuple[Placebo, ...] = ()
    """All wrong places and laws that were forecast; `placebo` is the median of those with draws enough."""


NO_GAIN = "; on data it was not fitted to it brings the spectra no nearer"
"""Said of one effect in the sentence of the verdict, where the gain is none."""


@dataclass(frozen=True, kw_only=True)
class PointForce:
    """At one operating point: the force of the `lines` that tell one together, N rms, with a 90 % interval [low_n,
    high_n]; its upper end counts what may be at all other lines too. Where none tells one, `lines`, `force_n` and
    `low_n` are 0 and the upper end stands alone."""

    speed_hz: float
    torque_ratio: float
    lines: int
    force_n: float
    low_n: float
    high_n: float


@dataclass(frozen=True, kw_only=True)
class EstimatedForce:
    """Force nobody's law covers: samples with their 90 % band, and the simplest law that survived."""

    site: str
    samples: Mapping[str, tuple[float, ...]]
    """Over what it follows: `displacement_m`, `velocity_m_per_s` or `angle_rad`, with `force_n`, `low_n`, `high_n`.

    At level `machine`, where no law stands, by lines, at most 60 of all operating points (`speed_hz` of the drive
    shaft, `torque_ratio`): `frequency_hz` at that speed, `order` of that shaft, `force_n` rms along the `axes`
    together, `low_n` and `high_n`: what at the support would change the line as much. `force_n` and `low_n` are 0 where
    no force would do as well, or where the line may be a product of others.
    """
    law: str | None
    coefficients: Mapping[str, float] = field(default_factory=dict)
    work_per_cycle_j: float | None = None
    """None where it cannot be told: `remarks` say why."""
    axes: tuple[str, ...] = ()
    """Along which a force by lines is told."""
    points: tuple[PointForce, ...] = ()
    """Sums of what `samples` tell by lines, one an operating point."""
    remarks: tuple[str, ...] = ()
    """How the samples are meant, and what cannot be told."""


@dataclass(frozen=True, kw_only=True)
class NextExperiment:
    """What would decide between the first two effects of the answer.

    Separations are log evidence (natural logarithm) of the first over the second: x makes it e^x times as likely.
    """

    sentence: str
    separation_now: float | None = None
    """By the recordings at hand; negative where they speak for the second."""
    separation_expected: float | None = None
    """With the experiment, on average if the first effect is there; None where nothing at hand predicts it."""


@dataclass(frozen=True, kw_only=True)
class Report:
    """The whole answer. `machine` is the revised specification, or None where there is none to revise."""

    verdict: Word
    sentence: str
    level: Level
    where: Where = field(default_factory=Where)
    causes: tuple[Cause, ...] = ()
    fault: SensorFault | None = None
    """What is wrong with the measurement: the answer where the verdict says so, else the worst beside it."""
    measurement_faults: tuple[SensorFault, ...] = ()
    """All that is wrong with the measurement, `fault` first."""
    held_out: HeldOut | None = None
    force: EstimatedForce | None = None
    undecidable: tuple[str, ...] = ()
    faintest: tuple[Faintest, ...] = ()
    """Where nothing is missing: what such recordings would have shown."""
    next_experiment: NextExperiment | None = None
    machine: Mapping[str, object] | None = None
    stages: tuple[Mapping[str, object], ...] = ()
    """One entry a stage: name, what it found, figures; shown in the page."""
    pictures: Mapping[str, object] = field(default_factory=dict)
    """Data the page draws: spectra before and after, heat maps, feature changes."""
    provenance: Mapping[str, object] = field(default_factory=dict)

    def document(self) -> dict[str, object]:
        """JSON with the keys of the interface."""
        return asdict(self)
