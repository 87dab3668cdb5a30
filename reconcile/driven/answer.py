"""The report of a driven analysis."""

from __future__ import annotations

from collections.abc import Mapping

from reconcile.driven.aside import seen_from_rest
from reconcile.driven.ceiling import Ceiling, ceilings
from reconcile.driven.channels import FloatArray
from reconcile.driven.forced import ALPHA, Analysis, Validation
from reconcile.driven.judge import BRANCHES, NOT_ALL, TOO_FEW, Judgement, judge, leaves_more, lost
from reconcile.driven.law_words import from_rest, law_words, product
from reconcile.driven.machine import driven_site, mass_kg, revised, term_key, weighed
from reconcile.driven.model import LINEAR
from reconcile.driven.nominate import Trial, score_nats
from reconcile.driven.pictures import Freed, freed_force, pictures, shown_stretch
from reconcile.force_law.library import GAPPED, Law, mirrored
from reconcile.shares import two_digits
from reconcile.verdict import (
    Cause,
    EstimatedForce,
    HeldOut,
    NextExperiment,
    PlaceWeight,
    Report,
    Severity,
    Where,
)
from sim.core.errors import SpecError
from sim.core.spec import MachineSpec

NO_MACHINE = "the numbers that fit are none of a mass on a spring that can be simulated"
SKEWED = (
    "Beside a gap a part of a sample between force and motion leaves as much (a sixteenth, at 15 samples a period: 3 "
    "to 10 % of the output instead of 0.6 to 3.5 %): check that the recorder reads both channels at once."
)
"""Measured on two made oscillators with stops."""
LED_RUN = "NRMSE of a run led by the output"
ACCELERATION = 2
"""Order of the motion's derivative."""
BY_DISPLACEMENT = (
    "Measure the displacement of the mass, or drive with half the amplitude: from an acceleration alone a strong "
    "spring or a stop may leave a free run too much at the mercy of its numbers to be named."
)
"""Of two made oscillators whose cubic spring left 76 % and whose stop left 67 % of the last third to a linear model,
both are named by displacement (0.14 % left), neither by acceleration (14 and 29 %), and both by it at half the force
(0.16 and 0.23 %)."""
NEAREST = 0.5
"""Least gain, by the low end of its interval, of a law that is told though it is not named."""
DIVERGED = "; the free run with the law diverges, errors and gain are bounds"


def _saturation(found: Analysis) -> tuple[str, ...]:
    """Ends at which the output stands, in the fitted or the held-out part."""
    data = (found.fitted_run.data, found.held_run.data)
    longest: dict[bool, Ceiling] = {}
    for c in (c for d in data for c in ceilings(d.answer)):
        if c.upper not in longest or c.samples > longest[c.upper].samples:
            longest[c.upper] = c
    return tuple(c.words(data[0].answer_channel.unit) for c in longest.values())


def _undecided(found: Analysis, judgement: Judgement, linear: str, site: str) -> str:
    if judgement.reasons == (TOO_FEW,):
        said = f"A linear model of {site} leaves {linear} of the output, and {TOO_FEW}"
        return "; ".join([said, *_saturation(found)]) + "."
    if judgement.reasons[0].startswith(NO_MACHINE):
        return f"Nothing is said of {site}: {judgement.reasons[0]}."
    if judgement.reasons[0] == BRANCHES:
        return f"A force on {site} is missing from the linear model, perhaps {law_words(found)}; {BRANCHES}."
    return f"The output does not follow the input: the best linear model of {site} leaves {linear} of it."


def _nearest(found: Analysis) -> tuple[str, ...]:
    """The law that comes nearest, where it is worth a word although it may not be named."""
    if not found.final.model.laws or not found.validations:
        return ()
    v = found.validations[0]
    if v.diverged or v.gain[1] < NEAREST:
        return ()
    left = f"{two_digits(v.after)} instead of {two_digits(v.before)}"
    return (f"the nearest that was tried, {law_words(found)}, leaves {left} on {v.held}",)


