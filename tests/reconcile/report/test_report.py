"""The report as files: exact keys, strict JSON, a page whose text cannot become markup and that fetches nothing."""

from __future__ import annotations

import json
import math
import re
from dataclasses import replace
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from reconcile.report import page, strict_json, write_report
from reconcile.report.figures.maps import force_map
from reconcile.report.figures.sketch import sketch
from reconcile.report.markup import figure_text, tag
from reconcile.report.plot import MOST_POINTS, Frame, scaled, thinned, ticks
from reconcile.report.strict import Plain
from reconcile.report.words import sizes
from reconcile.verdict import (
    AngleWindow,
    Cause,
    EstimatedForce,
    HeldOut,
    LineChange,
    NextExperiment,
    PlaceWeight,
    Report,
    SensorFault,
    Severity,
    Where,
)
from sim.presets import preset

KEYS = {
    "to_do", "faintest", "measurement_faults", "provenance", "level", "stages", "pictures",
    "verdict", "sentence", "where", "causes", "fault", "held_out", "force", "undecidable", "next_experiment", "machine",
}  # fmt: skip
NASTY = '<script>alert("x")</script>&'
VOID = {"meta", "line", "rect", "circle", "path", "polyline", "polygon", "br"}


class Balanced(HTMLParser):
    """Collects texts and checks that elements close in order."""

    def __init__(self) -> None:
        super().__init__()
        self.open: list[str] = []
        self.seen: list[str] = []
        self.addresses: list[str] = []
        self.text = ""

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.append(tag)
        self.addresses += [value or "" for name, value in attrs if name in ("src", "href", "xlink:href")]
        if tag not in VOID:
            self.open.append(tag)

    def handle_startendtag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.seen.append(tag)

    def handle_endtag(self, tag: str) -> None:
        assert self.open.pop() == tag

    def handle_data(self, data: str) -> None:
        self.text += data


def full_report(text: str = "Bearing 1 is loose.") -> Report:
    z = np.linspace(-1e-5, 1e-5, 21)
    frequency = np.linspace(0, 2000, 400)
    level = -40 + 10 * np.sin(frequency / 50)
    return Report(
        verdict="explained",
        sentence=text,
        level="machine",
        where=Where(
            sites=(PlaceWeight(site="bearing1", weight=0.86), PlaceWeight(site="mesh1", weight=0.1)),
            lines=(LineChange(label=text, frequency_hz=322.0, change_db=14.0),),
            angle_window=AngleWindow(shaft="input", centre_deg=350.0, low_deg=330.0, high_deg=20.0),
            limits=(text,),
        ),
        causes=(
            Cause(
                term="fit_clearance",
                site="bearing1",
                score=41.0,
                named=True,
                severity=Severity(name="gap", value=2.1e-5, unit="m", low=1.8e-5, high=2.4e-5),
            ),
            Cause(term=text, site=text, score=math.nan, reasons=(text,)),
        ),
        held_out=HeldOut(
            metric=text, unit="dB", before=5.0, after=2.0, gain=0.6, gain_low=0.5, gain_high=0.7, retuned=0.1,
            black_box=None, placebo=math.nan, held=text,
        ),
        force=EstimatedForce(
            site="bearing1", samples={"displacement_m": tuple(z), "force_n": tuple(1e12 * z**2)}, law=None
        ),
        fault=SensorFault(kind="clipped", channel=text, detail=text),
        undecidable=(text,),
        next_experiment=NextExperiment(sentence=text, separation_now=1.0, separation_expected=4.0),
        machine=preset("paper-demo").model_dump(mode="json"),
        stages=({"stage": "observe", "found": math.inf, text: text},),
        pictures={
            "spectra": [
                {"channel": text, "frequency_hz": frequency, "observed_db": level, "before_db": level - 3,
                 "after_db": np.where(frequency > 1000, np.nan, level)}
            ],
            "heat": {"shaft": "input", "angle_deg": np.arange(0, 360, 5.0), "order": np.arange(1, 5),
                     "value": np.arange(288.0).reshape(4, 72)},
            "changes": [{"feature": text, "observed_db": 3.0, "low": -1.0, "high": 1.0, "fitted_db": None}],
            "ranking": [{"label": text, "score": 3.0, "low": 1.0, "high": 4.0, "named": True}],
            "traces": [{"title": text, "unit": "V", "time_s": frequency, "observed": level, "before": level,
                        "after": level}],
            "force_map": {"x_label": text, "y_label": "v", "value_label": "N", "x": [0.0, 1.0], "y": [0.0, 1.0],
                          "value": [[1.0, None], [-1.0, 2.0]]},
        },
        provenance={"seed": 1, "versions": {"physics": "1"}},
    )  # fmt: skip


