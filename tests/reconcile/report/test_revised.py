"""A revised machine that does not show what was recorded says so, and the answer sends to the machine file."""

from __future__ import annotations

from dataclasses import replace

import pytest

from reconcile.report.page import page
from reconcile.report.revised import CORRECT, note, sent_to_the_file, size_in_it, to_do
from reconcile.report.strict import document
from reconcile.verdict import Cause, NextExperiment, Report, Severity, Word


def answer(left_db: float, *, sentence: str = "Outer-race spall at drive_end.", verdict: Word = "explained") -> Report:
    stage = {"name": "revised machine", "simulated_forms": 7, "level_change_db": 6.0, "left_of_it_db": left_db}
    return Report(verdict=verdict, sentence=sentence, level="machine", machine={"name": "rig"}, stages=(stage,))


def test_a_machine_that_leaves_more_than_there_was_sends_to_its_file() -> None:
    found = sent_to_the_file(answer(10.9))
    assert found.next_experiment is not None and "Correct the machine file" in found.next_experiment.sentence
    assert str(document(found)["to_do"]).count(CORRECT) == 1
    drawn = page(found)
    assert "leaves 182 % of the levels" in drawn and "should be corrected first" in drawn
    assert "reproduces the" not in drawn


def test_so_does_one_whose_file_does_not_fit_the_baseline_however_near_it_comes() -> None:
    found = sent_to_the_file(answer(2.0, sentence="A spall. But the machine file does not fit the baseline: far off."))
    assert CORRECT in to_do(found) and found.next_experiment is not None


@pytest.mark.parametrize("verdict", ["explained", "ambiguous"])
def test_a_machine_that_comes_near_is_only_told_by_what_it_leaves(verdict: Word) -> None:
    near = answer(2.0, verdict=verdict)
    assert sent_to_the_file(near) is near and "Correct" not in to_do(near)
    assert "it shows 67 % of the change in level, and leaves 33 %" in page(near)
    alike = answer(6.3, verdict=verdict)
    assert sent_to_the_file(alike) is alike and "comes no nearer to the recordings in level" in page(alike)


@pytest.mark.parametrize(("width", "said"), [(0.97e-3, True), (1.69e-3, False)])
def test_another_size_in_the_machine_than_is_told_is_said(width: float, said: bool) -> None:
    told = Severity(name="width", value=1.7e-3, unit="m", low=0.56e-3, high=4.9e-3)
    cause = Cause(term="outer_spall", site="drive_end", score=9.0, severity=told, named=True)
    term = {"term": "outer_spall", "site": "drive_end", "parameters": {"width": width, "angle": 0.1}}
    other = {"term": "outer_spall", "site": "fan_end", "parameters": {"width": 1.0}}
    near = replace(answer(2.0), causes=(cause,), machine={"terms": [other, term]})
    assert size_in_it(near) == (
        " Its width is 970 µm, not 1.7 mm: of the sizes within the interval that were simulated it is the one that, "
        "with its other numbers, comes nearest to the recordings."
        if said
        else ""
    )
    assert note(near).endswith(size_in_it(near))
    assert not size_in_it(replace(near, causes=(replace(cause, named=False),))), "a set tells no size"


def test_the_experiment_that_was_advised_follows() -> None:
    advised = NextExperiment(sentence="Add a sensor.", separation_now=1.0)
    asked = Report(**{**answer(9.0, verdict="ambiguous").__dict__, "next_experiment": advised})
    found = sent_to_the_file(asked).next_experiment
    assert found is not None and found.sentence == f"{CORRECT} Add a sensor." and found.separation_now == 1.0
    assert to_do(sent_to_the_file(asked)).count(CORRECT) == 1
