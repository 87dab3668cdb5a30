"""Steps in words, tables as tables; what to do; where the report comes from."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from reconcile.report import page
from reconcile.report.action import to_do
from reconcile.report.formula import formula
from reconcile.report.markup import Markup
from reconcile.report.provenance import provenance
from reconcile.report.sections import causes_table, where_table
from reconcile.report.steps import stages
from reconcile.report.words import compared
from reconcile.verdict import (
    Cause,
    HeldOut,
    LineChange,
    NextExperiment,
    PlaceWeight,
    Report,
    SensorFault,
    Severity,
    Where,
    Word,
)

FAMILY = {
    "family": "b1.outer",
    "order": 3.59,
    "z": 22.5,
    "chance": 1e-5,
    "heard": {"a": 22.5},
    "risen": True,
    "x": None,
}


def report(verdict: Word = "explained", **more: object) -> Report:
    return Report(verdict=verdict, sentence="s", level="machine", **more)  # type: ignore[arg-type]


def rows(markup: str) -> list[list[str]]:
    return [
        [re.sub("<[^>]+>", "", cell) for cell in re.findall("<t[hd][^>]*>(.*?)</t[hd]>", row)]
        for row in re.findall("<tr.*?</tr>", markup)
    ]


def test_keys_become_words_and_what_is_empty_is_left_out() -> None:
    found = {"name": "calibrate", "mode": "A", "median_gain_db": [-0.2], "strayed": [], "natural_frequency_hz": None}
    (_, told) = rows(stages(report(stages=(found,))))
    assert told[0] == "machine and sensors fitted to what is sound"
    assert told[1] == "compared with: baselines of this machine; median gain of the sensors, dB: -0.2"


def test_lists_of_objects_are_tables_without_columns_that_nobody_has() -> None:
    families = {"name": "families", "table": [FAMILY, {**FAMILY, "family": "b1.inner", "risen": False}]}
    heads, first, second = rows(stages(report(stages=(families, {"name": "speed", "found": {}}))))
    assert heads == ["family", "order", "deviations of control orders", "chance", "deviations by channel", "has risen"]
    assert first[0] == "b1.outer" and first[-1] == "yes" and second[-1] == "no"


def test_under_a_table_that_says_what_is_there_and_what_has_risen_stands_why_both_are_asked() -> None:
    for row, said in ((FAMILY, False), ({**FAMILY, "present": False}, True)):
        shown = stages(report(stages=({"name": "families", "table": [row]},)))
        assert ("What has risen and is not there names no part by itself" in shown) is said


def test_short_objects_are_told_in_a_line_by_their_first_value() -> None:
    decided = [{"number": f"part {k}", "offset": 0.1, "share": 0.9} for k in range(15)]
    (_, told) = rows(stages(report(stages=({"name": "calibrate", "decided": decided},))))
    assert told[1].startswith("numbers the baseline decides: part 0, part 1,") and told[1].endswith("… (15)")


def test_a_figure_is_rounded_as_it_is_elsewhere_on_the_page() -> None:
    held = HeldOut(
        metric="free-run NRMSE", unit="1", before=0.7314, after=0.1234, gain=0.8642, gain_low=0.8512, gain_high=0.8771,
        retuned=0.0512, black_box=0.3049, placebo=0.1051, held="h",
    )  # fmt: skip
    validated = {
        "stage": "validate", "before": 0.7314, "after": 0.1234, "gain": [0.8642, 0.8512, 0.8771], "retuned": 0.0512,
        "black_box": 0.3049, "placebo": 0.1051,
    }  # fmt: skip
    whole = page(report(held_out=held, stages=(validated, {"stage": "judge", "lines_explained": 0.9666})))
    assert "before: 73 %; after: 12 %; gain: 86 %, 85 %, 88 %; retuned: 5 %; black box: 30 %; placebo: 11 %" in whole
    assert "share of the single lines&#x27; change explained: 97 %" in whole
    assert "86 % (90 %: 85 % to 88 %)" in whole and "how far the model is off on data never fitted, %" in whole
    assert not re.findall(r"0\.8[56]\d|0\.12\d|0\.73\d|86\.4", whole)
    other = {"stage": "validate", "retuned": 0.1234}
    assert "retuned: 0.1234" in page(report(stages=(other,))), "an error, not a gain"


def test_nothing_found_is_no_section() -> None:
    assert stages(report()) == "" and stages(report(stages=({"name": "speed", "found": {}},))) == ""


def of_set(*where: tuple[str, str]) -> Report:
    found = tuple(Cause(term=t, site=p, severity=None, score=1.0, named=False) for t, p in where)
    return report("ambiguous", causes=found)


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (report("nothing_missing"), "nothing follows"),
        (
            report(causes=(Cause(term="outer_spall", site="b1", severity=None, score=9.0, named=True),)),
            "follow its lines",
        ),
        (report("measurement_fault", fault=SensorFault(kind="clipped", channel="de", detail="")), "at de"),
        (
            report("measurement_fault", fault=SensorFault(kind="loose_sensor", channel="de", detail="")),
            "if it is tight",
        ),
        (
            report("measurement_fault", fault=SensorFault(kind="fixed_tones", channel="de", detail="")),
            "record with it off",
        ),
        (report("unknown_physics", where=Where(sites=(PlaceWeight(site="b2", weight=0.9),))), "look at b2"),
        (
            report("not_decidable", next_experiment=NextExperiment(sentence="Record with a tacho.")),
            "Record with a tacho.",
        ),
        (of_set(("a", "b")), "plan to inspect b; which"),
        (of_set(("a", "b"), ("a", "c")), "b and c: one of them"),
        (of_set(("a", "b"), ("d", "c")), "act on none"),
        (report("not_decidable"), "record again"),
    ],
)
def test_every_verdict_says_what_to_do(made: Report, said: str) -> None:
    assert said in to_do(made)


def test_the_head_names_machine_and_files() -> None:
    sent = {"test 1": "now.json", "baseline 1": "sound.json"}
    made = report(provenance={"machine": "rig", "sent_as": sent, "cost": {"core_s": 12.0}})
    assert compared(made) == "rig: now.json, against sound.json as the baseline,"
    assert compared(report()) == "Recording"
    assert ["recordings", "test 1: now.json; baseline 1: sound.json"] in rows(provenance(made))


def test_lines_of_one_family_stand_in_one_row() -> None:
    lines = tuple(
        LineChange(label=f"{k} BPFO", frequency_hz=100.0 * k, change_db=20.0, channel="a", locked_to="b1.outer")
        for k in (1, 2)
    )
    other = LineChange(label="1 BPFI", frequency_hz=150.0, change_db=20.5, channel="a", locked_to="b1.inner")
    _, first, second = rows(where_table(Where(lines=(*lines, other))))
    assert first[0] == "1 BPFI" and second[:3] == ["1 BPFO, 2 BPFO", "100, 200", "+20.0"]


def test_lines_of_the_struck_part_stand_before_the_others() -> None:
    lines = tuple(
        LineChange(
            label=f"{k}*f_o1", frequency_hz=100.0 * k, change_db=30.0 - k * (-1) ** k, locked_to="outer ring of b1"
        )
        for k in (3, 1, 2)
    )
    other = LineChange(label="2*f_i1", frequency_hz=150.0, change_db=50.0, locked_to="inner ring of b1 or outer_b1")
    named = Cause(term="outer_spall", site="b1", score=9.0, named=True)
    made = where_table(Where(lines=(*lines, other)), (named,))
    before, after = made.split("1 other line that changed")
    assert [row[1] for row in rows(Markup(before))[1:]] == ["100", "200", "300"]
    assert [row[1] for row in rows(Markup(after))[1:]] == ["150"]
    assert "that changed" not in where_table(Where(lines=(*lines, other)), (replace(named, site="b"),)), "no part of it"
    for unnamed in ((), (replace(named, named=False),), (replace(named, term="unbalance"),)):
        assert "that changed" not in where_table(Where(lines=(*lines, other)), unnamed)


def test_sizes_have_two_figures_as_the_sentence_has_them() -> None:
    size = Severity(name="width", value=1.664e-3, low=3.751e-4, high=7.391e-3, unit="m")
    cause = Cause(term="outer_spall", site="drive_end", score=29.6, named=True, severity=size)
    whole = page(report(causes=(cause,)))
    assert "<b>1.7 mm</b>" in whole and "width of outer spall at drive_end, 90 %: 0.38 mm to 7.4 mm" in whole
    assert "width 1.7 mm (90 %: 0.38 mm to 7.4 mm)" in whole and "1.66" not in whole


def test_a_bound_on_the_width_stands_in_the_cell_of_the_severity() -> None:
    values = {"width_below_m": 0.0020003}
    cause = Cause(term="outer_spall", site="drive_end", score=22.0, named=True, values=values)
    (_, row) = rows(causes_table((cause,), "kinematics"))
    assert row[2] == "width less than 2 mm"


def test_names_of_lines_are_written_as_by_hand() -> None:
    assert formula("3*f_i1-2*f_r1 or 4*f_o1").replace("\u00a0", " ") == (
        "3 <i>f</i><sub>i1</sub> − 2 <i>f</i><sub>r1</sub> or 4 <i>f</i><sub>o1</sub>"
    )
    assert formula("1 BPFO") == "1 BPFO" and formula("drive_end.outer") == "drive_end.outer"
    assert formula("<b>") == "&lt;b&gt;"


def test_symbols_of_lines_are_said_where_there_are_any() -> None:
    for label, said in (("3*f_o1", True), ("BPFO", False)):
        lines = (LineChange(label=label, frequency_hz=323.7, change_db=30.0),)
        assert ("<i>f</i><sub>c</sub>: outer race" in where_table(Where(lines=lines))) is said


def test_costs_are_told_in_words() -> None:
    whole = provenance(report(provenance={"cost": {"core_s": 70.1, "until_atlas_core_s": 0.8}, "seed": 0}))
    assert "processor seconds: 70.1; of them until the atlas was there: 0.8" in whole and "core s" not in whole


def test_what_is_ruled_out_beside_the_machine_is_what_there_is() -> None:
    turning, driven = (to_do(Report(verdict="unknown_physics", sentence="", level=x)) for x in ("machine", "driven"))
    assert "bearings and teeth" in turning and "stated speed" in turning and "a baseline" in turning
    assert "speed" not in driven and "teeth" not in driven and "sampling rate" in driven and "baseline" not in driven
    compared = Report(verdict="unknown_physics", sentence="", level="driven", provenance={"baselines": 1})
    assert "sign of force and motion" in to_do(compared) and "a baseline of another" in to_do(compared)


def test_what_one_channel_alone_shows_is_looked_for_in_its_cable_first() -> None:
    def said(*channels: str, recorded: tuple[str, ...] = ("a1", "a2")) -> str:
        lines = tuple(LineChange(label="x", frequency_hz=9.0, change_db=9.0, channel=c) for c in channels)
        where = Where(sites=(PlaceWeight(site="b2", weight=0.9),), lines=lines)
        levels = [{"channel": c} for c in recorded]
        return to_do(report("unknown_physics", where=where, pictures={"levels": levels}))

    assert said(*["a2"] * 4).startswith("all lines that changed are on a2: check its cable, its amplifier")
    assert "look at what it stands on; then at b2; none of the known names fits" in said(*["a2"] * 4)
    for other in (said(*["a2"] * 3), said("a1", *["a2"] * 4), said(*["a2"] * 4, recorded=("a2",))):
        assert other.startswith("look at b2 first; ")


def test_the_speeds_are_told_in_words() -> None:
    one = {"speed_hz": 29.9, "low_hz": 26.9, "high_hz": 32.9, "method": "stated", "confidence": 0.2, "rival_hz": None}
    html = stages(report(stages=({"name": "speed", "found": {"test 1": one}},)))
    for words in (
        "at least, Hz",
        "at most, Hz",
        "confidence that its lines were found, of 1",
        "no line of the spectrum",
    ):
        assert words in html
    assert "low hz" not in html and "rival" not in html
