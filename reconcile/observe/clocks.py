"""Do a recording's channels share a clock with each other as they did in the baseline?

Channels recorded one after the other, or by recorders that start apart, have phases between them that say nothing of
the machine. A delay turns all lines of a steady machine in proportion to their frequency; no effect does.
"""

from __future__ import annotations

import numpy as np

from signals.series import FloatArray

LONGEST_S = 0.5
STEPS_A_CYCLE = 6
"""Delays tried in a cycle of the highest line."""
FEWEST_LINES = 20
"""Of fewer some delay turns any phases into a row."""
IN_A_ROW = 0.9
"""Mean resultant length of the phases with the delay taken off; of 20 random ones one in a thousand reaches it."""
FILTER_S, FEWEST_STRONG, IN_ONE_ROW = 0.02, 12, 0.94
"""Delay of a filter or a converter at most; so many random phases reached 0.9 in none of 3,000 tries."""
SCATTERED = 0.6
"""With a larger one without any delay the clocks agree."""


def delay_s(phases_rad: FloatArray, lines_hz: FloatArray) -> float | None:
    """The delay that explains the change of phases (Q,) of lines (Q,) between two channels; None if none is needed, if
    none does, or if the lines are too few to say. NaN where a line is not known."""
    return _delay_s(phases_rad, lines_hz, fewest=FEWEST_LINES, longest_s=LONGEST_S, least=IN_A_ROW)


def shared_delay_s(phases_rad: FloatArray, lines_hz: FloatArray) -> float | None:
    """The same of strong lines alone, of all operating points together, up to a filter's delay: few lines,
    but at other frequencies from point to point, which phases that turn by themselves do not follow."""
    return _delay_s(phases_rad, lines_hz, fewest=FEWEST_STRONG, longest_s=FILTER_S, least=IN_ONE_ROW)


def _delay_s(
    phases_rad: FloatArray, lines_hz: FloatArray, *, fewest: int, longest_s: float, least: float
) -> float | None:
    known = np.isfinite(phases_rad)
    phases, hz = phases_rad[known], lines_hz[known]
    if phases.size < fewest or abs(np.mean(np.exp(1j * phases))) > SCATTERED:
        return None
    steps = int(np.ceil(longest_s * STEPS_A_CYCLE * hz.max()))
    delays = np.linspace(-longest_s, longest_s, 2 * steps + 1)
    found = _in_a_row(phases, hz, delays)
    best = int(np.argmax(found))
    return float(delays[best]) if found[best] > least else None


def _in_a_row(phases: FloatArray, hz: FloatArray, delays: FloatArray) -> FloatArray:
    """Mean resultant length (n,) with each delay taken off; line by line, so that memory is that of the delays."""
    total = np.zeros(delays.size, dtype=complex)
    for phase, f in zip(phases, hz, strict=True):
        total += np.exp(1j * (phase + 2.0 * np.pi * f * delays))
    return np.asarray(np.abs(total) / phases.size)
