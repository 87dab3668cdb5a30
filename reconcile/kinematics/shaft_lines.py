"""What low multiples of a shaft may be when they grew, and what tells the causes apart."""

from __future__ import annotations

from collections.abc import Sequence

from reconcile.kinematics.observe import Observation
from reconcile.kinematics.shafts import ShaftChange
from reconcile.verdict import Cause, LineChange, NextExperiment, PlaceWeight, Report, Where

SHAFT_TERMS = {
    0.5: ("pedestal_looseness", "rub"),
    1.0: ("unbalance", "bent_shaft", "eccentricity"),
    2.0: ("parallel_misalignment", "angular_misalignment", "shaft_crack"),
    3.0: ("parallel_misalignment", "pedestal_looseness"),
}
NEXT_OF_LINE = {
    0.5: "Check bolts, feet and fits; record at two more speeds: a rub comes and goes, play stays.",
    1.0: "Turn {shaft} slowly under a dial gauge: a bow or an eccentric gear runs out, unbalance does not; at speed "
    "both load the bearings alike. What a trial weight takes away was unbalance.",
    2.0: "Check the alignment, and record with the coupling apart: what goes with it was misalignment, a cracked shaft "
    "stays.",
    3.0: "Check the alignment, bolts and feet, and record with the coupling apart: what goes with it was misalignment.",
}


def shaft_report(changes: Sequence[ShaftChange], tests: Sequence[Observation]) -> Report:
    """Low multiples of a shaft grew on most channels."""
    first = changes[0]
    speed = next(t.speed.speed_hz for t in tests if t.label == first.label)
    terms = SHAFT_TERMS[first.multiple]
    kinds = ", ".join(t.replace("_", " ") for t in terms)
    return Report(
        verdict="ambiguous",
        sentence=f"{first.multiple:g} times the speed of {first.shaft} grew by {first.growth_db:.0f} dB on "
        f"{first.channel} ({first.median_db:.0f} dB in the middle of the channels): {kinds} or another mounting are "
        "alike at this level.",
        level="kinematics",
        where=Where(
            sites=(PlaceWeight(site=first.shaft, weight=1.0),),
            lines=tuple(
                LineChange(
                    label=f"{c.multiple:g} x {c.shaft}",
                    frequency_hz=c.order * speed,
                    change_db=c.growth_db,
                    channel=c.channel,
                    locked_to=c.shaft,
                    speed_hz=speed,
                )
                for c in changes
            ),
        ),
        causes=tuple(
            Cause(
                term=t,
                site=first.shaft,
                score=first.growth_db,
                score_unit="dB",
                reasons=("the line alone does not tell",),
            )
            for t in terms
        ),
        undecidable=(
            "unbalance, bow and misalignment without phases",
            "how large: a size can't be given without a model",
        ),
        next_experiment=NextExperiment(sentence=NEXT_OF_LINE[first.multiple].format(shaft=first.shaft)),
    )
