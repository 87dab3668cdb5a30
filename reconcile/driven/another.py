"""The report where the oscillator is not the baseline's: its numbers, and what they explain on held-out data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.driven.aside import aside
from reconcile.driven.changed import Change, changes, one_factor
from reconcile.driven.forced import ALPHA, Analysis, calibrate, gain_interval
from reconcile.driven.judge import ROUGH
from reconcile.driven.machine import Site
from reconcile.driven.measured import Look
from reconcile.driven.missing import anything_missing
from reconcile.driven.model import errors, nrmse
from reconcile.driven.nominate import score_nats, squares_in_blocks
from reconcile.driven.pictures import redrawn
from reconcile.driven.split import Part
from reconcile.shares import two_digits
from reconcile.verdict import Cause, HeldOut, NextExperiment, PlaceWeight, Report, Severity

ONE_FACTOR_OPEN = "whether mass and spring changed alike, or the sensitivity of force or motion: both look the same"
WEIGH = NextExperiment(sentence="Check force and motion with a known mass or spring.")

LESS_SOUND = 3.0
"""How many times more than of the tests a linear model leaves of a baseline that shows more than they do."""


def beside_baseline(
    report: Report, found: Analysis, tests: Sequence[Look], baselines: Sequence[Look], site: Site, seed: int
) -> Report:
    """The report with the oscillator held against the baseline's; the answer where nothing else is missing."""
    quiet = report.verdict == "nothing_missing"
    if not baselines or not (quiet or report.verdict == "explained"):
        return report
    if quiet:
        worst = max(baselines, key=lambda one: one.left)
        if worst.left > max(LESS_SOUND * found.fitted_nrmse, ROUGH) and _lacks(worst, seed):
            return _turned(report, worst.left, found.fitted_nrmse, site.body.name)
    changed = changes(tests, baselines, site, None if quiet else found.final)
    if not quiet and aside(found) is not None:  # its linear part is not the spring about rest
        changed = tuple(c for c in changed if c.key != "stiffness")
    stage = {"stage": "baseline", "changed": {c.name: [c.before.value, c.after.value] for c in changed}}
    report = replace(report, stages=(*report.stages, stage))
    if not changed:
        return report
    told = "; ".join(c.told() for c in changed)
    if not quiet:
        said = f"Beside the law the oscillator is not the baseline's: {told}."
        return replace(report, undecidable=(*report.undecidable, said))
    return _answer(report, found, baselines[0], changed, told, site, seed)


def _lacks(one: Look, seed: int) -> bool:
    """Whether a law of the motion explains of a recording what a linear model leaves: noise it does not."""
    start = calibrate(Part(name="", data=one.data))
    rng = np.random.default_rng([seed, 31])
    return anything_missing(start.linear.model, start.run, start.linear.error, rng).p_value < ALPHA


def _turned(report: Report, baseline: float, test: float, name: str) -> Report:
    """Nothing is said where the baseline shows a force beyond linear that the tests do not have."""
    said = (
        f"Not decidable: a linear model of {name} leaves {two_digits(baseline)} of the baseline, in which "
        f"a force beyond linear is missing, and {two_digits(test)} of the tests: they may be exchanged, or a part "
        "replaced."
    )
    return replace(
        report,
        verdict="not_decidable",
        sentence=said,
        machine=None,
        undecidable=(*report.undecidable, "which of the recordings are of the sound machine"),
        next_experiment=NextExperiment(
            sentence="Check which recording is which; reconcile the baseline as a test to see what it shows."
        ),
    )


def _answer(
    report: Report, found: Analysis, baseline: Look, changed: Sequence[Change], told: str, site: Site, seed: int
) -> Report:
    open_one = one_factor(changed)
    before, after = errors(baseline.model, found.held_run), errors(found.linear.model, found.held_run)
    squares = [squares_in_blocks(e) for e in (before, after)]
    gain, low, high = gain_interval(squares[0], squares[1], np.random.default_rng([seed, 29]))
    left = [nrmse(e, found.held_run.compared) for e in (before, after)]
    score = score_nats(squares[0], squares[1])[0]
    name = site.body.name
    said = (
        f"The oscillator is not the baseline's: {told}. With the baseline's numbers a linear model leaves "
        f"{two_digits(left[0])} of the part held out, with its own {two_digits(left[1])}; nothing else is missing."
    )
    causes = tuple(
        Cause(
            term=c.key,
            site=name,
            score=score,
            severity=Severity(name=c.words, value=c.after.value, unit=c.unit, low=c.after.low, high=c.after.high),
            named=not open_one,
            reasons=(ONE_FACTOR_OPEN,) if open_one else (f"{c.words}: other than in the baseline",),
            values={"baseline": c.before.value, "test": c.after.value},
        )
        for c in sorted(changed, key=lambda c: -abs(c.ratio - 1.0))
    )
    return replace(
        report,
        verdict="ambiguous" if open_one else "explained",
        sentence=said,
        where=replace(report.where, sites=(PlaceWeight(site=name, weight=1.0),)),
        causes=causes,
        held_out=HeldOut(
            metric="free-run NRMSE", unit="1", before=left[0], after=left[1], gain=gain, gain_low=low, gain_high=high,
            retuned=None, black_box=None, placebo=None, held="a recording that the numbers were not fitted to",
        ),
        undecidable=(*report.undecidable, *((ONE_FACTOR_OPEN,) if open_one else ())),
        next_experiment=WEIGH if open_one else None,
        pictures=redrawn(report.pictures, found, before, after),
    )  # fmt: skip