def _curve(found: Analysis, kind: str, site: str) -> str:
    """Where the laws are a curve through a force of another form."""
    v = found.validations[0]
    left = f"{two_digits(v.after)} instead of {two_digits(v.before)} on {v.held}"
    said = f"A {kind} force of this form is missing at {site}; it follows none of the known laws, alone or in a pair"
    return f"{said}. Its estimate is drawn, and laws that run through it as a curve leave {left}."


def _none(judgement: Judgement) -> str:
    """Why no law is named: none holds, or the one that does leaves more than noise."""
    if judgement.reasons == (NOT_ALL,):
        return "no law that is tried describes all of it: what the laws leave is not noise"
    return "no stable law describes it"


def _sentence(found: Analysis, judgement: Judgement, site: str) -> str:
    linear = two_digits(found.fitted_nrmse)
    if judgement.verdict == "nothing_missing":
        return f"A linear model of {site} explains the recording up to noise (free-run error {linear})."
    if judgement.verdict == "not_decidable":
        return _undecided(found, judgement, linear, site)
    if judgement.form and not any(v.diverged for v in found.validations):
        return _curve(found, judgement.form, site)
    if not found.final.model.laws or judgement.reasons:
        said = f"A force on {site} is missing from the linear model, and {_none(judgement)}"
        flown = [f"the free run on {v.held} with {law_words(found)} diverges" for v in found.validations if v.diverged]
        return "; ".join([said, *flown[:1], *_nearest(found), *_saturation(found)]) + "."
    v = found.validations[0]
    gained = (
        f"{'led' if v.led else 'free'}-run error on {v.held} falls from {two_digits(v.before)} to {two_digits(v.after)}"
    )
    if judgement.rivals:
        names = " or ".join([found.final.model.laws[0].words, *(t.laws[0].words for t in judgement.rivals)])
        return f"A force on {site} is missing: {names}; {gained}."
    aside = f", not all of it: {leaves_more(found)}" if lost(found) else ""
    return f"What is missing at {site} is {law_words(found)}; {gained}{aside}."


def _cause(found: Analysis, trial: Trial, index: int | None, site: str, mass: float, why: tuple[str, ...]) -> Cause:
    """A single law; `index` in the final model where it is part of it."""
    linear = found.nominated.linear if found.nominated is not None else trial
    score, _ = score_nats(linear.squares, trial.squares)
    law = trial.laws[-1] if index is None else found.final.model.laws[index]
    place = LINEAR if index is None else LINEAR + index
    source = trial.fitted if index is None else found.final
    weighs = weighed(source.model, found.held_run.data)
    value, low, high = ((1.0 if weighs else mass) * x for x in source.interval(place, per_gain=weighs))
    severity = Severity(name=law.key, value=value, unit=law.unit, low=low, high=high)
    values = {"coefficient": value} | ({"shape": law.shape} if law.shape else {})
    named = index is not None and not why
    return Cause(
        term=term_key(law), site=site, score=score, severity=severity, named=named, values=values,
        reasons=(*(why or ((law.words,) if named else (f"{law.words}: behind the best",))), *_same(law, value)),
    )  # fmt: skip


def _same(law: Law, value: float) -> tuple[str, ...]:
    """The law that no recording can tell from this one, its linear part being free."""
    twin = mirrored(law)
    if twin is None:
        return ()
    turned = f"{abs(value):.4g} N/m {'stiffer' if value > 0 else 'softer'}"
    return (f"the same motion: {product(-value, twin)} beside a linear spring {turned}",)


def _causes(found: Analysis, judgement: Judgement, site: str, mass: float) -> tuple[Cause, ...]:
    if found.nominated is None:
        return ()
    laws = found.final.model.laws
    why = judgement.reasons or (("others cannot be told from it",) if judgement.rivals else ())
    kept = [_cause(found, found.nominated.chosen, i, site, mass, why) for i in range(len(laws))]
    keys = {law.key for law in laws}
    others = [_cause(found, t, None, site, mass, ()) for t in found.nominated.singles if t.laws[0].key not in keys]
    return tuple(sorted([*kept, *others], key=lambda c: -c.score))


