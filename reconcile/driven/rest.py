"""What stays unexplained where no law is named: nothing is missing only if noise that is known apart explains it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, replace

import numpy as np

from reconcile.driven.added import Tone, distinct, tone_words
from reconcile.driven.channels import Driven, FloatArray
from reconcile.driven.forced import Analysis
from reconcile.driven.judge import ROUGH
from reconcile.driven.linear import MOST_BEYOND, Told, found_out
from reconcile.driven.measured import Look
from reconcile.driven.noise import Noise, power_lines
from reconcile.driven.pictures import redrawn
from reconcile.shares import two_digits
from reconcile.verdict import NextExperiment, PlaceWeight, Report

OVER_BASELINE, LEAST = 2.0, 0.01
"""What is left over what a baseline leaves, and at least of the output, from which it is no noise."""
LEAST_SHARE, LEAST_SHARE_BESIDE = 0.5, 0.7
"""Share of what is beyond the noise that a variation or a second resonance must explain to be told; the second where
smooth laws see a force that none of them describes."""
OTHERS = ("varies", "second_resonance")
"""Stages of what was found instead of noise."""
BAND = 0.1
"""Share of the error's power outside of the band that is told, at either end."""


def unexplained(noise: Noise) -> bool:
    """Whether too much is left for noise."""
    if noise.beyond < MOST_BEYOND:
        return False
    return noise.unexplained > ROUGH or grown(noise)


def grown(noise: Noise) -> bool:
    """Whether clearly more is left than of a baseline."""
    rested = noise.baseline
    return rested is not None and noise.left > max(OVER_BASELINE * rested, LEAST)


def band_hz(error: FloatArray, step_s: float) -> tuple[float, float]:
    """Where most of an error's power stands."""
    total = np.cumsum(power_lines(error))
    low, high = np.searchsorted(total, [BAND * total[-1], (1.0 - BAND) * total[-1]])
    hz = 1.0 / (error.size * step_s)
    return float(low * hz), float(high * hz)


def known_words(noise: Noise) -> str:
    """What tells of noise, and how much."""
    said = [f"as much noise within the band as beside it leaves {two_digits(noise.motion)}"]
    if noise.force > 0.1 * noise.known:
        said.append(f"noise on the force {two_digits(noise.force)}")
    if noise.baseline is not None:
        said.append(f"the baseline leaves {two_digits(noise.baseline)}")
    return ", ".join(said)


def settled(
    report: Report, found: Analysis, noise: Noise, site: str, seed: int, baselines: Sequence[Look] = ()
) -> Report:
    """The report of a linear model that no law adds to, with what it leaves held against the noise."""
    report = replace(report, stages=(*report.stages, {"stage": "noise", **asdict(noise), "beyond": noise.beyond}))
    nothing = report.verdict == "nothing_missing"
    if not nothing and (report.verdict != "unknown_physics" or found.final.model.laws):
        return report
    if noise.left > LEAST:
        told = found_out(found, noise, seed, LEAST_SHARE if nothing else LEAST_SHARE_BESIDE, baselines)
        if told is not None and told.known and nothing:
            said = f"{told.known}; a linear model of one mass leaves {two_digits(noise.left)} of the output."
            return replace(report, sentence=said, undecidable=(*report.undecidable, *told.undecidable))
        if told is not None:
            return _told(report, found, told, site)
    if not nothing:
        return report
    return _open(report, found, noise, site) if unexplained(noise) else _noisy(report, noise)


def _told(report: Report, found: Analysis, told: Told, site: str) -> Report:
    """The report with what explains it."""
    drawn = report.pictures if told.left is None else redrawn(report.pictures, found, *told.left)
    return replace(
        report,
        verdict="unknown_physics",
        sentence=told.sentence.format(site=site),
        where=replace(report.where, sites=(PlaceWeight(site=site, weight=1.0),)),
        held_out=told.held_out or report.held_out,
        machine=None,
        undecidable=(*report.undecidable, *told.undecidable),
        next_experiment=NextExperiment(sentence=told.asked),
        stages=(*report.stages, told.stage),
        pictures=drawn,
    )


def _open(report: Report, found: Analysis, noise: Noise, site: str) -> Report:
    """The report of a linear model that leaves more than noise, and nothing tells what."""
    low, high = band_hz(found.linear.error, found.fitted_run.data.step_s)
    share = two_digits(noise.left)
    left = f"A linear model of {site} leaves {share} of the output, mostly from {low:.3g} to {high:.3g} Hz"
    new = grown(noise)
    said = f"{left}, and that is more than noise ({known_words(noise)}); no law that is tried explains it."
    asked = (
        "Record with the force off: what moves then is noise or another force. If nothing does, record twice with the "
        "same force and once with half of it: what does not repeat is no law of the motion."
    )
    open_one = () if new else ("whether a force is missing or the noise has this spectrum",)
    return replace(
        report,
        verdict="unknown_physics" if new else "not_decidable",
        sentence=said,
        where=replace(report.where, sites=(PlaceWeight(site=site, weight=1.0),) if new else ()),
        machine=report.machine if new else None,
        undecidable=(*report.undecidable, *open_one),
        next_experiment=NextExperiment(sentence=asked),
    )


def _noisy(report: Report, noise: Noise) -> Report:
    """The limit that large noise sets to "nothing missing"."""
    if noise.left < ROUGH:
        return report
    limit = (
        f"Noise holds {two_digits(noise.left)} of the output ({known_words(noise)}): what would move the mass by "
        "clearly less stays unseen."
    )
    return replace(report, where=replace(report.where, limits=(*report.where.limits, limit)))


def beside_tones(report: Report, tones: Sequence[tuple[str, Tone]], data: Driven, site: str, noise: Noise) -> Report:
    """The report with lines that the measured force does not make, taken off before: the answer unless a cause is
    told, or more is left than they make."""
    if not tones:
        return report
    unit = data.answer_channel.unit
    named = {tone: recording for recording, tone in reversed(tones)}
    kept = distinct(list(named))
    told = ", ".join(f"{tone_words(tone, unit)} in {named[tone]}" for tone in kept)
    said = f"A force that was not measured acts on {site}, or a line is on its motion alone: {told}"
    open_one = f"whether the line is a force on {site} or the sensor's alone: with the force off both stay"
    told_else = any(c.named for c in report.causes) or any(s.get("stage") in OTHERS for s in report.stages)
    if told_else or max(tone.share for tone in kept) < noise.left:
        said = f"{said}; it is taken off before the rest."
        return replace(report, undecidable=(*report.undecidable, said, open_one))
    rest = "Apart from it the linear model explains the recordings up to noise."
    return replace(
        report,
        verdict="unknown_physics",
        sentence=f"{said}. {rest if report.verdict == 'nothing_missing' else report.sentence}",
        where=replace(report.where, sites=(PlaceWeight(site=site, weight=1.0),)),
        undecidable=(*report.undecidable, open_one),
        next_experiment=NextExperiment(
            sentence="Look for a machine that runs at this frequency and record with it off, or measure its force too."
        ),
    )
