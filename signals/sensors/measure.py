"""The measurement chain carried out: motion in, recording out."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from signals.recording import Tacho as TachoTimes
from signals.sensors.analogue import at_converter
from signals.sensors.clock import nominal_rate_hz, sampled, sampling_instants, stretch
from signals.sensors.converter import converted
from signals.sensors.dropouts import filled, lost
from signals.sensors.motion import Motion
from signals.sensors.pickups import pickups
from signals.sensors.place import Pickup
from signals.sensors.report import ChannelReport, Measured, description
from signals.sensors.seeds import Stage, generator
from signals.sensors.shafts import check_pulses
from signals.sensors.spec import AnalogueChannel, ChannelSpec, SensorChain, Tacho, TorqueSensor
from signals.sensors.tacho import TURN, edges, pulse_times_s, square_wave
from signals.series import FloatArray
from sim.core.response import Channel


@dataclass(frozen=True, kw_only=True)
class _Run:
    """What all channels of one measurement share."""

    motion: Motion
    chain: SensorChain
    seeds: tuple[int, ...]
    instants_s: FloatArray
    """True times of the samples, shape (m,), s, from the first sample of the motion on."""

    @property
    def rate_hz(self) -> float:
        return self.motion.recording.sampling_rate_hz

    def random(self, stage: Stage, channel: str = "") -> np.random.Generator:
        return generator(self.seeds, stage, channel)


@dataclass(frozen=True, kw_only=True)
class _Row:
    values: FloatArray
    report: ChannelReport
    pulse_times_s: FloatArray | None = None


def measure(motion: Motion, chain: SensorChain, *, seed: int = 0) -> Measured:
    """What the recorder writes down. The same motion, chain and seed give the same bytes.

    The recording begins with the first sample of the motion. SpecError names what of the chain the motion cannot
    serve: parts, axes, shafts, the sampling rate.
    """
    recording = motion.recording
    known = {c.name: c.quantity for c in recording.channels}
    found = pickups(chain, motion.machine, known)
    rate = nominal_rate_hz(chain.clock, recording.sampling_rate_hz)
    seeds = (seed, chain.seed)
    instants = sampling_instants(
        chain.clock, recording.samples.shape[1], recording.sampling_rate_hz, generator(seeds, Stage.CLOCK)
    )
    run = _Run(motion=motion, chain=chain, seeds=seeds, instants_s=instants)
    rows = [_row(run, spec, pickup) for spec, pickup in zip(chain.channels, found, strict=True)]
    reports = tuple(row.report for row in rows)
    measured = replace(
        recording,
        sampling_rate_hz=rate,
        channels=tuple(_channel(report) for report in reports),
        samples=np.stack([row.values for row in rows]),
        tacho=_tacho(chain, rows),
        notes=f"{recording.notes}; measured by {chain.name}" if recording.notes else f"measured by {chain.name}",
    )
    measured = replace(measured, chain=description(chain, reports, measured, seed))
    return Measured(recording=measured, reports=reports)


def _row(run: _Run, spec: ChannelSpec, pickup: Pickup) -> _Row:
    if isinstance(spec, Tacho):
        return _pulses(run, spec, pickup)
    analogue = at_converter(spec, run.motion, pickup, lambda stage: run.random(stage, spec.name))
    volts = sampled(analogue.volts, run.rate_hz, run.chain.clock, run.instants_s)
    row = _digital(run, spec, pickup, volts, _unit_v(spec))
    report = replace(row.report, saturated_samples=analogue.saturated, out_of_range_samples=analogue.beyond)
    return replace(row, report=report)


def _pulses(run: _Run, spec: Tacho, pickup: Pickup) -> _Row:
    """A square wave is sampled as it is: it has no band that an interpolation could be limited to."""
    angle = run.motion.angle_rad(spec.shaft)
    for name in pickup.factors:
        angle = angle + run.motion.recording.series(name).samples
    per_turn = spec.pulser.pulses_per_revolution
    check_pulses(float(np.ptp(angle)) / TURN * per_turn, per_turn, f"{spec.name}.pulser.pulses_per_revolution")
    found = edges(angle, run.rate_hz, spec.pulser, run.random(Stage.TACHO, spec.name))
    row = _digital(run, spec, pickup, square_wave(found, spec.pulser, run.instants_s), 1.0)
    # Counters count from the recorder's first sample, but Recording.tacho is on the time axis of the samples.
    times = run.motion.recording.start_s + pulse_times_s(found, spec.pulser, stretch(run.chain.clock))
    return replace(row, pulse_times_s=times)


def _unit_v(spec: AnalogueChannel) -> float:
    """Volts that the output is divided by."""
    return 1.0 if spec.output == "volts" else spec.sensor.sensitivity_v_per_unit


def _digital(run: _Run, spec: ChannelSpec, pickup: Pickup, volts: FloatArray, unit_v: float) -> _Row:
    """Converter, unit and dropouts."""
    clipped, step = 0, None
    if spec.converter is not None:
        found = converted(volts, spec.converter)
        volts, clipped, step = found.volts, found.clipped, found.step_v / unit_v
    values, gone = volts / unit_v, 0
    if spec.dropouts is not None:
        rate = nominal_rate_hz(run.chain.clock, run.rate_hz)
        mask = lost(spec.dropouts, values.size, rate, run.random(Stage.DROPOUT, spec.name))
        values, gone = filled(values, mask, spec.dropouts.fill), int(np.count_nonzero(mask))
    current = isinstance(spec, TorqueSensor) and spec.torque_constant_nm_per_a is not None
    unit = "V" if spec.output == "volts" else "A" if current else spec.UNIT
    report = ChannelReport(
        name=spec.name,
        kind=spec.kind,
        preset=spec.preset,
        quantity="current" if current else spec.QUANTITY,
        unit=unit,
        location=pickup.location,
        axis=pickup.axis,
        sources=dict(pickup.factors),
        clipped_samples=clipped,
        lost_samples=gone,
        step=step,
    )
    return _Row(values=values, report=report)


def _channel(report: ChannelReport) -> Channel:
    return Channel(
        name=report.name,
        quantity=report.quantity,
        unit=report.unit,
        location=report.location,
        axis=report.axis,
    )


def _tacho(chain: SensorChain, rows: Sequence[_Row]) -> TachoTimes | None:
    """Pulse times of the first tacho."""
    for spec, row in zip(chain.channels, rows, strict=True):
        if isinstance(spec, Tacho) and row.pulse_times_s is not None:
            return TachoTimes(
                shaft=spec.shaft,
                pulse_times_s=row.pulse_times_s,
                pulses_per_revolution=spec.pulser.pulses_per_revolution,
            )
    return None
