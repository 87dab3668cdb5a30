"""What the indicators need to know beside the samples: which shafts turn, how fast, with which gears."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from jobs.results import ResultReader
from jobs.slices import Window, window
from signals.angle import tacholess_angle
from signals.labels.machine import machine_kinematics
from signals.recording import Recording, Tacho
from signals.series import FloatArray, Series
from sim.core.errors import Problem, SpecError, UnknownName
from sim.core.spec import MachineSpec
from sim.core.speed import speed_table, warped_times

Rotation = Literal["known", "tacholess"]
TACHOLESS_RANGE = 0.1
"""Share of the stated speed within which the shaft is looked for when its angle is taken from the vibration."""
TACHOLESS_ORDERS = (1, 2, 3)
"""Orders followed on a shaft without a gear; with one, the first two mesh harmonics."""


@dataclass(frozen=True, kw_only=True)
class ShaftInfo:
    """`ratio` to the shaft whose angle is known; `teeth` of the gears on it."""

    speed_hz: float
    ratio: float
    teeth: tuple[int, ...]
    component: str


@dataclass(frozen=True, kw_only=True)
class Subject:
    """A channel, the shafts by base (`f_r1`), the other base frequencies, and the angle of the shaft of ratio 1.

    `rotation` is its speed in Hz, a tacho, or the angle at each sample, (n,), rad; `rotation_basis` says whence.
    """

    series: Series
    shafts: Mapping[str, ShaftInfo]
    bases_hz: Mapping[str, float]
    rotation: float | Tacho | FloatArray
    rotation_basis: str

    def shaft(self, name: str | None) -> str:
        """The base of the shaft called so, by base or component; the first one with a gear when not said."""
        if not self.shafts:
            message = "no shaft with a known speed: give its speed"
            raise SpecError(Problem(field="shaft", message=message, given=name))
        if name is None:
            return next((base for base, info in self.shafts.items() if info.teeth), next(iter(self.shafts)))
        for base, info in self.shafts.items():
            if name in (base, info.component):
                return base
        called = [known for base, info in self.shafts.items() for known in (base, info.component) if known]
        raise UnknownName("shaft", name, list(dict.fromkeys(called)))


def stretch_of(reader: ResultReader, start_s: float | None, end_s: float | None) -> Window:
    """The samples that indicators of a stored result are made of: from where its analysis begins, unless told."""
    begins = reader.document("summary").get("analysed_from_s", 0.0)
    assert isinstance(begins, int | float)
    return window(reader, begins if start_s is None else start_s, end_s)


def of_result(reader: ResultReader, channel: str, machine: MachineSpec, part: Window) -> Subject:
    """A stretch of a channel of a stored result; its angle is that of the specified speed."""
    about, bases = reader.channel(channel), bases_of(reader)
    rate = reader.manifest.sampling_rate_hz
    series = Series(
        samples=reader.signal(channel, part.start, part.stop),
        sampling_rate_hz=rate,
        unit=about.unit,
        name=channel,
        quantity=about.quantity,
        start_s=part.start / rate,
    )
    return of_simulation(series, machine, bases, reader.manifest.seed)


def bases_of(reader: ResultReader) -> Mapping[str, float]:
    """Base frequencies of a stored result, Hz."""
    bases = reader.document("summary").get("frequencies", {})
    assert isinstance(bases, dict)
    return bases


def of_simulation(series: Series, machine: MachineSpec, bases_hz: Mapping[str, float], seed: int) -> Subject:
    """A channel of a simulated machine."""
    operating = machine.operating
    kinematics = machine_kinematics(machine, bases_hz)
    turning = [s for s in kinematics.shafts if bases_hz.get(s.base, 0.0) > 0]
    if operating is None or not turning:
        return Subject(series=series, shafts={}, bases_hz=bases_hz, rotation=0.0, rotation_basis="nothing turns")
    reference = next(s.base for s in turning if s.component == operating.shaft)
    teeth: dict[str, list[int]] = {s.base: [] for s in turning}
    for mesh in kinematics.meshes:
        teeth[mesh.pinion_shaft].append(mesh.pinion_teeth)
        teeth[mesh.gear_shaft].append(mesh.gear_teeth)
    t = series.start_s + np.arange(series.samples.size) / series.sampling_rate_hz
    turned, _ = warped_times(speed_table(operating.profile, seed), t)
    return Subject(
        series=series,
        shafts={
            s.base: ShaftInfo(
                speed_hz=bases_hz[s.base],
                ratio=bases_hz[s.base] / bases_hz[reference],
                teeth=tuple(sorted(set(teeth[s.base]))),
                component=s.component,
            )
            for s in turning
        },
        bases_hz=bases_hz,
        rotation=2 * np.pi * operating.speed_hz * turned,
        rotation_basis="specified speed",
    )


def of_recording(recording: Recording, channel: str, *, speed_hz: float | None, teeth: tuple[int, ...]) -> Subject:
    """A channel of a recording. `speed_hz` (else of its operating point) and `teeth` are those of its one shaft."""
    operating, tacho = recording.operating, recording.tacho
    series = recording.series(channel)
    speed = speed_hz if speed_hz is not None else (operating.speed_hz if operating is not None else None)
    if speed is None and tacho is not None:
        turns = (len(tacho.pulse_times_s) - 1) / tacho.pulses_per_revolution
        speed = turns / float(tacho.pulse_times_s[-1] - tacho.pulse_times_s[0])
    if speed is None:
        return Subject(series=series, shafts={}, bases_hz={}, rotation=0.0, rotation_basis="no speed given")
    if not (np.isfinite(speed) and speed > 0):
        raise SpecError(
            Problem(field="speed_hz", message="must be positive", given=speed, allowed="above 0", unit="Hz")
        )
    component = operating.shaft if operating is not None else (tacho.shaft if tacho is not None else "shaft")
    return Subject(
        series=series,
        shafts={"f_r1": ShaftInfo(speed_hz=speed, ratio=1.0, teeth=teeth, component=component)},
        bases_hz={"f_r1": speed},
        rotation=speed if tacho is None else tacho,
        rotation_basis="constant speed" if tacho is None else "tacho",
    )


def without_tacho(subject: Subject, base: str) -> Subject:
    """The same with the angle of shaft `base` taken from the vibration; other shafts follow in their ratios."""
    info = subject.shafts[base]
    orders = tuple(k * info.teeth[0] for k in (1, 2)) if info.teeth else TACHOLESS_ORDERS
    highest = subject.series.sampling_rate_hz / 2 / (info.speed_hz * (1 + TACHOLESS_RANGE))
    track = tacholess_angle(
        subject.series,
        orders=[k for k in orders if k < highest] or [orders[0]],
        low_hz=info.speed_hz * (1 - TACHOLESS_RANGE),
        high_hz=info.speed_hz * (1 + TACHOLESS_RANGE),
    )
    spread = "" if track.spread_rad is None else f", orders agree to {track.spread_rad:.2g} rad"
    told = ", ".join(f"{k:g}" for k in track.orders)
    return replace(
        subject,
        shafts={name: replace(s, ratio=s.ratio / info.ratio) for name, s in subject.shafts.items()},
        rotation=track.angle_rad,
        rotation_basis=f"phase of orders {told} of {base}{spread}",
    )
