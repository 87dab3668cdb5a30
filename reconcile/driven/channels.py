"""Which channel drives and which answers."""

from __future__ import annotations

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
    return bool({channel.location.lower(), channel.axis.lower(), channel.name.lower()} & words)


def _roles(channels: tuple[Channel, ...], prescribed: bool) -> tuple[int, int, str]:
    """Rows of input and output, and what was assumed."""
    inputs = [i for i, c in enumerate(channels) if _told(c, INPUT_WORDS)]
    outputs = [i for i, c in enumerate(channels) if _told(c, OUTPUT_WORDS)]
    forces = [i for i, c in enumerate(channels) if c.quantity in FORCES]
    motions = sorted(
        (i for i, c in enumerate(channels) if c.quantity in MOTIONS), key=lambda i: MOTIONS[channels[i].quantity]
    )
    if len(inputs) == 1 and (outputs or len(channels) == 2):
        rest = outputs or [i for i in range(2) if i != inputs[0]]
        return inputs[0], rest[0], ""
    if forces and motions:
        return (motions[0], forces[0], "") if prescribed else (forces[0], motions[0], "")
    if len(channels) == 2 and len(motions) < 2:
        first, second = channels[0].name, channels[1].name
        return 0, 1, f"no channel says that it is the input: {first} (the first) is taken to drive {second}"
    names = ", ".join(f"{c.name} ({c.quantity or c.unit})" for c in channels)
    message = "cannot tell which channel drives the mass on its spring: give one the location `input`, one `output`"
    raise SpecError(Problem(field="channels", message=message, given=names, allowed="one force and one motion, or two"))


def undirected(recording: Recording, spec: MachineSpec) -> bool:
    """Whether nothing says which of force and motion drives: no measured load of the machine, no input channel."""
    told = any(isinstance(x, MeasuredLoad) for x in spec.loads)
    kinds = {c.quantity for c in recording.channels}
    both = bool(kinds & FORCES) and bool(kinds & set(MOTIONS))
    return both and not told and not any(_told(c, INPUT_WORDS) for c in recording.channels)


def driven_of(recording: Recording, spec: MachineSpec, *, motion_drives: bool = False) -> Driven:
    """Input and output of a recording. The machine says by a measured displacement load that motion is prescribed."""
    loads = [x for x in spec.loads if isinstance(x, MeasuredLoad)]
    prescribed = motion_drives or any(x.quantity == "displacement" for x in loads)
    drive, answer, assumed = _roles(recording.channels, prescribed)
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
