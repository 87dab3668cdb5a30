"""What the gear classifier and its rival say of every recording and window of a gear stage."""

from __future__ import annotations

from collections.abc import Sequence
from concurrent.futures import Executor
from dataclasses import dataclass

from learn.assess import estimated
from learn.gears.assess import assess_stage, knows_gears
from learn.gears.detector import fm4_detector
from learn.model import Model
from learn.real.load import Case
from learn.sim2real.answers import Answer, Unit, ask
from learn.speed import Speed

SHAPES = ("first gear", "second gear")


def by_fm4(unit: Unit) -> Answer:
    """FM4 of both gears, at the true speed."""
    assert unit.case.teeth is not None
    label, levels = fm4_detector(list(unit.channels), unit.case.rate_hz, unit.case.speed_hz, unit.case.teeth)
    return Answer(unit=unit, label=label, detail=f"FM4 {levels[0]:.1f}, {levels[1]:.1f}")


@dataclass(frozen=True, kw_only=True)
class GearsByModel:
    """The model; the teeth are given, the speed too or (`near`) estimated from the stated one."""

    model: Model
    near: bool = False

    def __call__(self, unit: Unit) -> Answer:
        """What it says of a unit."""
        case = unit.case
        assert case.teeth is not None
        rows = list(unit.channels)
        found = Speed(speed_hz=case.speed_hz, method="given", standing=0.0)
        if self.near:
            found = estimated(rows, case.rate_hz, case.stated_hz, None)
        answer = assess_stage(rows, case.rate_hz, found.speed_hz, self.model, case.teeth, found.doubt)
        shares = ", ".join(f"{k} {p:.2f}" for k, p in answer.probabilities.items())
        where = ""
        if answer.place is not None:
            where = f"; {case.teeth[answer.gear]} teeth, channel {answer.place.channel + 1}, {answer.place.band}"
        return Answer(unit=unit, label=answer.label, detail=f"{shares}; {found.speed_hz:.2f} Hz{where}")


def gear_ways(
    cases: Sequence[Case], model: Model, pool: Executor | None
) -> tuple[list[Answer], list[Answer], list[Answer]]:
    """(speed given, FM4, speed estimated near the stated one) on all gear recordings; nothing of a model without."""
    if not cases or not knows_gears(model):
        return [], [], []
    return (
        ask(cases, GearsByModel(model=model), pool=pool),
        ask(cases, by_fm4, pool=pool),
        ask(cases, GearsByModel(model=model, near=True), pool=pool),
    )
