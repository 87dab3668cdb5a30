"""Speed, loads and the extra physical effects of a machine."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import BeforeValidator, Field, model_validator

from sim.core.spec.base import Finite, Name, SpecModel


class RampSpeed(SpecModel):
    """The speed goes straight from one ratio of the nominal speed to another, then stays."""

    kind: Literal["ramp"] = "ramp"
    start_ratio: Annotated[float, Field(ge=0, le=10)] = 1.0
    end_ratio: Annotated[float, Field(ge=0, le=10)]
    duration_s: Annotated[float, Field(ge=1e-3, le=3600)]


MOST_CYCLES = 10.0
"""Cycles of the sine within a correlation time of the noise: bounds the table to 82 000 knots."""


class FluctuatingSpeed(SpecModel):
    """A sine around the nominal speed, and noise with a correlation time (it repeats after 128 of them)."""

    kind: Literal["fluctuating"] = "fluctuating"
    amplitude: Annotated[float, Field(ge=0, le=0.5)] = 0.0
    frequency_hz: Annotated[float, Field(ge=0.01, le=1000)] = 1.0
    random_rms: Annotated[float, Field(ge=0, le=0.2)] = 0.0
    correlation_s: Annotated[float, Field(ge=1e-2, le=100)] = 1.0

    @model_validator(mode="after")
    def _bounded(self) -> FluctuatingSpeed:
        """The noise repeats after 128 correlation times, and its table holds 64 steps of every cycle of the sine."""
        cycles = self.correlation_s * self.frequency_hz
        if self.random_rms > 0.0 and self.amplitude > 0.0 and cycles > MOST_CYCLES:
            message = f"frequency times correlation time is {cycles:g} cycles; beside noise at most {MOST_CYCLES:g}"
            raise ValueError(message)
        return self


def _as_tuple(value: object) -> object:
    """Arrays of JSON arrive as lists."""
    return tuple(value) if isinstance(value, list) else value


class MeasuredSpeed(SpecModel):
    """Ratios of the nominal speed at equal steps, linear between, the last one kept."""

    kind: Literal["measured"] = "measured"
    step_s: Annotated[float, Field(ge=1e-4, le=60)]
    ratios: Annotated[
        tuple[Annotated[float, Field(ge=0, le=10)], ...],
        BeforeValidator(_as_tuple),
        Field(min_length=2, max_length=100_000),
    ]


SpeedProfile = Annotated[RampSpeed | FluctuatingSpeed | MeasuredSpeed, Field(discriminator="kind")]


class OperatingSpec(SpecModel):
    """Speed of one shaft; the others follow from the meshes."""

    shaft: Name
    speed_hz: Annotated[float, Field(ge=0.1, le=1000)]
    profile: SpeedProfile | None = None
    """How the speed changes with time; none: it is constant."""
    kinematics: Literal["prescribed", "dynamic"] = "prescribed"
    """Shaft angle phi(t): `prescribed` is the speed profile alone (the seed), `dynamic` adds the torsional motion."""
    rotation: Literal["printed", "geared"] = "geared"
    """`geared`: shafts turn against each other through their meshes; `printed`: all shafts in one sense (the seed)."""


class TorqueLoad(SpecModel):
    """A constant torque from t = 0 on. The balancing torque at the other end is derived unless given."""

    kind: Literal["torque"] = "torque"
    shaft: Name
    torque_nm: Annotated[float, Field(ge=-1e7, le=1e7)]


class ForceLoad(SpecModel):
    """A force on a body: constant plus one sine."""

    kind: Literal["force"] = "force"
    body: Name
    axis: Literal["x", "y"]
    constant_n: Annotated[float, Field(ge=-1e9, le=1e9)] = 0.0
    amplitude_n: Annotated[float, Field(ge=0, le=1e9)] = 0.0
    frequency_hz: Annotated[float, Field(ge=0, le=1e5)] = 0.0
    phase_rad: Finite = 0.0


MOST_SAMPLES = 1 << 18


class MeasuredLoad(SpecModel):
    """A measured input on a body, the first value at t = 0; before the first and after the last sample they are held.

    A displacement moves the far end of the body's own spring and damper to ground: a stiff spring prescribes motion.
    """

    kind: Literal["measured"] = "measured"
    body: Name
    axis: Literal["x", "y"]
    quantity: Literal["force", "displacement"] = "force"
    step_s: Annotated[float, Field(ge=1e-6, le=10)]
    values: Annotated[
        tuple[Finite, ...],
        BeforeValidator(_as_tuple),
        Field(min_length=2, max_length=MOST_SAMPLES),
    ]
    """Samples at equal steps, in N or m once multiplied by `factor`."""
    factor: Finite = 1.0
    """N (m) per unit of the samples: an uncalibrated recording keeps its own unit."""
    interpolation: Literal["hold", "linear", "band_limited"] = "band_limited"
    """Between samples; `band_limited` suits inputs sampled without aliasing, with content up to 0.35 of their rate."""


LoadSpec = Annotated[TorqueLoad | ForceLoad | MeasuredLoad, Field(discriminator="kind")]


class TermSpec(SpecModel):
    """A registered effect at a site with its parameters (units as the registry declares)."""

    term: Name
    site: Name
    parameters: dict[Name, float] = Field(default_factory=dict, max_length=64)
