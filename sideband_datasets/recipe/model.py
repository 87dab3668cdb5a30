"""A recipe as a caller writes it, frozen once it is read."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import Field, JsonValue, model_validator

from sideband_datasets.recipe.background import Background
from sideband_datasets.recipe.values import Number, Value, wrong
from sim.core.spec import MachineSpec, Name, SpecModel
from sim.terms import REGISTRY

MOST_RECORDINGS = 200_000
MOST_DURATION_S = 60.0
MOST_WINDOWS = 1000
HEALTHY = "healthy"
IN_ALL = "puts a defect into all recordings, healthy ones too"
DAMAGE_STANDS = "what sound machines have; defects stand in `faults`, those of all recordings in every class of it"
Key = Annotated[str, Field(min_length=1, max_length=200)]
ShortName = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_-]{0,39}$")]
SplitName = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,39}$")]
"""As the Hugging Face loader takes them."""
Text = Annotated[str, Field(max_length=2000)]


class Machines(SpecModel):
    """A family of machines: one drawing, and what differs between those built to it."""

    name: ShortName
    preset: Annotated[str, Field(min_length=1, max_length=80)] | None = None
    """Name of a ready machine. Give either this or `machine`."""
    machine: MachineSpec | None = None
    set: dict[Key, bool | Number | str | dict[str, JsonValue] | None] = Field(default_factory=dict, max_length=200)
    """Changes that all have, as `simulate --set` takes them."""
    vary: dict[Key, Value] = Field(default_factory=dict, max_length=200)
    """What differs from machine to machine, by the same names; drawn once a machine."""
    instances: Annotated[int, Field(ge=1, le=10_000)]
    """How many machines are built."""

    @model_validator(mode="after")
    def _one_machine(self) -> Self:
        if (self.preset is None) == (self.machine is None):
            given = "neither" if self.machine is None else "both"
            raise wrong("is the drawing, unless `machine` is", "one of `preset` and `machine`", given, field="preset")
        return self


class FaultTerm(SpecModel):
    """One effect of a fault: where it may act, and the ranges of its parameters."""

    term: Name
    sites: Annotated[list[Name], Field(max_length=64)] = Field(default_factory=list)
    """One of these is drawn for each recording; none: every part of the machine where the effect may act."""
    parameters: dict[Name, Value] = Field(default_factory=dict, max_length=64)
    """Ranges of its parameters. The severity is drawn from the range it declares when it is not given here."""


class FaultClass(SpecModel):
    """A class of the dataset; several terms make a compound fault."""

    name: ShortName
    terms: Annotated[list[FaultTerm], Field(min_length=1, max_length=16)]
    weight: Annotated[float, Field(gt=0, le=1e6)] = 1.0
    """Its share among the faulty recordings, relative to the other classes."""


class Measurement(SpecModel):
    """A measurement chain, as `simulate --sensors` takes it, and what of it varies.

    Paths name its values: `channels.de.noise.density_per_sqrt_hz`, `channels.*.path.modes.0.frequency_hz`.
    """

    name: ShortName
    machines: Annotated[list[ShortName], Field(max_length=64)] = Field(default_factory=list)
    """Families that may get it; none: all."""
    chain: dict[str, JsonValue]
    vary: dict[Key, Value] = Field(default_factory=dict, max_length=200)
    """Drawn once a machine: how its sensors are fixed, its transfer path, its cable."""
    each: dict[Key, Value] = Field(default_factory=dict, max_length=200)
    """Drawn for every recording: noise, hum, drift ..., not paths or mountings."""


class Windows(SpecModel):
    """How a recording is cut. The first window begins at a place drawn in the slack the recording leaves."""

    per_recording: Annotated[int, Field(ge=1, le=MOST_WINDOWS)] = 1
    length_s: Annotated[float, Field(gt=0, le=MOST_DURATION_S)] | None = None
    length_revolutions: Annotated[float, Field(gt=0, le=100_000)] | None = None
    """Of the driven shaft, at its mean speed."""
    overlap: Annotated[float, Field(ge=0, le=0.95)] = 0.0
    """Share of a window that the next one repeats."""

    @model_validator(mode="after")
    def _one_length(self) -> Self:
        if self.length_s is not None and self.length_revolutions is not None:
            message, allowed = "is the length, unless `length_revolutions` is", "one of the two, or neither"
            raise wrong(message, allowed, "both", field="length_s")
        return self

    def span(self, length: float) -> float:
        """From the start of the first to the end of the last window, in the unit of `length`."""
        return length * (1.0 + (self.per_recording - 1) * (1.0 - self.overlap))


class Peaks(SpecModel):
    """Which labelled peaks a row carries."""

    spectra: tuple[Literal["amplitude", "envelope"], ...] = ("amplitude", "envelope")
    """Labelling takes longer than simulating: an empty list leaves it out."""
    most: Annotated[int, Field(ge=1, le=2000)] = 32
    """Largest number of present or ambiguous peaks of a spectrum, the strongest; and of lines of the fault that are
    absent, the lowest."""


class Recipe(SpecModel):
    """A dataset: `count` recordings of planned machines, each cut to windows; a row is one window of one channel."""

    schema_version: Literal[1] = 1
    name: ShortName
    notes: Text = ""
    seed: Annotated[int, Field(ge=0, le=2**32 - 1)] = 0
    count: Annotated[int, Field(ge=1, le=MOST_RECORDINGS)]
    """Recordings. Rows: count * windows * channels."""
    machines: Annotated[list[Machines], Field(min_length=1, max_length=64)]
    faults: Annotated[list[FaultClass], Field(max_length=64)] = Field(default_factory=list)
    healthy_share: Annotated[float, Field(ge=0, le=1)] | None = None
    """Share of recordings without a fault; none: one class among the others, of weight 1."""
    speeds_hz: Value | None = None
    """Of the driven shaft, drawn for every recording; none: the machine's own."""
    torques_nm: Value | None = None
    """Of the driven shaft, drawn for every recording."""
    conditions: dict[Key, Value] = Field(default_factory=dict, max_length=50)
    """Anything else of the machine that is drawn for every recording."""
    measurement: Annotated[list[Measurement], Field(max_length=32)] = Field(default_factory=list)
    """Each machine gets one of these; none: the machine's standard outputs, as they are."""
    background: Background | None = None
    """What sounds beside the model of a machine; none: nothing does."""
    siblings: bool = False
    """Each machine is recorded once in every class, and these recordings differ by the fault alone: what is random in
    background and measurement is the same in them. Then `count` is machines times classes."""
    shown_db: Annotated[float, Field(ge=-100, le=100)] | None = None
    """A faulty recording is left out, and listed, unless its fault adds as much power to what the same machine without
    it gives, dB, in one of sixteen bands of a channel."""
    sampling_rate_hz: Annotated[float, Field(ge=100, le=500_000)]
    """Of the simulation; a chain's clock may set another one for the recording."""
    duration_s: Annotated[float, Field(gt=0, le=MOST_DURATION_S)]
    """Length of a recording, s."""
    settle_s: Annotated[float, Field(ge=0, le=10)] = 0.2
    """Simulated before a recording begins and thrown away: the start from rest."""
    windows: Windows = Windows()
    peaks: Peaks = Peaks()
    plan: Literal["sobol", "latin_hypercube", "factorial"] = "sobol"
    """How ranges are filled; `factorial` combines levels for recordings (machines then are a Latin hypercube)."""
    splits: dict[SplitName, Annotated[float, Field(gt=0, le=1)]] = Field(
        default_factory=lambda: {"train": 0.7, "validation": 0.15, "test": 0.15}, min_length=1, max_length=10
    )
    """Shares of the recordings; every machine belongs to one split."""
    licence: Annotated[str, Field(min_length=1, max_length=80)] = "CC-BY-4.0"
    """Under which the data are given on (an SPDX identifier)."""
    author: Annotated[str, Field(max_length=200)] = ""
    """For the citation."""

    @model_validator(mode="after")
    def _consistent(self) -> Self:
        for what, names in (
            ("machines", [m.name for m in self.machines]),
            ("faults", [HEALTHY, *(f.name for f in self.faults)]),
            ("measurement", [m.name for m in self.measurement]),
        ):
            twice = sorted({name for name in names if names.count(name) > 1})
            if twice:
                allowed = (
                    f"no name twice; `{HEALTHY}` is the class without a fault" if what == "faults" else "no name twice"
                )
                raise wrong("need different names", allowed, ", ".join(twice), field=what)
        families = [m.name for m in self.machines]
        unknown = sorted({name for chain in self.measurement for name in chain.machines} - set(families))
        if unknown:
            message, allowed = "names machines that there are none of", ", ".join(families)
            raise wrong(message, allowed, ", ".join(unknown), field="measurement")
        bare = [name for number, name in enumerate(families) if self.measurement and not self.chains_of(number)]
        if bare:
            message = "has nothing for some machines"
            raise wrong(message, "one without `machines`, or one that names them", ", ".join(bare), field="measurement")
        if "all" in self.splits:
            raise wrong("is what loaders call all splits together", "another name", "all", field="splits")
        shares = sum(self.splits.values())
        if abs(shares - 1.0) > 1e-6:
            raise wrong(f"add up to {shares:g}", "shares that add up to 1", f"a sum of {shares:g}", field="splits")
        if not self.faults and self.healthy_share not in (None, 1.0):
            message, allowed = "says that some recordings have a fault, and there are no `faults`", "1, or `faults`"
            raise wrong(message, allowed, f"{self.healthy_share:g}", field="healthy_share")
        if self.faults and self.healthy_share == 1.0:
            raise wrong("leaves nothing to the faults", "below 1, or no `faults`", "1", field="healthy_share")
        return self

    @model_validator(mode="after")
    def _said_once(self) -> Self:
        for key, field in (("speed_hz", "speeds_hz"), ("torque_nm", "torques_nm")):
            if key in self.conditions and getattr(self, field) is not None:
                raise wrong(
                    f"is drawn by `{field}` already", "other names, or no such field", key, field=f"conditions.{key}"
                )
        return self

    @model_validator(mode="after")
    def _healthy_stays_healthy(self) -> Self:
        """No damage in what all recordings have."""
        everywhere: dict[str, str] = {}
        for number, family in enumerate(self.machines):
            for part, keys in (("set", family.set), ("vary", family.vary)):
                everywhere |= {
                    key: f"machines.{number}.{part}.{key}" for key, value in keys.items() if value is not None
                }
        for key, field in (*everywhere.items(), *((key, f"conditions.{key}") for key in self.conditions)):
            term = REGISTRY.get(key.split("@", maxsplit=1)[0]) if "@" in key else None
            if term is not None and term.damages:
                raise wrong(IN_ALL, DAMAGE_STANDS, key, field=field)
        return self

    def chains_of(self, family: int) -> list[int]:
        """Numbers of the chains that machines of family `family` may get."""
        name = self.machines[family].name
        return [k for k, chain in enumerate(self.measurement) if not chain.machines or name in chain.machines]

    @property
    def beside_sound(self) -> bool:
        """Whether a recording is made beside the one of the same machine without the fault."""
        return self.background is not None or self.shown_db is not None

    @property
    def classes(self) -> tuple[str, ...]:
        """Names of the classes, `healthy` first; it is named even if its share is zero."""
        return (HEALTHY, *(fault.name for fault in self.faults))
