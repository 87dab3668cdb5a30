"""The analogue part of a channel: from the motion to the voltage at the sampler."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from signals.sensors.antialias import through_filter
from signals.sensors.disturbance import drift_over, hum_at
from signals.sensors.linear import MAX_SETTLE_S, butterworth_settle_s, settle_s
from signals.sensors.motion import Motion
from signals.sensors.mounting import through_mounting
from signals.sensors.noise import drawn
from signals.sensors.path import settling_s, through_path
from signals.sensors.place import Pickup
from signals.sensors.proximity import seen
from signals.sensors.seeds import Stage
from signals.sensors.spec import Accelerometer, AnalogueChannel, ProximityProbe, TorqueSensor, VelocitySensor
from signals.sensors.transducer import sensed
from signals.series import FloatArray


@dataclass(frozen=True, kw_only=True)
class Analogue:
    """Volts (n,) at the simulation's rate; samples at the sensor's limit; samples beyond a probe's range."""

    volts: FloatArray
    saturated: int
    beyond: int


def picked_up(motion: Motion, pickup: Pickup) -> FloatArray:
    """The quantity along the sensor's direction, (n,): sum of direction cosine times channel."""
    total = np.zeros(motion.recording.samples.shape[1])
    for name, factor in pickup.factors.items():
        total += factor * motion.recording.series(name).samples
    return total


def quantity_at_sensor(spec: AnalogueChannel, motion: Motion, pickup: Pickup) -> tuple[FloatArray, int]:
    """What reaches the sensor, (n,), in the channel's unit, and samples beyond its range."""
    found, rate = picked_up(motion, pickup), motion.recording.sampling_rate_hz
    if isinstance(spec, TorqueSensor):
        return found / (spec.torque_constant_nm_per_a or 1.0), 0
    if isinstance(spec, ProximityProbe):
        angle = motion.angle_rad(spec.probe.shaft) if spec.probe.shaft is not None else None
        gap = seen(found, spec.probe, angle)
        return gap.gap_m, gap.beyond
    if spec.path is not None:
        found = through_path(found, rate, spec.path)
    if spec.mounting is not None:
        found = through_mounting(found, rate, spec.mounting)
    return found, 0


def disturbances(
    spec: AnalogueChannel, time_s: FloatArray, rate_hz: float, random: Callable[[Stage], np.random.Generator]
) -> FloatArray:
    """Noise, hum and drift, (n,), in the channel's unit."""
    total = np.zeros(time_s.size)
    if spec.noise is not None:
        total += drawn(spec.noise, time_s.size, rate_hz, random(Stage.NOISE))
    if spec.hum is not None:
        total += hum_at(spec.hum, time_s, random(Stage.HUM))
    if spec.drift is not None:
        total += drift_over(spec.drift, time_s.size, rate_hz, random(Stage.DRIFT))
    return total


def longest_tail_s(spec: AnalogueChannel) -> float:
    """Time in which the slowest of a channel's filters dies out, s: what each is padded with while it is applied."""
    tails = [0.0]
    if isinstance(spec, Accelerometer | VelocitySensor):
        tails += [settling_s(spec.path)] if spec.path is not None else []
        tails += (
            [settle_s(spec.mounting.frequency_hz, spec.mounting.damping_ratio)] if spec.mounting is not None else []
        )
    if spec.anti_alias is not None:
        tails.append(butterworth_settle_s(spec.anti_alias.cutoff_hz, spec.anti_alias.order))
    return min(max(tails), MAX_SETTLE_S)


def at_converter(
    spec: AnalogueChannel, motion: Motion, pickup: Pickup, random: Callable[[Stage], np.random.Generator]
) -> Analogue:
    """Voltage at the sampler."""
    rate = motion.recording.sampling_rate_hz
    quantity, beyond = quantity_at_sensor(spec, motion, pickup)
    found = sensed(quantity, rate, spec.sensor)
    added = disturbances(spec, motion.time_s(), rate, random)
    volts = found.volts + added * spec.sensor.sensitivity_v_per_unit
    if spec.anti_alias is not None:
        volts = through_filter(volts, rate, spec.anti_alias)
    return Analogue(volts=volts, saturated=found.saturated, beyond=beyond)
