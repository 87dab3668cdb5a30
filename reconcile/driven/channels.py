"""Which channel drives and which answers."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import NDArray

from signals.recording import Recording
from sim.core.errors import Problem, SpecError
from sim.core.response import Channel
from sim.core.spec import MachineSpec, MeasuredLoad

FloatArray = NDArray[np.float64]
BoolArray = NDArray[np.bool_]
INPUT_WORDS = frozenset({"input", "drive", "excitation", "force_in", "u"})
OUTPUT_WORDS = frozenset({"output", "response", "out", "y"})
MOTIONS = {"displacement": 0, "velocity": 1, "acceleration": 2}
"""Quantities of a motion and their order of derivative."""
FORCES = frozenset({"force", "torque"})


@dataclass(frozen=True, kw_only=True)
class Driven:
    """An input and its response, (n,) each, in the units of their channels. `order`: derivative the output measures."""

    step_s: float
    drive: FloatArray
    answer: FloatArray
    drive_channel: Channel
    answer_channel: Channel
    prescribed: bool
    """The input is a motion, and the output the force that it takes."""
    assumed: str = ""
    """What had to be assumed about the roles."""
    bad_drive: BoolArray | None = None
    bad_answer: BoolArray | None = None
    """Samples (n,) at which a channel was away, held or cut off; None: nowhere."""
    moved: bool = False
    """The mass is seen from a base that is moved; both motions were held against each other before."""

    @property
    def order(self) -> int:
        """Derivative of the displacement that the output measures."""
        return MOTIONS.get(self.answer_channel.quantity, 0)

    @property
    def calibrated(self) -> bool:
        """Whether input and output carry units of force and motion."""
        kinds = {self.drive_channel.quantity, self.answer_channel.quantity}
        return bool(kinds & FORCES) and bool(kinds & set(MOTIONS))

    def part(self, first: int, last: int) -> Driven:
        """Samples first <= i < last."""
        return replace(
            self,
            drive=self.drive[first:last],
            answer=self.answer[first:last],
            bad_drive=None if self.bad_drive is None else self.bad_drive[first:last],
            bad_answer=None if self.bad_answer is None else self.bad_answer[first:last],
        )


def _told(channel: Channel, words: frozenset[str]) -> bool:
    """Whether the channel's location is one of these words; or its name, where the location gives it no role and the
    quantity no other one: a displacement called `u` drives nothing by that."""
    location = channel.location.lower()
    if location in INPUT_WORDS | OUTPUT_WORDS:
        return location in words
    other = MOTIONS if words is INPUT_WORDS else FORCES
    return channel.name.lower() in words and channel.quantity not in other


def _motion(rows: Sequence[int], channels: Sequence[Channel], spec: MachineSpec) -> int | None:
    """The motion of the body: of those at its place and along its axis, where others are not, the one least derived.

    None where several are left that nothing tells apart.
    """
    bodies = {b.name for b in spec.bodies}
    axes = {axis for b in spec.bodies for axis in b.axes}
    left = [i for i in rows if _place(channels[i]) in bodies] or list(rows)
    left = [i for i in left if channels[i].axis.lower() in axes] or left
    least = min(MOTIONS[channels[i].quantity] for i in left)
    left = [i for i in left if MOTIONS[channels[i].quantity] == least]
    return left[0] if len(left) == 1 else None


def _roles(channels: tuple[Channel, ...], prescribed: bool, spec: MachineSpec) -> tuple[int, int, str]:
    """Rows of input and output, and what was assumed."""
    inputs = [i for i, c in enumerate(channels) if _told(c, INPUT_WORDS)]
    outputs = [i for i, c in enumerate(channels) if _told(c, OUTPUT_WORDS)]
    forces = [i for i, c in enumerate(channels) if c.quantity in FORCES]
    motions = [i for i, c in enumerate(channels) if c.quantity in MOTIONS]
    if len(inputs) > 1:
        raise _untold([channels[i] for i in inputs], "more than one channel says that it is the input")
    moved = [i for i in outputs if i in motions] or [i for i in motions if i in inputs] or motions
    motion = _motion(moved, channels, spec) if moved else None
    if motion is not None and len(moved) > 1 and set(moved) == set(outputs):
        outputs = [motion]
    if len(inputs) == 1 and len(outputs) == 1:
        return inputs[0], outputs[0], ""
    if forces and motions:
        if motion is None:
            raise _untold([channels[i] for i in moved], "cannot tell which motion is that of the mass")
        force = next((i for i in (*inputs, *outputs) if i in forces), forces[0])
        swapped = motion in inputs or _placed(channels[force]) or (prescribed and not inputs)
        return (motion, force, "") if swapped else (force, motion, "")
    if len(channels) == 2 and len(motions) < 2 and len(forces) < 2:
        if len(inputs) == 1:
            return inputs[0], 1 - inputs[0], ""
        first, second = channels[0].name, channels[1].name
        return 0, 1, f"no channel says that it is the input: {first} (the first) is taken to drive {second}"
    raise _untold(channels, "cannot tell which channel drives the mass on its spring")


def _placed(channel: Channel) -> bool:
    """Whether the location says that this is the output."""
    return channel.location.lower() in OUTPUT_WORDS


def _untold(channels: Sequence[Channel], why: str) -> SpecError:
    names = ", ".join(f"{c.name} ({c.quantity or c.unit})" for c in channels)
    message = f"{why}: give one the location `input`, one `output`"
    return SpecError(
        Problem(field="channels", message=message, given=names, allowed="one force and one motion, or two")
    )


def _place(channel: Channel) -> str:
    return channel.location.split(".")[0]


def _check_places(channels: Sequence[Channel], spec: MachineSpec) -> None:
    """SpecError for a channel that sits on something else than the mass."""
    bodies = [b.name for b in spec.bodies]
    problems = [
        Problem(
            field=f"channels.{c.name}.location",
            message="is not a place of this machine",
            given=c.location,
            allowed=f"{', '.join(bodies)}, input, output, or nothing",
        )
        for c in channels
        if c.location and _place(c) not in bodies and c.location.lower() not in INPUT_WORDS | OUTPUT_WORDS
    ]
    if problems:
        raise SpecError(problems)


def undirected(recording: Recording, spec: MachineSpec) -> bool:
    """Whether nothing says which of force and motion drives: no measured load of the machine, no input channel."""
    told = any(isinstance(x, MeasuredLoad) for x in spec.loads)
    kinds = {c.quantity for c in recording.channels}
    both = bool(kinds & FORCES) and bool(kinds & set(MOTIONS))
    return both and not told and not any(_told(c, INPUT_WORDS) or _placed(c) for c in recording.channels)


def driven_of(recording: Recording, spec: MachineSpec, *, motion_drives: bool = False) -> Driven:
    """Input and output of a recording. The machine says by a measured displacement load that motion is prescribed."""
    loads = [x for x in spec.loads if isinstance(x, MeasuredLoad)]
    prescribed = motion_drives or any(x.quantity == "displacement" for x in loads)
    drive, answer, assumed = _roles(recording.channels, prescribed, spec)
    _check_places([recording.channels[drive], recording.channels[answer]], spec)
    samples = recording.samples[[drive, answer]]
    if not np.all(np.isfinite(samples)):
        place = int(np.argmax(~np.isfinite(samples).all(axis=0)))
        message = "a driven model needs every sample of input and output"
        given = f"no number at sample {place}"
        raise SpecError(Problem(field="samples", message=message, given=given, allowed="finite numbers throughout"))
    channels = recording.channels
    moved = channels[drive].quantity in MOTIONS and channels[answer].quantity in FORCES
    return Driven(
        step_s=1.0 / recording.sampling_rate_hz,
        drive=np.ascontiguousarray(samples[0]),
        answer=np.ascontiguousarray(samples[1]),
        drive_channel=channels[drive],
        answer_channel=channels[answer],
        prescribed=prescribed or moved,
        assumed=assumed,
    )
