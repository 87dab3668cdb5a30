"""A base that is moved: the mass on it is seen from the base, where spring and damper act, and is driven by -m y''.

Taken as a force the base's motion would pull by the spring alone: what its damper passes on was left over.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import fft

from reconcile.driven.channels import MOTIONS, Driven, FloatArray

ASSUMED = "the input is the motion of the base: the mass is seen from there, its laws are of the relative motion"


def is_base(data: Driven) -> bool:
    """Whether both channels are motions of one quantity: of a base and of the mass on it."""
    drive, answer = data.drive_channel, data.answer_channel
    alike = (drive.quantity, drive.unit) == (answer.quantity, answer.unit)
    return not data.prescribed and drive.quantity in MOTIONS and alike


def from_base(data: Driven) -> Driven:
    """Relative motion under the base's acceleration, where both are motions of one quantity; else as it is."""
    if not is_base(data):
        return data
    drive = data.drive_channel
    bad = data.bad_answer
    if data.bad_drive is not None:
        bad = data.bad_drive if bad is None else data.bad_drive | bad
    return replace(
        data,
        drive=-derived(data.drive, data.step_s, 2 - MOTIONS[drive.quantity]),
        answer=data.answer - data.drive,
        drive_channel=replace(drive, quantity="acceleration", unit="m/s^2"),
        bad_answer=bad,
        moved=True,
        assumed="; ".join(text for text in (data.assumed, ASSUMED) if text),
    )


def derived(values: FloatArray, step_s: float, times: int) -> FloatArray:
    """Derivative of (n,) by its spectrum, continued at both ends as if turned about them, which keeps its slope."""
    if times == 0:
        return values
    longer = np.concatenate([2.0 * values[0] - values[:0:-1], values, 2.0 * values[-1] - values[-2::-1]])
    line = np.linspace(longer[0], longer[-1], longer.size)
    slope = (longer[-1] - longer[0]) / ((longer.size - 1) * step_s)
    turned = (2j * np.pi * np.fft.rfftfreq(longer.size, step_s)) ** times
    found = fft.irfft(fft.rfft(longer - line) * turned, longer.size) + (slope if times == 1 else 0.0)
    return np.ascontiguousarray(found[values.size - 1 : 2 * values.size - 1])