def test_json_has_the_keys_and_no_number_that_is_none() -> None:
    def refuse(name: str) -> float:
        raise AssertionError(name)

    found = json.loads(strict_json(full_report()), parse_constant=refuse)
    assert set(found) == KEYS
    assert found["held_out"]["placebo"] is None
    assert found["stages"][0]["found"] is None
    assert found["causes"][0]["severity"] == {
        "name": "gap",
        "value": 2.1e-5,
        "unit": "m",
        "low": 1.8e-5,
        "high": 2.4e-5,
    }
    assert found["pictures"]["spectra"][0]["after_db"][-1] is None


def test_every_text_is_escaped_and_nothing_is_fetched() -> None:
    parser = Balanced()
    parser.feed(page(full_report(NASTY)))
    assert not parser.open
    assert "script" not in parser.seen
    assert not parser.addresses
    assert parser.text.count(NASTY) > 10
    assert parser.seen.count("svg") >= 8


def test_where_nothing_is_missing_no_curve_is_drawn_with_it() -> None:
    drawn = page(replace(full_report(), verdict="nothing_missing"))
    spectra = drawn[drawn.index("<h2>Spectra</h2>") :].split("</section>")[0]
    assert "curve before" in spectra and "curve after" not in spectra and "with it" not in spectra
    named = page(full_report()).split("<h2>Spectra</h2>")[1].split("</section>")[0]
    assert "curve after" in named and "without it: the baseline" in named
    assert "These recordings were fitted" in named and "Improvement on data never fitted" in named


def test_nor_is_one_where_the_answer_brings_nothing_to_the_spectra() -> None:
    full = full_report()
    bare = [{**p, "after_db": p["before_db"]} for p in full.pictures["spectra"]]  # type: ignore[attr-defined]
    drawn = page(replace(full, verdict="unknown_physics", pictures={**full.pictures, "spectra": bare}))
    spectra = drawn[drawn.index("<h2>Spectra</h2>") :].split("</section>")[0]
    assert "curve before" in spectra and "curve after" not in spectra and "with it" not in spectra


def test_places_that_nothing_tells_apart_are_all_said() -> None:
    sites = tuple(PlaceWeight(site=name, weight=0.5) for name in ("input", "output"))
    drawn = page(replace(full_report(), verdict="unknown_physics", where=Where(sites=sites)))
    assert "<b>input or output</b>" in drawn and "most likely place" not in drawn
    assert "look at input or output first" in drawn


def test_the_places_of_two_named_effects_are_both_said() -> None:
    report = full_report()
    first = report.causes[0]
    second = replace(first, term="unbalance", site="gear", named=True)
    drawn = page(replace(report, verdict="explained", causes=(replace(first, named=True), second)))
    assert f"<b>{first.site} and gear</b>" in drawn and "most likely place" not in drawn


def test_a_force_is_drawn_of_a_driven_model_where_the_answer_has_one() -> None:
    driven = replace(full_report(), level="driven")
    assert "<h2>Estimated force</h2>" in page(driven)
    for bare in (replace(driven, force=None), replace(driven, verdict="measurement_fault")):
        assert "<h2>Estimated force</h2>" not in page(bare)


def test_the_ends_of_a_colour_bar_leave_its_label_room() -> None:
    picture: dict[str, Plain] = {"x_label": "x", "y_label": "y", "value_label": "N", "x": [0.0, 1.0], "y": [0.0, 1.0]}
    for most, letters in ((3.62e-11, 9), (2.0, 2)):
        drawn = force_map({**picture, "value": [[most, 0.0], [-most, most]]})
        low, label = (float(re.findall(rf'x="([0-9.]+)" y="10"[^>]*>{said}', drawn)[0]) for said in ("-", "force, N"))
        assert low - label > 6.0 * letters


def test_an_axis_has_the_prefix_of_its_unit() -> None:
    assert scaled(-2e-3, 1e-3, "displacement, m") == (pytest.approx(1e3), "displacement, mm")
    assert scaled(0.0, 3e-6, "m/s") == (pytest.approx(1e6), "µm/s")
    assert scaled(0.0, 3e-6, "uncalibrated")[1] == "uncalibrated × 10⁻⁶"
    assert scaled(0.0, 0.3, "displacement, m") == (1.0, "displacement, m")


def test_a_report_without_anything_still_makes_a_page() -> None:
    parser = Balanced()
    parser.feed(page(Report(verdict="not_decidable", sentence="Too short.", level="kinematics")))
    assert not parser.open
    assert "Not decidable" in parser.text
    assert "svg" not in parser.seen


def test_a_document_that_was_read_back_gives_the_same_page_pictures(tmp_path: Path) -> None:
    report = full_report()
    there, shown = write_report(report, tmp_path / "deep" / "folder")
    assert json.loads(there.read_text()) == json.loads(strict_json(report))
    assert shown.read_text() == page(report)
    assert {p.name for p in there.parent.iterdir()} == {"report.json", "report.html"}


def test_an_earlier_report_survives_a_failed_one(tmp_path: Path) -> None:
    there, _ = write_report(full_report(), tmp_path)
    before = there.read_text()
    broken = Report(verdict="nonsense", sentence="x", level="machine")  # type: ignore[arg-type]
    with pytest.raises(KeyError):
        write_report(broken, tmp_path)
    assert there.read_text() == before


