"""What is said of a prescribed motion: the sentence, sizes with their intervals, what is not decided."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from reconcile.driven.prescribed.analysis import Findings, Outcome
from reconcile.driven.prescribed.fitting import Resisting
from reconcile.driven.prescribed.reversals import SHARE
from reconcile.verdict import Word

SIZES = ("backlash", "friction", "drag", "cubic", "contact", "gap_up", "gap_down")
GAPS, SEEN = ("gap_up", "gap_down"), 10.0
"""Gaps, and how many amplitudes wide one is no more."""


def interval_of(found: Findings, shown: Resisting, name: str) -> tuple[float, float]:
    """90 % of the fit; of play also what a soft start of the friction allows."""
    low, high = shown.intervals[name]
    if name == "backlash" and found.widths is not None and shown is found.chosen:
        return min(low, found.widths.low_m), max(high, found.widths.high_m)
    return low, high


def sizes_of(found: Findings, shown: Resisting) -> list[str]:
    """Sizes of a law; not those of gaps that the motion never closed."""
    seen = SEEN * float(np.max(np.abs(found.fitted.motion.displacement)))
    return [n for n in SIZES if n in shown.values and not (n in GAPS and shown.values[n] > seen)]


def used_errors(o: Outcome) -> tuple[float, float, float, float]:
    """NRMSE of linear, chosen, black box, placebo: blind where friction transfers, else with one number each."""
    k = 0 if o.transfers else 1
    return o.linear[k], o.chosen[k], o.black_box[k], o.placebo[k]


def left_of(found: Findings) -> float:
    """Share of the force that the linear model leaves on the fitted run."""
    run = found.fitted
    return float(found.linear.error[run.skip :].std() / max(float(run.force[run.skip :].std()), 1e-300))


def nearer(found: Findings) -> tuple[str, ...]:
    """Structures whose error on the stretch kept for choosing is smaller than that of the simpler one which is told."""
    (_, own), *others = found.trials
    return tuple(t.structure.words for t, squares in others if float(squares.mean()) < float(own.mean()))


def sentence(found: Findings, verdict: Word, reasons: Sequence[str], site: str) -> str:
    """The answer in words."""
    values, words = found.chosen.values, found.chosen.structure.words
    if verdict == "nothing_missing":
        return f"A spring and damper explain the force on {site} up to noise."
    if verdict == "not_decidable":
        return (
            f"A spring and damper leave {100 * left_of(found):.0f} % of the force on {site}: more than its noise, and "
            "nothing that the motion foretells."
        )
    if verdict == "ambiguous" and found.rival is not None:
        return f"The force on {site} has a part that is {words} or {found.rival.words}."
    if verdict == "unknown_physics":
        o = found.outcomes[0]
        before, after, _, _ = used_errors(o)
        return (
            f"The force on {site} is more than a spring and damper, and no law that was tried is sure. "
            f"{'The simplest that comes as near as any is' if nearer(found) else 'Nearest comes'} {words} (error on "
            f"{o.held} {100 * after:.0f} %, with spring and damper {100 * before:.0f} %), but {reasons[0]}."
        )
    o = found.outcomes[0]
    before, after, _, _ = used_errors(o)
    said = f"What is missing at {site} is {words}"
    if "backlash" in values:
        low, high = (1e3 * x for x in interval_of(found, found.chosen, "backlash"))
        said += f": {1e3 * values['backlash']:.1f} mm of play (90 %: {low:.1f} to {high:.1f})"
    gaps = [n for n in sizes_of(found, found.chosen) if n in GAPS]
    if gaps:
        said += ": " + " and ".join(
            "{:.1f} mm ({:.1f} to {:.1f})".format(*(1e3 * x for x in (values[n], *found.chosen.intervals[n])))
            + (" upwards" if n == "gap_up" else " downwards")
            for n in gaps
        )
    if found.travel is not None:
        t = found.travel
        said += (
            f", and after a reversal {1e3 * t.mean_m:.1f} mm ({1e3 * t.low_m:.1f} to {1e3 * t.high_m:.1f}) pass until "
            f"{100 * SHARE:.0f} % of the sliding force"
        )
    return f"{said}; error of the force on {o.held} falls from {100 * before:.0f} % to {100 * after:.0f} %."


def undecided(found: Findings) -> tuple[str, ...]:
    """What the runs leave open."""
    said = []
    if any(not o.transfers for o in found.outcomes):
        levels = ", ".join(f"{o.held} {o.level:.2f} times {o.fitted_on}" for o in found.outcomes)
        said.append(
            f"The friction level does not transfer between the runs ({levels}): it is a setting, not the machine."
        )
    wider = nearer(found)
    if wider and found.rival is None:
        told = " and ".join(wider)
        said.append(
            f"Whether there is more to it: {told} left less on the stretch kept for "
            f"choosing than {found.chosen.structure.words}, which is simpler, but not surely less."
        )
    if "backlash" in found.chosen.values:
        said.append("Play and the spring behind it share the travel: a soft start of the spring counts as play.")
    return tuple(said)
