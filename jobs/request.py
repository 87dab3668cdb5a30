"""What a caller may ask for. Everything is typed, bounded and closed: an unknown key is an error."""

from __future__ import annotations

from typing import Annotated, Literal, Self

from pydantic import BeforeValidator, ConfigDict, Field, JsonValue, model_validator

from signals.sensors.spec import SensorChain
from sim.core.spec import MachineSpec, SpecModel

ChannelName = Annotated[str, Field(min_length=1, max_length=120, pattern=r"^[A-Za-z0-9_.-]+$")]
OverrideKey = Annotated[str, Field(min_length=1, max_length=200)]
OverrideValue = bool | float | str | dict[str, JsonValue] | None


MAX_CHANNELS = 512
MOST_SEED = 2**53 - 1
"""The largest whole number below which JSON's numbers, doubles, hold every one."""
DEFAULT_RATE_HZ = 30_000.0
"""One default for every way in. Labels reach 11.7 kHz at it: 17 mesh harmonics of the paper's machine."""


class MachineChoice(SpecModel):
    """A machine: a preset or a whole specification, and what to change in it."""

    model_config = ConfigDict(
        json_schema_extra={"examples": [{"preset": "paper-demo", "set": {"fit_clearance@bearing1.gap": 2e-5}}]}
    )

    preset: Annotated[str, Field(min_length=1, max_length=80)] | None = None
    """Name of a preset machine (see `/v1/presets`). Give either this or `machine`."""
    machine: MachineSpec | None = None
    """A whole machine specification. Give either this or `preset`."""
    set: Annotated[dict[OverrideKey, OverrideValue], Field(max_length=200, default_factory=dict)]
    """Changes, SI units: `term@site.parameter` for an effect; a dotted path such as
    `bearings.bearing1.radial_clearance_m`; or a short name: `speed_hz`, `torque_nm` (of the driven shaft), `gravity`,
    `profile` (`{"kind": "ramp", "end_ratio": 2, "duration_s": 1}`, or `profile.kind`, `profile.end_ratio` ... each).
    A part that is an object takes an object, null takes it away."""

    @model_validator(mode="after")
    def _one_machine(self) -> Self:
        if (self.preset is None) == (self.machine is None):
            raise ValueError("give exactly one of `preset` and `machine`")
        return self


ALL = ["all"]
Channels = Annotated[list[ChannelName], Field(min_length=1, max_length=MAX_CHANNELS)]
OneWord = BeforeValidator(
    lambda given: ALL if given == "all" else given, json_schema_input_type=Channels | Literal["all"] | None
)
"""`all` alone stands for every output."""


class SimulationRequest(MachineChoice):
    """A simulation: a machine, how long, how finely, which outputs."""

    model_config = ConfigDict(
        json_schema_extra={
            "examples": [
                {
                    "preset": "paper-demo",
                    "set": {"fit_clearance@bearing1.gap": 2e-5, "speed_hz": 25.0},
                    "duration_s": 1.0,
                    "sampling_rate_hz": 20000,
                }
            ]
        }
    )

    duration_s: Annotated[float, Field(gt=0)] = 1.0
    """Simulated time, s. A tighter bound may be set by the server."""
    sampling_rate_hz: Annotated[float, Field(ge=100, le=500_000)] = DEFAULT_RATE_HZ
    """Output rate, Hz; the signals are low-pass filtered before they are thinned to it."""
    channels: Annotated[Channels | None, OneWord] = None
    """Names of the outputs, or `all`; none: the engine's standard set."""
    seed: Annotated[int, Field(ge=0, le=MOST_SEED)] = 0
    """Seed of everything random in the machine. Bounded so that JSON numbers carry it exactly."""
    discard_transient: bool = True
    """Whether spectra, features and labels leave out the start-up transient. The signals always keep it."""
    sensors: SensorChain | None = None
    """The measurement chain: what is recorded is then what its sensors show (docs/sensors.md), at the rate of its
    clock; `sampling_rate_hz` is the rate at which the motion is handed to it, and `channels` must be left out."""
    causes: bool = False
    """Whether to show what causes each labelled line, by simulating the machine without each of its effects (and
    without each excitation of the base machine): some ten further runs, counted in the cost. Also lists the impacts in
    every contact."""

    @property
    def outputs(self) -> list[str] | None:
        """`channels` by name; None: the standard set. `all` has its names once the request was resolved."""
        return None if self.channels == ALL else self.channels
