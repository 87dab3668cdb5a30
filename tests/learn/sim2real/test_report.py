import json
from dataclasses import replace

import numpy as np
import pytest

from learn.features import NAMES
from learn.model import default_model
from learn.sim2real import __main__ as command
from learn.sim2real.answers import by_detector
from learn.sim2real.report import FITTED, GIVEN, NEAR, RIVAL, STATED, UNKNOWN, Asked, line_of, text_of
from learn.sim2real.rivals import said_by, trained_on


@pytest.fixture
def asked(made):
    """Two bearings of the development rig, two of another, a sound one of unknown size; the detector finds no fault."""
    own = [made.case("n", "healthy", rig="cwru"), made.case("o", "outer", rig="cwru")]
    other = [made.case("p", "healthy", rig="far"), made.case("q", "ball", rig="far")]
    unsized = made.case("m", "healthy", rig="motor", orders=None)
    given = [made.answer(c, c.label, window=w) for c in (*own, *other) for w in (None, 0)]
    missed = [made.answer(c, "healthy", window=w) for c in (*own, *other) for w in (None, 0)]
    alone = {GIVEN: given, RIVAL: missed, FITTED: [a for a in missed if a.unit.window is not None], NEAR: given}
    ways = {name: [*answers, made.answer(unsized, "outer")] for name, answers in alone.items()}
    ways[UNKNOWN] = ways[GIVEN]
    severe = made.case("severe", "other", rig="motor", orders=None)
    return Asked(ways=ways, alone=alone, unscored=[made.answer(severe, "inner")], rule_db=14.25)


@pytest.mark.slow
def test_the_line_has_every_rig_every_control_and_both_detectors(asked):
    line = json.loads(json.dumps(line_of(asked)))
    assert set(line["rigs"]) == {"cwru", "cwru_windows", "far", "far_windows"}
    assert line["controls"] == {"motor": {"unit": "recording", "n": 1, "false_alarms": 1}}
    assert line["controls_detector"]["motor"]["n"] == 1
    assert (line["pooled"]["n"], line["pooled_bearings"]["n"]) == (5, 4)
    assert line["pooled"]["balanced_accuracy"] == round((2 / 3 + 1 + 1) / 3, 4)
    assert line["pooled_other_rigs"]["model"]["balanced_accuracy"] == 1.0
    assert line["pooled_other_rigs"]["detector"]["balanced_accuracy"] == 0.5
    assert line["pooled_stated_bearings"]["model"]["n"] == line["pooled_stated_bearings"]["detector"]["n"] == 4
    assert line["detector_fitted"]["pooled_stated_bearings"]["windows"]["n"] == 4
    assert line["paired"][0] == {"unit": "recording", "recordings": 4, "better": 2, "worse": 0, "sign_test_p": 0.5}
    assert line["detector_fitted"]["rule_db"] == 14.25
    assert line["detector_fitted"]["pooled"]["windows"]["n"] == 4
    assert line["severity"]["pairs"] == 0


def test_without_the_development_rig_there_is_no_fitted_detector(asked):
    alone = {name: answers for name, answers in asked.alone.items() if name != FITTED}
    assert "detector_fitted" not in line_of(Asked(ways=asked.ways, alone=alone, unscored=[], rule_db=None))


def test_the_text_tells_what_counts_nowhere_and_how_many_of_each_class_are_right(asked):
    text = text_of(asked, "rivals")
    assert "* motor, severe: said inner" in text
    assert f"| {RIVAL} | recording | 2/2 | 0/1 | 0/0 | 0/1 |" in text
    assert f"| {RIVAL} | recording | 4 | 2 | 0 | 0.5 |" in text
    assert f"| {FITTED} | window | 4 | 2 | 0 | 0.5 |" in text
    assert "The fitted threshold is 14.2 dB" in text
    assert f"| {GIVEN}, bearings of known size, without the development rig | 1.000" in text


@pytest.mark.slow
def test_the_text_tells_which_bearing_was_inferred_and_the_figures_without_it(asked, made):
    assert "inferred" not in text_of(asked, "rivals")
    guessed = [made.answer(made.case("B", "ball", rig="uestc"), "outer", window=w) for w in (None, 0)]
    alone = {name: [*answers, *guessed] for name, answers in asked.alone.items()}
    more = replace(asked, alone=alone, ways={**asked.ways, **alone})
    text, line = text_of(more, "rivals"), line_of(more)
    assert "The bearing of uestc is not stated" in text
    assert f"| {GIVEN}, bearings of known size | 0.833" in text
    assert f"| {GIVEN}, {STATED} | 1.000" in text
    assert f"| {RIVAL}, {STATED} | 0.333" in text
    assert f"| {FITTED}, {STATED} |" in text
    assert line["pooled_stated_bearings"]["model"]["balanced_accuracy"] == 1.0
    assert line["pooled_stated_bearings"]["detector"]["windows"]["balanced_accuracy"] == 0.3333


def test_a_rival_of_another_rig_cannot_name_a_class_that_rig_lacks(made):
    rng = np.random.default_rng(0)

    def rows(label, count, at):
        units = [made.answer(made.case(f"{label}{k}", label), label).unit for k in range(count)]
        return [(unit, at + 0.1 * rng.standard_normal(len(NAMES))) for unit in units]

    head = trained_on([*rows("healthy", 20, 0.0), *rows("outer", 20, 1.0)], seed=0)
    assert said_by(head, [*rows("healthy", 3, 0.0), *rows("outer", 3, 1.0)]) == ["healthy"] * 3 + ["outer"] * 3
    assert set(said_by(head, rows("ball", 3, 2.0))) <= {"healthy", "outer"}


def test_the_detector_raises_no_alarm_about_a_bearing_it_does_not_know(made):
    assert by_detector(made.answer(made.case("m", "outer", orders=None), "").unit).label == "healthy"


@pytest.mark.slow
def test_the_command_ends_with_one_line_of_json(made, monkeypatch, capsys, tmp_path):
    """On noise called recordings: everything is asked and told, whatever it is worth."""
    rng = np.random.default_rng(0)
    cases = [
        replace(made.case(name, label, rig=rig), channels=rng.standard_normal((1, 13_000)), rate_hz=12_000.0)
        for rig, name, label in (("cwru", "n", "healthy"), ("cwru", "o", "outer"), ("far", "x", "other"))
    ]
    monkeypatch.setattr(command, "available", lambda: True)
    monkeypatch.setattr(command, "index", lambda: [{"dataset": "cwru", "at": k} for k in range(3)])
    monkeypatch.setattr(command, "case", lambda entry: cases[entry["at"]])
    monkeypatch.setattr(command, "load", lambda path: default_model())
    page = tmp_path / "page.md"
    page.write_text(f"head\n{command.MARK}\nlast time's", encoding="utf-8")
    given = ["--from-model", "any", "--ablated", "0", "--processes", "1", "--docs", str(page)]
    assert command.main(given) == 0
    last = capsys.readouterr().out.strip().splitlines()[-1]
    name, text = last.split(" ", 1)
    assert name == "SIM2REAL"
    assert json.loads(text)["pooled"]["n"] == 2
    assert page.read_text(encoding="utf-8").startswith(f"head\n{command.MARK}\n\nBalanced")
    assert "last time's" not in page.read_text(encoding="utf-8")
