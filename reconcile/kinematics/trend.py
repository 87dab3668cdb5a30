"""Amplitudes of a machine's kinematic families in one recording, as a series over many recordings follows them.

Shafts and meshes: lines of the raw signal over orders, RMS in the unit of the channel. Bearings: lines of the squared
envelope, amplitude over its mean (`reconcile.kinematics.envelopes`), in the band that shows the family best; a gain
that changes does not move them. Of a bearing's family the fundamental is the value: higher harmonics of different
families meet within the slip that is allowed for (2 f_i and 3 f_o of a 6205 are 1.5 % apart), and a defect of one race
would raise all. A line that is not there reads what noise puts in its place.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.kinematics.envelopes import Envelopes
from reconcile.kinematics.families import Family, Ties, ties
from reconcile.kinematics.lines import order_lines
from reconcile.kinematics.observe import Observation, observe
from reconcile.kinematics.spec import KinematicSpec
from reconcile.speed import SpeedEstimate
from signals.recording import Recording

SHAFT_HARMONICS = 3
MESH_HARMONICS = 3
HALF_WIDTH = 0.01
"""Of an order: a line spreads where the speed wanders."""
HANN_BANDWIDTH = 1.5
"""Noise bandwidth of the window in bins: power summed over bins, over this, is the line's."""
SLIPS = 81
SIDEBAND_STEPS = 2.0
"""Bins that a line may lie from the place of a sideband: half a bin each for the two lines, and one for the window."""
LETTERS = {"outer": "o", "inner": "i", "ball": "b", "cage": "c"}


@dataclass(frozen=True, kw_only=True)
class LineLevel:
    """One line: `2*f_o1`; where it was looked for or, within a bearing's slip, found; its amplitude."""

    label: str
    frequency_hz: float
    amplitude: float


@dataclass(frozen=True, kw_only=True)
class FamilyLevel:
    """A family in one channel: `value` is the root sum of squares of the lines, RMS in the channel's unit; where
    `relative`, the amplitude of the first line over the mean of the squared envelope."""

    channel: str
    site: str
    kind: str
    """`shaft`, `mesh`, `outer`, `inner`, `ball` or `cage`."""
    relative: bool
    value: float
    lines: tuple[LineLevel, ...]
    sideband_of: str | None = None
    """Key of a family of the same bearing, of a greater value, whose first sideband lies where this line was found."""

    @property
    def key(self) -> str:
        """`bearing1.outer`."""
        return f"{self.site}.{self.kind}"


@dataclass(frozen=True, kw_only=True)
class Levels:
    """All families of all channels, and the speed that they were looked for at."""

    speed: SpeedEstimate
    families: tuple[FamilyLevel, ...]


def family_levels(spec: KinematicSpec, recording: Recording, *, seed: int = 0) -> Levels:
    """Every family of `spec` in every channel; SpecError says why none can be found (speed, turns, rate)."""
    shaft = recording.operating.shaft if recording.operating is not None else None
    if shaft is None and recording.tacho is not None:
        shaft = recording.tacho.shaft
    tie = ties(spec, shaft)
    stated = {s.name: s.speed_hz for s in spec.shafts}[tie.reference]
    seen = observe(recording, tie, "recording", stated_hz=stated, seed=seed)
    found: list[FamilyLevel] = []
    for envelope in seen.channels:
        found += _raw(seen, envelope.channel, tie)
        bearings = [family for family in tie.families if family.kind in LETTERS]
        levels = [_bearing(family, envelope, seen, spec) for family in bearings]
        found += _with_sidebands(bearings, levels, seen, SIDEBAND_STEPS * envelope.order_step)
    return Levels(speed=seen.speed, families=tuple(found))


def _raw(seen: Observation, channel: str, tie: Ties) -> list[FamilyLevel]:
    """Shafts and meshes."""
    spectrum = order_lines(seen, channel)
    if spectrum is None:
        return []
    rows = [(name, "shaft", f"f_r{i}", ratio, SHAFT_HARMONICS) for i, (name, ratio) in enumerate(tie.shafts.items(), 1)]
    for i, mesh in enumerate(tie.meshes, 1):
        rows.append((mesh[0], "mesh", "f_m" if len(tie.meshes) == 1 else f"f_m{i}", mesh[1], MESH_HARMONICS))
    found = []
    for site, kind, base, order, harmonics in rows:
        lines = []
        for k in range(1, harmonics + 1):
            width = max(2 * spectrum.order_step, HALF_WIDTH * k * order)
            power = float(spectrum.within(np.array([k * order]), width)[0][0]) / HANN_BANDWIDTH
            if np.isfinite(power):
                hz = k * order * seen.speed.speed_hz
                lines.append(LineLevel(label=f"{k}*{base}", frequency_hz=hz, amplitude=float(np.sqrt(power))))
        if lines:
            found.append(_family(channel, site, kind, lines, relative=False))
    return found


def _bearing(family: Family, envelope: Envelopes, seen: Observation, spec: KinematicSpec) -> FamilyLevel:
    """The strongest first line within the slip, over all bands, and the harmonics at the same slip.

    The largest of many bins of noise varies little, so that a sound bearing has a steady level to rise from.
    """
    reach = family.slip + seen.doubt
    multiples = np.arange(1, family.harmonics + 1)
    orders = np.outer(family.order * (1 + np.linspace(-reach, reach, SLIPS)), multiples)
    depth = envelope.depth[:, envelope.place(orders)]
    first = depth[:, :, 0]
    band, slip = np.unravel_index(int(np.argmax(first)), first.shape)
    index = 1 + [b.name for b in spec.bearings].index(family.site)
    base = f"f_{LETTERS[family.kind]}{index}"
    lines = [
        LineLevel(label=f"{k}*{base}", frequency_hz=float(order * seen.speed.speed_hz), amplitude=float(amplitude))
        for k, order, amplitude in zip(multiples, orders[slip], depth[band, slip], strict=True)
    ]
    return _family(envelope.channel, family.site, family.kind, lines, relative=True)


def _with_sidebands(
    families: Sequence[Family], levels: Sequence[FamilyLevel], seen: Observation, width: float
) -> list[FamilyLevel]:
    """The levels of one channel, each with the clearest family that its line may be a first sideband of."""
    orders = [level.lines[0].frequency_hz / seen.speed.speed_hz for level in levels]
    found = []
    for level, order in zip(levels, orders, strict=True):
        clearer = [
            other
            for family, other, at in zip(families, levels, orders, strict=True)
            if other.site == level.site and other.value > level.value and family.sidebands > 0
            if abs(abs(order - at) - family.spacing) <= width
        ]
        best = max(clearer, key=lambda other: other.value, default=None)
        found.append(level if best is None else replace(level, sideband_of=best.key))
    return found


def _family(channel: str, site: str, kind: str, lines: list[LineLevel], *, relative: bool) -> FamilyLevel:
    value = lines[0].amplitude if relative else float(np.sqrt(sum(line.amplitude**2 for line in lines)))
    return FamilyLevel(channel=channel, site=site, kind=kind, relative=relative, value=value, lines=tuple(lines))
