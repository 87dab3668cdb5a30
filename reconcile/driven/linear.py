"""What a linear model of one mass may lack without any law being missing: that it varies, or a second resonance."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import asdict, dataclass, replace

import numpy as np

from reconcile.driven.channels import FloatArray
from reconcile.driven.forced import Analysis, gain_interval
from reconcile.driven.measured import Look
from reconcile.driven.model import nrmse, ready
from reconcile.driven.noise import Noise
from reconcile.driven.nominate import squares_in_blocks
from reconcile.driven.second import Second, second
from reconcile.driven.varying import ALPHA, Varying, varying
from reconcile.shares import two_digits
from reconcile.verdict import HeldOut

MOST_BEYOND = 0.3
"""Share of the error's power that no noise accounts for, from which it is no noise."""
SAME_PLACE = 0.05
"""Over the frequency: a second resonance of the baseline that near is the same."""
WORDS = {
    "stiffness": "The stiffness of {site} varies while it is recorded",
    "damping": "The damping of {site} varies while it is recorded",
    "force_gain": "The force on {site} over what its channel shows varies while it is recorded",
}


@dataclass(frozen=True, kw_only=True)
class Told:
    """What was found, for the report; `{site}` in the sentence is the body."""

    sentence: str
    undecidable: tuple[str, ...]
    asked: str
    stage: Mapping[str, object]
    held_out: HeldOut | None = None
    left: tuple[FloatArray, FloatArray] | None = None
    """What one and two resonances leave of the held-out part, (n - skip,) each, to be drawn."""
    known: str = ""
    """The sentence where a baseline shows the same: then it is nothing that came."""


def found_out(found: Analysis, noise: Noise, seed: int, least: float, baselines: Sequence[Look] = ()) -> Told | None:
    """The better of a variation and a second resonance, if it explains the `least` share of what is beyond noise.

    What follows the force is no noise, wherever it stands.
    """
    run, held, model = found.fitted_run, found.held_run, found.linear.model
    rng = np.random.default_rng([seed, 23])
    two = second(model, run, held)
    resounds = two is not None and two.share >= least * max(two.follows, noise.beyond)
    one = varying(model, run, found.linear.error, rng) if noise.beyond >= MOST_BEYOND else None
    varies = one is not None and one.p_value <= ALPHA and one.share >= least * noise.beyond
    if one is not None and varies and (two is None or not resounds or one.share > two.share):
        return _varying(found, one)
    if two is None or not resounds:
        return None
    told = _second(found, two, noise, rng)
    return replace(told, known=_known(two)) if any(_alike(two, one, least) for one in baselines) else told


def _alike(two: Second, one: Look, least: float) -> bool:
    """Whether a baseline shows the same second resonance."""
    run = ready(one.data, one.model.memory_s)
    before = second(one.model, run, run)
    if before is None or before.share < least * before.follows:
        return False
    return abs(math.log(before.second_hz / two.second_hz)) < SAME_PLACE


def _known(two: Second) -> str:
    return (
        f"Nothing is missing that the baseline does not lack too: both have a second resonance, at {two.second_hz:.4g} "
        f"Hz beside {two.first_hz:.4g} Hz"
    )


def _varying(found: Analysis, one: Varying) -> Told:
    data = found.fitted_run.data
    seconds = data.answer.size * data.step_s
    how = f"by {two_digits(one.size)} either way at {one.hz:.4g} Hz"
    if one.hz == 0.0:
        how = f"it drifts by some {two_digits(one.size)} within {seconds:.3g} s"
    said = (
        f"{WORDS[one.kind]}: {how}. That explains {two_digits(one.share)} of what a linear model leaves "
        f"({two_digits(found.fitted_nrmse)} of the output); no law of the motion does."
    )
    return Told(
        sentence=said,
        undecidable=("what makes it vary: nothing that turns, heats or wears beside the mass was recorded",),
        asked="Record speed, position or temperature of what moves beside it too: what has this course makes it vary."
        if one.hz
        else "Record longer, with the temperature: whether it goes on, comes back or settles tells wear from warmth.",
        stage={"stage": "varies", **asdict(one)},
    )


def _second(found: Analysis, two: Second, noise: Noise, rng: np.random.Generator) -> Told:
    before, after = (nrmse(x, found.held_run.compared) for x in (two.before, two.after))
    gain, low, high = gain_interval(squares_in_blocks(two.before), squares_in_blocks(two.after), rng)
    held = "the part that was held out" if not found.validations else found.validations[0].held
    said = (
        f"The motion of {{site}} follows the force linearly, but with a second resonance: beside {two.first_hz:.4g} Hz "
        f"one at {two.second_hz:.4g} Hz (damping ratio {two.damping_ratio:.2g}). With both {two_digits(after)} of the "
        f"output is left on {held}, with one {two_digits(before)}; a second mass on a spring is missing."
    )
    return Told(
        sentence=said,
        undecidable=("where the second mass hangs: one motion does not tell",),
        asked="Measure the motion of the parts beside it and of what it stands on: where this line is strongest is it.",
        stage={
            "stage": "second_resonance",
            "first_hz": two.first_hz,
            "second_hz": two.second_hz,
            "damping_ratio": two.damping_ratio,
            "follows_the_force": two.follows,
            "share": two.share,
            "noise_known": noise.known,
        },
        held_out=HeldOut(
            metric="free-run NRMSE", unit="1", before=before, after=after, gain=gain, gain_low=low, gain_high=high,
            retuned=None, black_box=None, placebo=None, held=held,
        ),
        left=(two.before, two.after),
    )  # fmt: skip
