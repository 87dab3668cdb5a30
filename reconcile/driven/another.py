"""The report where the oscillator is not the baseline's: its numbers, and what they explain on held-out data."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from reconcile.driven.changed import Change, changes, one_factor
from reconcile.driven.forced import Analysis, gain_interval
from reconcile.driven.machine import Site
from reconcile.driven.measured import Look
from reconcile.driven.model import errors, nrmse
from reconcile.driven.nominate import score_nats, squares_in_blocks
from reconcile.driven.pictures import redrawn
from reconcile.verdict import Cause, HeldOut, NextExperiment, PlaceWeight, Report, Severity

ONE_FACTOR_OPEN = "whether mass and spring changed alike, or the sensitivity of force or motion: both look the same"
WEIGH = NextExperiment(sentence="Check force and motion with a known mass or spring.")


def beside_baseline(
    report: Report, found: Analysis, tests: Sequence[Look], baselines: Sequence[Look], site: Site, seed: int
) -> Report:
    """The report with the oscillator held against the baseline's; the answer where nothing else is missing."""
    quiet = report.verdict == "nothing_missing"
    if not baselines or not (quiet or report.verdict == "explained"):
        return report
    changed = changes(tests, baselines, site, None if quiet else found.final)
    stage = {"stage": "baseline", "changed": {c.name: [c.before.value, c.after.value] for c in changed}}
    report = replace(report, stages=(*report.stages, stage))
    if not changed:
        return report
    told = "; ".join(c.told() for c in changed)
    if not quiet:
        said = f"Beside the law the oscillator is not the baseline's: {told}."
        return replace(report, undecidable=(*report.undecidable, said))
    return _answer(report, found, baselines[0], changed, told, site, seed)


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
        f"{_percent(left[0])} of the part held out, with its own {_percent(left[1])}; nothing else is missing."
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


def _percent(share: float) -> str:
    return f"{100 * share:.2g} %" if share < 0.995 else f"{100 * share:.0f} %"
