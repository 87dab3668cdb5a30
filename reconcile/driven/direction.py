"""Which way round: did the force make the motion, or was the motion prescribed and the force what it took?

Where nothing says so, a drive with one dominant frequency gives it away: what was commanded is the purer signal, what
answers has the harmonics. Other drives are taken to be forces.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from scipy import fft

from reconcile.driven.channels import Driven, FloatArray, driven_of, undirected
from signals.recording import Recording
from sim.core.spec import MachineSpec

BAND = (0.5, 1.5)
"""Around the strongest line, over its frequency: a motion that swells or wanders keeps within it."""
NEAR = 0.15
"""Distance from a harmonic, over the frequency, that counts as on it."""
MOST_OFF = 0.1
"""Share of a commanded sine's power outside of the band."""
LEAST_IN, LEAST_ON = 0.6, 0.6
"""Share of the answer's power in the band, and of the rest on harmonics: a broad force has neither."""
RATIO = 3.0
"""How much more of the answer's power must lie outside of the band."""


def _power(values: FloatArray) -> FloatArray:
    found = np.abs(fft.rfft((values - values.mean()) * np.hanning(values.size))) ** 2
    return np.asarray(found / max(float(found.sum()), 1e-300))


def commanded(motion: FloatArray, force: FloatArray) -> tuple[bool, float, float]:
    """Whether the motion is a commanded sine and the force its answer; power of force and motion off the main line."""
    moved, pushed = _power(motion), _power(force)
    peak = max(int(np.argmax(moved)), 1)
    order = np.arange(moved.size) / peak
    inside = (order >= BAND[0]) & (order <= BAND[1])
    on = (np.abs(order - np.round(order)) < NEAR) & ~inside & (order > 1)
    off_motion, off_force = 1.0 - float(moved[inside].sum()), 1.0 - float(pushed[inside].sum())
    sine = off_motion < MOST_OFF and off_force < 1.0 - LEAST_IN
    answers = off_force > RATIO * off_motion and float(pushed[on].sum()) > LEAST_ON * off_force
    return sine and answers, off_force, off_motion


def directed(recording: Recording, spec: MachineSpec) -> Driven:
    """Input and output, with what had to be decided from the data said in `assumed`."""
    forced = driven_of(recording, spec)
    if not undirected(recording, spec):
        return forced
    moved = driven_of(recording, spec, motion_drives=True)
    prescribed, force, motion = commanded(moved.drive, moved.answer)
    found = moved if prescribed else forced
    text = (
        f"no channel says that it is the input: {found.drive_channel.name} is taken to drive "
        f"{found.answer_channel.name} (power off the main line: force {100 * force:.1f} %, motion {100 * motion:.1f} %)"
    )
    return replace(found, assumed=text)
