"""The measurement chain as a caller writes it: channels, the clock they share, a seed."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, ClassVar, Literal, Self

from pydantic import Field, model_validator

from signals.sensors.antialias import AntiAlias
from signals.sensors.clock import Clock
from signals.sensors.converter import Converter
from signals.sensors.disturbance import Drift, Hum
from signals.sensors.dropouts import Dropouts
from signals.sensors.mounting import Mounting
from signals.sensors.noise import Noise
from signals.sensors.path import MAX_TAPS, MeasuredPath, Path
from signals.sensors.place import ChannelName, Place
from signals.sensors.presets import with_preset
from signals.sensors.proximity import Probe
from signals.sensors.tacho import Pulser
from signals.sensors.transducer import Transducer
from sim.core.spec import Name, SpecModel

MAX_CHANNELS = 32
MAX_TOTAL_TAPS = 2 * MAX_TAPS
Output = Literal["physical", "volts"]


class _Channel(SpecModel):
    """What every channel has. Stages left out, or given as null, do nothing."""

    QUANTITY: ClassVar[str]
    UNIT: ClassVar[str]

    name: ChannelName
    preset: Annotated[str, Field(min_length=1, max_length=40)] | None = None
    """A sensor by name (see docs/sensors.md); stages given beside it replace its own."""
    output: Output = "physical"
    """Volts at the converter, or volts over the nominal sensitivity."""
    converter: Converter | None = None
    dropouts: Dropouts | None = None

    @model_validator(mode="before")
    @classmethod
    def _filled_in(cls, data: object) -> object:
        if isinstance(data, Mapping) and data.get("preset") is not None:
            return with_preset(data, str(cls.model_fields["kind"].default))
        return data


class _Analogue(_Channel):
    sensor: Transducer = Transducer()
    noise: Noise | None = None
    hum: Hum | None = None
    drift: Drift | None = None
    anti_alias: AntiAlias | None = None


class Accelerometer(_Analogue):
    """Acceleration of a part in a direction, m/s^2."""

    QUANTITY: ClassVar[str] = "acceleration"
    UNIT: ClassVar[str] = "m/s^2"
    kind: Literal["accelerometer"] = "accelerometer"
    place: Place
    path: Path | None = None
    mounting: Mounting | None = None


class VelocitySensor(_Analogue):
    """Velocity of a part in a direction, m/s."""

    QUANTITY: ClassVar[str] = "velocity"
    UNIT: ClassVar[str] = "m/s"
    kind: Literal["velocity"] = "velocity"
    place: Place
    path: Path | None = None
    mounting: Mounting | None = None


class ProximityProbe(_Analogue):
    """Displacement of a surface towards or away from a probe, m."""

    QUANTITY: ClassVar[str] = "displacement"
    UNIT: ClassVar[str] = "m"
    kind: Literal["proximity"] = "proximity"
    place: Place
    probe: Probe = Probe(run_out=[])


class TorqueSensor(_Analogue):
    """Torque in a shaft between its end mass and its first wheel, N m, or the current of a drive in proportion, A."""

    QUANTITY: ClassVar[str] = "torque"
    UNIT: ClassVar[str] = "N m"
    kind: Literal["torque"] = "torque"
    shaft: Name
    torque_constant_nm_per_a: Annotated[float, Field(gt=0, le=1e6)] | None = None
    """Given: the channel is the current torque / constant in A. A proxy: no motor is modelled."""


class Tacho(_Channel):
    """Pulses of a shaft: the sampled square wave, and the pulse times."""

    QUANTITY: ClassVar[str] = "tacho"
    UNIT: ClassVar[str] = "V"
    kind: Literal["tacho"] = "tacho"
    shaft: Name
    pulser: Pulser = Pulser()


AnalogueChannel = Accelerometer | VelocitySensor | ProximityProbe | TorqueSensor
ChannelSpec = Annotated[
    Accelerometer | VelocitySensor | ProximityProbe | TorqueSensor | Tacho, Field(discriminator="kind")
]


class SensorChain(SpecModel):
    """Everything between the machine's motion and the numbers of a recording.

    Order: place, transfer path, mounting, sensor, noise, hum, drift, anti-alias filter, clock, converter, dropouts.
    """

    schema_version: Literal[1] = 1
    """Also the version of what the stages compute."""
    name: Annotated[str, Field(max_length=80)] = "sensors"
    seed: Annotated[int, Field(ge=0, le=2**53 - 1)] = 0
    """Beside the seed of the simulation: other noise on the same motion."""
    clock: Clock = Clock()
    channels: Annotated[list[ChannelSpec], Field(min_length=1, max_length=MAX_CHANNELS)]

    @model_validator(mode="after")
    def _bounded(self) -> Self:
        names = [channel.name for channel in self.channels]
        twice = sorted({name for name in names if names.count(name) > 1})
        if twice:
            raise ValueError(f"channels need different names; twice: {', '.join(twice)}")
        if "time_s" in names or "sampling_rate_hz" in names:
            raise ValueError("`time_s` and `sampling_rate_hz` are names that a result uses itself")
        paths = [getattr(channel, "path", None) for channel in self.channels]
        if sum(len(p.taps) for p in paths if isinstance(p, MeasuredPath)) > MAX_TOTAL_TAPS:
            raise ValueError(f"has more than {MAX_TOTAL_TAPS} taps in all impulse responses together")
        return self
