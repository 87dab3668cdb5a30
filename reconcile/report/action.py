"""What a person on site can do now: one sentence, nothing that the figures do not carry."""

from __future__ import annotations

from collections.abc import Callable

from reconcile.report.mending import to_mend
from reconcile.verdict import Report, Word

EXCHANGED = "exchanged, or a part replaced"
"""How the sentence says that the baseline has what the tests have not (`reconcile.kinematics.remarks`,
`reconcile.machine.exchanged`)."""
SPEED_OPEN = "The speed is not decided"
SPEED_UNHEARD = "The speed is not confirmed by any line"
"""How the sentence says that what strikes hangs on which of two speeds it was (`reconcile.kinematics.doubted`)."""
PLACE_OPEN = "the place is not decided by these sensors"
"""How a set of places is told; with the reason behind a colon by those causes alone that make it
(`reconcile.machine.elsewhere`)."""
NO_FIT = "the machine file does not fit"
"""How the sentence says that the file is another machine's (`reconcile.machine.misfit`)."""
NO_PART = "no part of the machine file has a line"
"""How the sentence says that something strikes which the file has not (`reconcile.machine.foreign`)."""
UNJUDGED = "is not judged without a baseline"
"""How the sentence says that nothing is said of shafts (`reconcile.kinematics.vague`)."""
LOUDEST = "loudest at the sensor of"
"""How the sentence says that a named bearing's lines are heard at the other end (`reconcile.kinematics.ends`)."""
BY_LOUDNESS = "only which sensor hears it louder tells the place"
"""How the limits say so of bearings that make the same lines (`reconcile.kinematics.answer`)."""
UNIT_OR_GAIN = "unit or gain"
"""How the sentence, or a limit, says that levels changed as those of another unit (`reconcile.kinematics.shifted`)."""
STRIKES = "what strikes once a turn of"
"""How what is undecidable says that impacts of a turn rose beside a bearing (`reconcile.kinematics.turning`)."""
STRIKES_OPEN = "what strikes once a turn"
"""How it says that nothing else is told but these impacts."""
BESIDE_BEARING = " beside the bearing"
ALL_WRONG = (
    "Tests and baselines are wrong by one factor: check whether it is the speed of another shaft, the ratios of the "
    "machine file, and the sampling rate."
)
"""How the next experiment says that all labels of speed are wrong alike (`reconcile.kinematics.elsewhere`)."""
FEWEST_LINES = 4
"""Changed lines from which it says something that all are on one channel."""
SET_SHARE = 0.5
"""Score over the best one's from which a cause is taken for one of an ambiguous set."""

TEETH = ("tooth_crack", "tooth_spall", "missing_tooth")
"""Effects of a single tooth."""
TURNING = "units, which sensor is which, the stated speed, the numbers of bearings and teeth"
ONE_MASS = (
    "units and sign of force and motion, the sampling rate, channels that are not read at once, the mass of the "
    "machine file"
)
"""What may be wrong beside the machine, where parts turn and where one mass is driven by what was measured."""


def to_do(report: Report) -> str:
    """The sentence for a verdict, with the next experiment where one is advised."""
    exchanged = "check which recording is which: the baseline shows more than the tests."
    if EXCHANGED in report.sentence and report.verdict != "explained":
        return exchanged
    if EXCHANGED in report.sentence:
        return f"{ACTIONS[report.verdict](report)} Before that {exchanged}"
    advice = f"{ACTIONS[report.verdict](report)}{_turn_too(report)}{_sensor_too(report)}{_which_first(report)}"
    if report.next_experiment is None or report.verdict not in OPEN:
        return advice
    return f"{advice} {report.next_experiment.sentence}".strip()


def _turn_too(report: Report) -> str:
    """What may strike once a turn, where that rose beside a bearing."""
    said = next((text for text in report.undecidable if text.startswith(f"{STRIKES} ")), None)
    if said is None or report.verdict == "measurement_fault":
        return ""
    where, _, what = said.partition(": ")
    return f" Look at {where.removesuffix(BESIDE_BEARING)} too: {what}."


def _sensor_too(report: Report) -> str:
    """What is to be mended where a fault of the measurement stands beside the answer."""
    if report.fault is None or report.verdict == "measurement_fault" or _perhaps_all(report):
        return ""
    said = to_mend(report.fault, beside=True, several=report.measurement_faults)
    return f" {said[0].upper()}{said[1:]}"


def _which_first(report: Report) -> str:
    """What place, levels, or a speed that is wrong in all recordings hang on: to be looked up first."""
    if report.verdict == "measurement_fault" and report.next_experiment is not None:
        return f" {ALL_WRONG}" if ALL_WRONG in report.next_experiment.sentence else ""
    if report.verdict not in ("explained", "ambiguous"):
        return ""
    if LOUDEST in report.sentence:
        return (
            " Before that check which sensor is which channel, unit and gain of each, and the types of the bearings in "
            "the machine file."
        )
    units = " Before that check unit and gain of every channel against the baseline's." if _shifted(report) else ""
    if any(BY_LOUDNESS in limit for limit in report.where.limits):
        return f"{units} Before that check which sensor is which channel: the place hangs on it."
    return units


def _shifted(report: Report) -> bool:
    return any(UNIT_OR_GAIN in limit for limit in report.where.limits)


def _perhaps_all(report: Report) -> bool:
    """Whether a fault of the measurement may be all that speaks for the names."""
    return report.verdict == "ambiguous" and report.fault is not None and report.fault.doubtful


