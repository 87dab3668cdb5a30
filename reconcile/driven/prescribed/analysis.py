"""Steps for a prescribed motion: calibrate, test, try structures, choose, validate on a run that was never fitted."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize_scalar

from reconcile.driven.channels import FloatArray
from reconcile.driven.missing import Missing, score_test
from reconcile.driven.nominate import LEAST_GAIN, leads, squares_in_blocks
from reconcile.driven.prescribed.fitting import Resisting, fit_resistance
from reconcile.driven.prescribed.resistance import (
    CUBIC,
    DRAG,
    HOLDS,
    LINEAR,
    NONE,
    PLAY,
    STRUCTURES,
    Motion,
    Structure,
    path_force,
)
from reconcile.driven.prescribed.reversals import Travel, backlash_travel
from reconcile.driven.prescribed.rich import Beside, Rich, beside_law
from reconcile.driven.prescribed.runs import Setup, beyond_noise, setups
from reconcile.driven.prescribed.soft import Widths, allowed_widths
from reconcile.driven.split import Part, order_of_use

ALIKE = 0.25
"""Friction levels that differ by more do not transfer: one number is then taken from the held-out run."""
FRACTIONS = (0.05, 0.15, 0.4)
WIDER = 0.2
"""Fall of the mean square error on the runs held out from which a wider form of a law is a rival of its own."""


@dataclass(frozen=True, kw_only=True)
class Outcome:
    """NRMSE of the force on a held-out run: as predicted, and with one factor taken from the run's first third."""

    fitted_on: str
    held: str
    linear: tuple[float, float]
    chosen: tuple[float, float]
    retuned: float
    black_box: tuple[float, float]
    placebo: tuple[float, float]
    level: float
    """Friction of the held-out run (its first third) over that of the fitted one."""
    squares: tuple[FloatArray, FloatArray]
    """Linear and chosen, in blocks, as `transfers` says."""
    before: FloatArray
    """Linear prediction of the run that was scored, N, (n,)."""
    used: Resisting
    """The chosen structure as it was scored: with the fitted friction level where that transfers."""

    @property
    def transfers(self) -> bool:
        """Whether the friction level is the fitted run's, so that the prediction needs nothing of the held-out run."""
        return abs(self.level - 1.0) <= ALIKE


@dataclass(frozen=True, kw_only=True)
class Findings:
    """Everything that was found."""

    fitted: Setup
    held: Setup
    linear: Resisting
    trials: tuple[tuple[Resisting, FloatArray], ...]
    """Structures with their squared error in blocks of the choosing stretch, the chosen first, then the best."""
    as_good: tuple[Structure, ...]
    """Structures that the best does not lead, the chosen among them."""
    rival: Structure | None
    """One of them that is no wider form of the chosen one, and that the runs held out do not part from it either."""
    rich: Rich
    """Of the fitted run."""
    beyond: float
    """Share of the linear error's power that no noise has, as `beyond_noise` says."""
    besides: tuple[tuple[str, Beside], ...]
    """What signals of the motion foretell of what the chosen law leaves, by the run."""
    widths: Widths | None
    """Play that a soft start of the friction allows, where play was chosen."""
    linear_squares: FloatArray
    chosen: Resisting
    missing: Missing
    travel: Travel | None
    outcomes: tuple[Outcome, ...]


def _causes(motion: Motion) -> FloatArray:
    """Signals of the test: paths of several stretches, and drag."""
    size = float(np.max(np.abs(motion.displacement)))
    base = {"friction": 1.0, "asymmetry": 0.0}
    paths = [path_force(base | {"elastic": 1.0 / (f * size)}, motion) for f in FRACTIONS]
    return np.column_stack([*paths, motion.velocity * np.abs(motion.velocity), motion.displacement**3])