def _held_out(found: Analysis) -> HeldOut | None:
    if not found.validations:
        return None
    v = found.validations[0]
    return HeldOut(
        metric=LED_RUN if v.led else "free-run NRMSE", unit="1", before=v.before, after=v.after, gain=v.gain[0],
        gain_low=v.gain[1],
        gain_high=v.gain[2], retuned=v.retuned, black_box=v.black_box, placebo=v.placebo,
        held=f"{v.held}, fitted on {v.fitted_on}; it goes farther than what was fitted{DIVERGED if v.diverged else ''}",
    )  # fmt: skip


def _not_freely(v: Validation) -> str:
    """What a led run does not say."""
    left = two_digits(v.free or 0.0)
    return (
        f"Not predictable freely here: on {v.held} a free run with numbers from {v.fitted_on} leaves {left} of "
        f"the output, for it takes another branch of the motion; led by the output, which it forgets within two "
        f"periods, it leaves {two_digits(v.after)} (a linear model {two_digits(v.before)})."
    )


def _not_all(found: Analysis) -> tuple[str, ...]:
    """That the laws do not hold on the part held out as where they were fitted."""
    more = leaves_more(found)
    if not more:
        return ()
    mercy = "the free run is at the mercy of its numbers there, or " if found.unsure else ""
    return (f"Not all of it: {more}; {mercy}something else acts too, or a law of another form.",)


def _force(found: Analysis, freed: Freed, judgement: Judgement, site: str, mass: float) -> EstimatedForce:
    over, model = freed.over, found.final.model
    argument = "velocity_m_per_s" if freed.rate else "displacement_m"
    samples = {argument: over.argument, "force_n": over.force_n, "low_n": over.low_n, "high_n": over.high_n}
    stable = bool(model.laws) and not judgement.reasons
    named = dict(zip(model.laws, model.coefficients, strict=True))
    return EstimatedForce(
        site=site,
        samples={key: tuple(float(x) for x in values) for key, values in samples.items()},
        law=" + ".join(product(mass * c, law) for law, c in named.items()) if stable else None,
        coefficients={law.key: mass * c for law, c in named.items()} if stable else {},
    )


def _stages(found: Analysis, assumed: str) -> tuple[Mapping[str, object], ...]:
    linear, left = found.linear.model, found.left
    ranked = {law.key: share for law, _, share in reversed(found.found.ranked)}
    stages: list[Mapping[str, object]] = [
        {"stage": "observe", "input": found.held_run.data.drive_channel.name,
         "output": found.held_run.data.answer_channel.name, "assumed": assumed or "nothing"},
        {"stage": "calibrate", "natural_frequency_hz": linear.stiffness**0.5 / 6.283185307179586,
         "damping_ratio": 0.5 * linear.damping / linear.stiffness**0.5, "gain": linear.gain,
         "nrmse": found.fitted_nrmse},
        {"stage": "is_anything_missing", "statistic": found.missing.statistic, "null_95": found.missing.null_95,
         "p": found.missing.p_value},
        {"stage": "locate", "latent_force_law": found.found.text, "share_on_left_out_blocks": found.found.share,
         "exponent_of_latent_force": [found.exponent.value, found.exponent.low, found.exponent.high]},
        {"stage": "nominate", "share_of_the_latent_force": ranked, "tried": found.found.tried,
         "left_out_again": [law.words for law in found.dropped]},
    ]  # fmt: skip
    if found.power is not None:
        free = [found.power.value, found.power.low, found.power.high]
        stages.append({"stage": "fit", "exponent_by_free_run": free})
    if left is not None:
        stages.append({"stage": "adequacy", "share_of_the_error_still_explained": left.statistic, "p": left.p_value})
    for v in found.validations:
        said = {k: value for k, value in vars(v).items() if v.led or k not in ("led", "free")}
        stages.append({"stage": "validate", **said})
    return tuple(stages)