def undecided(report: Report) -> tuple[list[str], list[str]]:
    """Effects and places of an ambiguous set, as far as the report's causes show it."""
    best = max((c.score for c in report.causes), default=0.0)
    opened = [c for c in report.causes if any(r.startswith(f"{PLACE_OPEN}:") for r in c.reasons)]
    kept = opened or [c for c in report.causes if c.score >= SET_SHARE * best]
    return list(dict.fromkeys(c.term for c in kept)), list(dict.fromkeys(c.site for c in kept if c.site))


def _place(report: Report) -> str:
    return " or ".join(report.where.likeliest)


def _nothing(report: Report) -> str:
    kept = "nothing follows from these recordings; keep them to compare later ones with."
    if _shifted(report):
        kept = "check unit and gain of every channel against the baseline's before you keep these to compare with."
    if UNJUDGED in report.sentence:
        kept = "no bearing defect shows; judge the levels of the shafts' own lines by the limits that you use."
    if NO_FIT in report.sentence:
        kept = "correct the machine file first, and ask again: what sound machines show is measured with it."
    unseen = " What they would hardly have shown stands under “What would have been seen”." if report.faintest else ""
    return f"{kept}{unseen}"


def _measurement(report: Report) -> str:
    told = report.measurement_faults
    return to_mend(report.fault, several=told) if report.fault is not None else "check the sensors and record again."


def _explained(report: Report) -> str:
    named = [c for c in report.causes if c.named]
    sites = [c.site for c in named if c.site]
    at = " and ".join(dict.fromkeys(sites)) or _place(report)
    if NO_PART in report.sentence:
        return f"check the numbers of the bearings in the machine file and ask again, before {at or 'it'} is inspected."
    if report.level == "driven":
        size = "the size, an estimate, holds" if any(c.severity is not None for c in named) else "it holds"
        again = "record again at another level of the input and see whether"
        return f"take it into the model of {at or 'the machine'}; {again} {size}."
    follow = "the size, an estimate" if any(c.severity is not None for c in named) else "its lines"
    return f"inspect {at or 'the machine'} at the next stop; until then record again and follow {follow}."


def _one_alone(report: Report) -> str:
    """The channel that all of the lines that changed are on, where the recordings have others; else nothing."""
    heard = {line.channel for line in report.where.lines}
    rows = report.pictures.get("levels", ())
    every = (
        {str(row.get("channel")) for row in rows if isinstance(row, dict)} if isinstance(rows, list | tuple) else set()
    )
    return next(iter(heard)) if len(heard) == 1 and len(report.where.lines) >= FEWEST_LINES and len(every) > 1 else ""


def _unknown(report: Report) -> str:
    place, alone = _place(report), _one_alone(report)
    here = f"look at {place} first; " if place else ""
    if alone:
        here = (
            f"all lines that changed are on {alone}: check its cable, its amplifier and how it is fastened, or change "
            f"the sensor and record again, and look at what it stands on; then at {place or 'the machine'}; "
        )
    rule_out = f"{ONE_MASS if report.level == 'driven' else TURNING}, a baseline of another machine or state"
    if report.level == "driven" and not report.provenance.get("baselines"):
        rule_out = ONE_MASS
    return (
        f"{here}none of the known names fits, so take none for granted. Rule out what is not the machine: {rule_out}."
    )


def _several(report: Report) -> str:
    if report.fault is not None and _perhaps_all(report):
        return to_mend(report.fault, several=report.measurement_faults)
    kinds, sites = undecided(report)
    if STRIKES_OPEN in report.undecidable and len(sites) > 1:
        return _on_the_shaft(report, sites)
    if len(kinds) == 1 and len(sites) > 1:
        return f"plan to inspect {' and '.join(sites)}: one of them has it."
    if len(sites) == 1 and on_the_speed(report):
        return f"find out how fast it turned (nameplate, strobe, tacho) and ask again before {sites[0]} is opened."
    if len(sites) == 1:
        return f"plan to inspect {sites[0]}; which of the names it is stays open."
    return "act on none of the names alone."


def on_the_speed(report: Report) -> bool:
    """Whether the part that is told hangs on a speed that is open."""
    return any(words in report.sentence for words in (SPEED_OPEN, SPEED_UNHEARD))


def _on_the_shaft(report: Report, sites: list[str]) -> str:
    """What to look at where something strikes once a turn: all that turns with the shaft, teeth first."""
    shafts = dict.fromkeys(c.site for c in report.causes if c.term == "rub")
    gears = dict.fromkeys(c.site for c in report.causes if c.term in TEETH)
    rest = [site for site in sites if site not in shafts and site not in gears]
    first = f" the teeth of {' and '.join(gears)} first, then" if gears else ""
    parts = [*(f"{shaft} itself" for shaft in shafts), *rest]
    said = ", ".join(parts[:-1]) + (" and " if len(parts) > 1 else "") + parts[-1] if parts else ""
    return f"plan to inspect what turns with {' and '.join(shafts)}:{first} {said}; which of them it is stays open."


def _nobody_knows(report: Report) -> str:
    return "act on none of the names." if report.causes else "" if report.next_experiment else "record again."


ACTIONS: dict[Word, Callable[[Report], str]] = {
    "nothing_missing": _nothing,
    "explained": _explained,
    "ambiguous": _several,
    "unknown_physics": _unknown,
    "measurement_fault": _measurement,
    "not_decidable": _nobody_knows,
}
OPEN = ("ambiguous", "unknown_physics", "not_decidable")
"""Verdicts whose advice is followed by the next experiment."""