def test_a_sketch_of_few_parts_fits_a_phone() -> None:
    one = sketch({"bodies": [{"name": "mass"}]}, {"mass": 1.0})
    assert 'viewBox="0 0 360 116"' in one and "plot sketch slim" in one
    many = sketch({"bodies": [{"name": f"m{k}"} for k in range(4)]}, {})
    assert 'viewBox="0 0 720 116"' in many and "slim" not in many


def test_located_parts_stand_out_in_the_sketch() -> None:
    once_wide_once_narrow = 2
    assert page(full_report()).count('class="located"') == once_wide_once_narrow
    assert "located-mesh" in page(full_report())


@pytest.mark.parametrize(
    ("value", "unit", "said"),
    [
        (2.1e-5, "m", "21 µm"),
        (0.5, "1", "0.5"),
        (1.2e7, "N/m", "12 MN/m"),
        (math.nan, "m", "–"),
        (12345.0, "", "12345"),
    ],
)
def test_numbers_for_readers(value: float, unit: str, said: str) -> None:
    assert figure_text(value, unit) == said


def test_curves_keep_their_extremes_when_thinned() -> None:
    x = np.arange(20000.0)
    y = np.zeros(20000)
    y[777], y[15001] = 9.0, -9.0
    _, kept = thinned(x.tolist(), y.tolist())
    assert len(kept) <= MOST_POINTS + 2
    assert (max(kept), min(kept)) == (9.0, -9.0)


def test_ticks_are_round_and_inside() -> None:
    assert ticks(0.0, 1.0, 5) == pytest.approx([0.0, 0.2, 0.4, 0.6, 0.8, 1.0])
    assert ticks(-3e-6, 2e-6, 5) == pytest.approx([-3e-6, -2e-6, -1e-6, 0.0, 1e-6, 2e-6])


def test_a_gap_in_a_curve_is_a_gap() -> None:
    frame = Frame(x=(0, 3), y=(0, 1), x_label="", y_label="")
    drawn = frame.curve([0, 1, 2, 3], [0.5, math.nan, 0.5, 0.6], "observed")
    assert drawn.count("M") == 2
    assert tag("p", "a<b") == "<p>a&lt;b</p>"


def test_what_the_revised_machine_leaves_and_the_sensors_paths_are_told() -> None:
    stage = {"name": "revised machine", "simulated_forms": 7, "level_change_db": 6.02, "left_of_it_db": 1.5}
    path = {"channel": NASTY, "frequency_hz": [100.0, 1000.0], "gain_db": [3.0, -2.0], "noise_db": [-90.0, -80.0]}
    made = replace(full_report(), stages=(stage,), pictures={"paths": [path, {**path, "channel": "two"}]})
    parser = Balanced()
    parser.feed(page(made))
    assert not parser.open
    assert "leaves 1.5 dB of the 6.02 dB" in parser.text and "Paths to the sensors" in parser.text
    assert "script" not in parser.seen and parser.text.count("gain, dB") == 2
    without = replace(full_report(), stages=(), pictures={})
    assert "Simulated, it leaves" not in page(without) and "Paths to the sensors" not in page(without)


def test_an_interval_has_as_many_figures_as_part_its_ends() -> None:
    size = Severity(name="stiffness", value=70005.0, unit="N/m", low=69838.0, high=70173.0)
    assert sizes(size) == ("70 kN/m", "69.8 kN/m", "70.2 kN/m")
    assert sizes(replace(size, low=6.1e4, high=8.2e4)) == ("70 kN/m", "61 kN/m", "82 kN/m")


def test_a_size_of_which_only_a_bound_is_known_is_told_as_a_bound() -> None:
    size = Severity(name="width", value=1.1e-3, unit="m", low=0.0, high=2.2e-3)
    made = replace(
        full_report(), fault=None, causes=(Cause(term="outer_spall", site="a", score=9.0, named=True, severity=size),)
    )
    text = page(made)
    assert "at most 2.2 mm" in text and "1.1 mm" not in text and "0 m" not in text.replace("20 m", "")


def test_a_drawing_has_a_narrow_form_and_a_wider_figure_says_that_it_goes_on() -> None:
    """On a phone four parts fit 360 pixels; frames of 720 scroll under a hint."""
    machine = {"bodies": [{"name": f"b{k}"} for k in range(4)]}
    both = sketch(machine, {"b2": 1.0})
    assert both.count('viewBox="0 0 360 116"') == 1 and both.count('viewBox="0 0 720 116"') == 1
    assert "plot sketch narrow" in both and "plot sketch wide" in both
    whole = page(full_report())
    assert whole.count('class="figure"') == whole.count('class="sideways"') == whole.count('class="plot"') > 0
    assert ".figure::before" in whole and ".sideways { overflow-x:auto }" in whole