def _undecidable(found: Analysis, judgement: Judgement, assumed: str, calibrated: bool) -> tuple[str, ...]:
    said = []
    if not calibrated:
        said.append(
            "Without units of force and motion only ratios to the mass are known; one unit is read as 1 m, 1 N."
        )
    if found.left is not None and found.left.p_value < ALPHA:
        part = 100 * found.left.statistic
        said.append(
            f"What is left is not noise: other smooth laws explain {part:.0f} % of its whitened power, so something "
            "is missing besides, or is of another form."
        )
        if judgement.reasons == (NOT_ALL,) and any(law.key in GAPPED for law in found.final.model.laws):
            said.append(SKEWED)
    said += _saturation(found)
    if judgement.verdict == "not_decidable":
        said += judgement.reasons
    if judgement.verdict == "unknown_physics":
        said.append(f"No law is named: {'; '.join(judgement.reasons)}.")
    return (*said, assumed) if assumed else tuple(said)


def _next(judgement: Judgement, accelerated: bool) -> NextExperiment | None:
    """`accelerated`: a law stood nearest, and an acceleration is all that was measured of the motion."""
    if judgement.reasons == (TOO_FEW,):
        return NextExperiment(sentence="Record ten times as long, over the same band and amplitude.")
    if judgement.reasons[:1] == (BRANCHES,):
        return NextExperiment(sentence="Drive with half the amplitude, where the motion keeps to one branch.")
    if judgement.verdict == "not_decidable":
        text = "Check which channel is the force and which the motion, the cables, and that both were recorded at once."
        return NextExperiment(sentence=text)
    if judgement.verdict in ("ambiguous", "unknown_physics") or judgement.reasons:
        text = "Drive with about twice the amplitude over the same band: laws of different power then part."
        if accelerated and judgement.verdict == "unknown_physics":
            text = BY_DISPLACEMENT
        return NextExperiment(sentence=text)
    return None


def _revised(
    spec: MachineSpec, found: Analysis, judgement: Judgement, drive: FloatArray
) -> tuple[Mapping[str, object] | None, Judgement]:
    """The machine with the fitted numbers; where they make none, nothing is decided."""
    if judgement.verdict == "not_decidable":
        return None, judgement
    try:
        return revised(spec, found.published, found.held_run.data, drive).model_dump(mode="json"), judgement
    except SpecError as error:
        why = f"{NO_MACHINE}: {error.problems[0]}"
        return None, Judgement(verdict="not_decidable", reasons=(why,), rivals=())


def answer(spec: MachineSpec, found: Analysis, *, seed: int, provenance: Mapping[str, object]) -> Report:
    """Everything the interface asks for."""
    data, judgement, site = found.held_run.data, judge(found), driven_site(spec)
    mass = mass_kg(found.final.model, data, site)
    shown, name = shown_stretch(found), site.body.name
    machine, judgement = _revised(spec, found, judgement, shown.drive)
    only = "One degree of freedom: a force between the mass and the ground is the only place."
    limits = (
        only,
        *from_rest(found),
        *seen_from_rest(found),
        *(_not_freely(v) for v in found.validations if v.led),
        *_not_all(found),
    )
    nothing = judgement.verdict in ("nothing_missing", "not_decidable")
    freed = None if nothing else freed_force(found, mass, seed)
    return Report(
        verdict=judgement.verdict,
        sentence=_sentence(found, judgement, name),
        level="driven",
        where=Where(sites=() if nothing else (PlaceWeight(site=name, weight=1.0),), limits=limits),
        causes=_causes(found, judgement, name, mass),
        held_out=_held_out(found),
        force=None if freed is None else _force(found, freed, judgement, name, mass),
        undecidable=_undecidable(found, judgement, data.assumed, data.calibrated),
        next_experiment=_next(judgement, data.order == ACCELERATION and bool(found.final.model.laws)),
        machine=machine,
        stages=_stages(found, data.assumed),
        pictures=pictures(found, shown, freed),
        provenance={**provenance, "output_offset": found.published.output_offset},
    )