def _polynomial(run: Setup, parameters: int) -> tuple[list[int], FloatArray, FloatArray]:
    """Black box without memory: forward selection of products of x and v up to degree 5."""
    scale = np.array([np.std(run.motion.displacement), np.std(run.motion.velocity)])
    columns = _products(run.motion, scale)
    rest, kept = run.force.copy(), list[int]()
    for _ in range(parameters):
        frame = np.linalg.qr(columns[:, kept])[0] if kept else np.zeros((rest.size, 0))
        rest = run.force - frame @ (frame.T @ run.force)
        free = columns - frame @ (frame.T @ columns)
        merit = (free.T @ rest) ** 2 / np.maximum(np.sum(free**2, axis=0), 1e-9 * np.sum(columns**2, axis=0))
        merit[kept] = -1.0
        kept.append(int(np.argmax(merit)))
    solution = np.linalg.lstsq(columns[:, kept], run.force, rcond=None)[0]
    return kept, np.asarray(solution, dtype=np.float64), np.asarray(scale, dtype=np.float64)


def _products(motion: Motion, scale: FloatArray) -> FloatArray:
    x, v = motion.displacement / scale[0], motion.velocity / scale[1]
    return np.column_stack([x**i * v**j for i in range(6) for j in range(6 - i)])


def _late(run: Setup, error: FloatArray) -> float:
    """NRMSE over the last two thirds of a run."""
    late = slice(run.force.size // 3, None)
    return float(np.sqrt(np.mean(error[late] ** 2)) / run.force[late].std())


def _scaled(run: Setup, predicted: FloatArray) -> tuple[float, float, float]:
    """NRMSE as predicted, with a factor from the first third, and the factor."""
    early = slice(run.skip, max(run.force.size // 3, run.skip + 1))
    factor = float(run.force[early] @ predicted[early]) / max(float(predicted[early] @ predicted[early]), 1e-300)
    return _late(run, run.force - predicted), _late(run, run.force - factor * predicted), factor


def _levelled(chosen: Resisting, held: Setup) -> tuple[Resisting, float]:
    """The chosen structure with the friction level of the run's first third, and that level over the fitted one."""
    if "friction" not in chosen.values:
        return chosen, 1.0
    stretch = slice(held.skip, max(held.force.size // 3, held.skip + 1))

    def at(log_factor: float) -> Resisting:
        values = {**chosen.values, "friction": chosen.values["friction"] * float(np.exp(log_factor))}
        return replace(chosen, values=values)

    def error(log_factor: float) -> float:
        return float(np.sum((held.force - at(log_factor).on(held.motion))[stretch] ** 2))

    grid = np.linspace(-2.5, 2.5, 26)
    near = grid[int(np.argmin([error(g) for g in grid]))]
    found = minimize_scalar(error, bounds=(near - 0.2, near + 0.2), method="bounded", options={"xatol": 1e-3})
    return at(float(found.x)), float(np.exp(found.x))


def outcome(fitted: Setup, held: Setup, linear: Resisting, chosen: Resisting, rng: np.random.Generator) -> Outcome:
    """Score the chosen structure and its rivals on a run none of them saw."""
    kept, solution, scale = _polynomial(fitted, len(chosen.values))
    boxed = _products(held.motion, scale)[:, kept] @ solution
    levelled, level = _levelled(chosen, held)
    plain, adapted = chosen.on(held.motion), levelled.on(held.motion)
    wrong = fit_resistance(CUBIC if chosen.structure == DRAG else DRAG, fitted.motion, fitted.force, fitted.skip).on(
        held.motion
    )
    shifted = np.roll(plain, int(rng.integers(held.force.size // 4, 3 * held.force.size // 4)))
    line = linear.on(held.motion)
    told_line, told_box = _scaled(held, line), _scaled(held, boxed)
    placebos = [_scaled(held, f) for f in (wrong, shifted)]
    own = fit_resistance(NONE, held.motion, held.force, held.skip)
    third = held.force.size // 3
    adapts = abs(level - 1.0) > ALIKE
    before = held.force - (told_line[2] if adapts else 1.0) * line
    after = held.force - (adapted if adapts else plain)
    return Outcome(
        fitted_on=fitted.name,
        held=held.name,
        linear=told_line[:2],
        chosen=(_late(held, held.force - plain), _late(held, held.force - adapted)),
        retuned=_late(held, own.error),
        black_box=told_box[:2],
        placebo=(min(p[0] for p in placebos), min(p[1] for p in placebos)),
        level=level,
        squares=(squares_in_blocks(before[third:]), squares_in_blocks(after[third:])),
        before=held.force - before,
        used=levelled if adapts else chosen,
    )


def _as_good(trials: Sequence[tuple[Resisting, FloatArray]]) -> tuple[Structure, ...]:
    """Structures that the best does not lead, or not by what is worth another number; the simplest first."""
    _, best = min(trials, key=lambda pair: float(pair[1].mean()))
    worth = float(best.mean()) / (1.0 - LEAST_GAIN)
    return tuple(t.structure for t, squares in trials if float(squares.mean()) <= worth or not leads(squares, best))


def _rival(
    as_good: Sequence[Structure], chosen: Resisting, back: Resisting, runs: tuple[Setup, Setup]
) -> Structure | None:
    """A structure as good as the chosen one on the stretch kept for choosing and on both runs, each held out once."""
    fitted, held = runs

    def squares(on_fitted: Resisting, on_held: Resisting) -> FloatArray:
        errors = (held.force - on_fitted.on(held.motion), fitted.force - on_held.on(fitted.motion))
        sizes = [float(r.force.std()) or 1.0 for r in (held, fitted)]
        return np.concatenate([squares_in_blocks(e / s) for e, s in zip(errors, sizes, strict=True)])

    ours = squares(chosen, back)
    for other in as_good:
        if other == chosen.structure:
            continue
        on_fitted, on_held = (fit_resistance(other, r.motion, r.force, r.skip) for r in runs)
        theirs = squares(on_fitted, on_held)
        wider = chosen.structure.key in HOLDS.get(other.key, ())
        if not leads(theirs, ours) and not (wider and theirs.mean() > (1.0 - WIDER) * ours.mean()):
            return other
    return None


def investigate(parts: Sequence[Part], seed: int) -> Findings:
    """All steps."""
    rng = np.random.default_rng([seed, 3])
    fit_part, held_part = order_of_use(parts)
    fitted, held, told = setups(fit_part, held_part)
    cut = fitted.cut
    first = fitted.part(0, cut)

    def squares(found: Resisting) -> FloatArray:
        return squares_in_blocks((fitted.force - found.on(fitted.motion))[cut:])

    tried = [fit_resistance(s, first.motion, first.force, first.skip) for s in STRUCTURES]
    scored = [(t, squares(t)) for t in tried]
    as_good = _as_good(scored)
    trials = sorted(scored, key=lambda pair: (pair[0].structure != as_good[0], float(pair[1].mean())))
    early = fit_resistance(NONE, first.motion, first.force, first.skip)
    linear = fit_resistance(NONE, fitted.motion, fitted.force, fitted.skip)
    chosen = fit_resistance(as_good[0], fitted.motion, fitted.force, fitted.skip)
    skip = fitted.skip
    x, v = fitted.motion.displacement[skip:], fitted.motion.velocity[skip:]
    retuning = np.column_stack([x, v, np.ones(x.size)])
    missing = score_test(linear.error[skip:], retuning, _causes(fitted.motion)[skip:], rng)
    back_linear = fit_resistance(NONE, held.motion, held.force, held.skip)
    back = fit_resistance(chosen.structure, held.motion, held.force, held.skip)
    outcomes = (
        outcome(fitted, held, linear, chosen, rng),
        outcome(held, fitted, back_linear, back, rng),
    )
    used = ((fitted, chosen), (held, outcomes[0].used))
    widths = None
    if chosen.structure == PLAY:
        widths = allowed_widths(fitted.motion, fitted.force, skip, chosen.values["asymmetry"])
    return Findings(
        fitted=fitted,
        held=held,
        linear=linear,
        trials=tuple(trials),
        as_good=as_good,
        rival=_rival(as_good, chosen, back, (fitted, held)),
        rich=told,
        beyond=beyond_noise(linear.error[skip:]),
        besides=tuple((r.name, beside_law(r.motion, r.force, law.on(r.motion), r.skip)) for r, law in used),
        widths=widths,
        linear_squares=squares(early),
        chosen=chosen,
        missing=missing,
        travel=_travel(fitted, chosen, rng),
        outcomes=outcomes,
    )


def _travel(run: Setup, chosen: Resisting, rng: np.random.Generator) -> Travel | None:
    """Travel after reversals, of the force without what the law has beside its path; None where it has no path."""
    if "elastic" not in chosen.values:
        return None
    beside = replace(chosen, structure=NONE, values={k: chosen.values[k] for k in LINEAR})
    return backlash_travel(run.motion, run.force - beside.on(run.motion), rng)
