"""Whether the numbers of a finished run mean anything: what is refused, what is told as doubtful, and who is to blame.

Limits and their reasons: docs/numerics.md, "When numbers mean nothing".
"""

from __future__ import annotations

import numpy as np

from sim.core.elements import Element
from sim.core.errors import Meaningless
from sim.core.response import FloatArray, Quality
from sim.core.system import System
from sim.solve.law_picture.bench import Bench

ENERGY_LOST = 0.5
"""Residual over all energy put through from which on nothing is known of where the energy went."""
UNCONVERGED_SHARE = 0.1
"""Share of steps taken with forces that had not settled. Impacts that stay unsettled at the finest step are single
steps among thousands; a tenth means that the forces never follow the motion."""
UNCONVERGED_DOUBT = 1e-3
STEP_SOUND = 1e-2
"""Step error up to which lost energy is doubtful only: what does not balance is then no part of the signals."""
LEVEL_LOST = 10.0
"""Difference between a step and its half, relative to the half: two unrelated paths of one level differ by sqrt(2), so
from here on the level itself is one of the step."""
LEVEL_DOUBT = 2.0
PROBES_M = 10.0 ** np.arange(-9.0, -3.0)
PROBES_M_PER_S = 10.0 ** np.arange(-6.0, 0.0)


def unconverged_share(quality: Quality) -> float:
    """Share of the steps that were taken although their forces had not settled."""
    return quality.unconverged_steps / max(quality.steps, 1)


def doubts(quality: Quality) -> tuple[str, ...]:
    """Sentences on what makes a result doubtful though not meaningless."""
    found = []
    residual, share = quality.energy.relative_residual, unconverged_share(quality)
    if not quality.energy.acceptable:
        limit = quality.energy.limit
        found.append(f"{100 * residual:.2g} % of the energy put through is unaccounted for (limit {100 * limit:g} %)")
    if share > UNCONVERGED_DOUBT:
        found.append(f"the forces had not settled in {100 * share:.2g} % of the steps")
    if quality.step_error is not None and quality.step_error > LEVEL_DOUBT:
        found.append(f"half the step changes the level itself ({quality.step_error:.2g} times the signal)")
    advice = "do not trust amplitudes; a higher sampling rate takes shorter steps"
    return tuple(f"DOUBTFUL RESULT: {text}; {advice}" for text in found)


def refuse_meaningless(system: System, quality: Quality) -> None:
    """Raise Meaningless where the figures of a run say that its numbers are none of the machine's."""
    residual, share, error = quality.energy.relative_residual, unconverged_share(quality), quality.step_error
    why = []
    if not residual <= ENERGY_LOST and not (error is not None and error <= STEP_SOUND):
        why.append(f"{100 * residual:.3g} % of the energy put through is unaccounted for")
    if share > UNCONVERGED_SHARE:
        why.append(f"the forces had not settled in {100 * share:.3g} % of {quality.steps} steps")
    if error is not None and not error <= LEVEL_LOST:
        why.append(f"half the step changes the result by {error:.3g} times its level")
    if why:
        raise Meaningless(reasons=tuple(why), advice=_advice(system, quality.step_s))


def _advice(system: System, step_s: float) -> str:
    """Who is too stiff for the step, and what to change."""
    steepest = [(_steepness(system, e, step_s), e.name) for e in system.elements if not e.stiff]
    factor, name = max(steepest, default=(0.0, ""))
    change = "more steps per output sample (a higher rate), a smaller stiffness or a wider transition may do"
    if factor < 1.0:
        return f"no single force stands out; {change}"
    law = _custom(name)
    part = f"custom law {law!r} ({name})" if law else name
    if law:
        change = "let the force rise over a longer way or a higher speed, or make it smaller"
    return f"{part} is too steep: its force answers a motion {factor:.2g} times within a step; {change}"


def _custom(name: str) -> str:
    _, found, law = name.partition(".custom.")
    return law if found else ""


def _steepness(system: System, element: Element, step_s: float) -> float:
    """Largest change of force that a change of force causes within a step, by slopes about rest.

    Slope times the motion a force makes in a step h: h^2 / 2 m for a displacement, h / m for a velocity.
    """
    place = {name: i for i, name in enumerate(system.dofs)}
    bench, h = Bench(system=system, element=element), step_s
    row, rest = bench.row(0.0), bench.zeros()
    worst = 0.0
    for k in range(element.forces):
        weights = element.coordinates[k].weights
        mobility = sum(weight**2 / system.mass[place[dof]] for dof, weight in weights)
        unit = np.eye(element.size)[k]
        for probe in PROBES_M:
            slope = _slope(bench, row, k, (rest, unit), probe, rate=False)
            worst = max(worst, slope * mobility * 0.5 * h * h)
        for probe in PROBES_M_PER_S:
            worst = max(worst, _slope(bench, row, k, (rest, unit), probe, rate=True) * mobility * h)
    return worst


def _slope(
    bench: Bench, row: FloatArray, k: int, along: tuple[FloatArray, FloatArray], probe: float, *, rate: bool
) -> float:
    rest, unit = along
    ends = []
    for sign in (1.0, -1.0):
        moved = rest + sign * probe * unit
        ends.append(bench.force(row, rest, moved)[k] if rate else bench.force(row, moved)[k])
    slope = abs(ends[0] - ends[1]) / (2.0 * probe)
    return float(slope) if np.isfinite(slope) else float("inf")
