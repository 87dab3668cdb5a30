"""Names, sizes and shares in a reader's words: no keys of the program, nothing told that is not there."""

from __future__ import annotations

import re
from dataclasses import replace
from pathlib import Path

import pytest

from reconcile.force_law import library
from reconcile.force_law.library import Law
from reconcile.report import page
from reconcile.report.figures.bars import NARROW, WIDE, ranking
from reconcile.report.figures.gains import gains as gain_bars
from reconcile.report.plot import RIGHT, fitting, text_width
from reconcile.report.words import LAWS, cause, cause_key, gain, gains, percent, severity, size_name, sizes, tidied
from reconcile.verdict import Cause, EstimatedForce, HeldOut, Placebo, Report, Severity
from tests.reconcile.report.test_reader import HELD, told

ROOT = Path(__file__).resolve().parents[3]
STOPS = Cause(
    term="custom_force", site="mass", score=40.0, named=True, reasons=("stops on both sides",),
    severity=Severity(name="stops", value=4.07e5, unit="N/m", low=3.85e5, high=4.29e5),
)  # fmt: skip
BARE = HeldOut(
    metric="free-run NRMSE", unit="1", before=0.87, after=0.0026, gain=0.997, gain_low=0.9969, gain_high=0.9971,
    retuned=None, black_box=None, placebo=None, held="the part that was held out",
)  # fmt: skip


def driven(found: Cause, **more: object) -> Report:
    return replace(Report(verdict="explained", sentence="x", level="driven", causes=(found,)), **more)  # type: ignore[arg-type]


def test_laws_have_the_words_of_their_library() -> None:
    assert {law.key: law.words for law in vars(library).values() if isinstance(law, Law)} == LAWS


def test_the_dashboard_has_the_same_words() -> None:
    script = (ROOT / "app/dashboard/static/js/lib/laws.js").read_text(encoding="utf-8")
    assert dict(re.findall(r"^  (\w+): \"([^\"]+)\",$", script, re.M)) == LAWS


@pytest.mark.parametrize(
    ("term", "size", "said", "tile"),
    [
        ("custom_force", "stops", "stops on both sides at mass", ""),
        ("cubic_support", "cubic", "cubic support, odd stiffness at mass", ""),
        ("cubic_support", "k3", "cubic support at mass", "k3"),
        ("custom_force", "scale", "custom force at mass", "scale"),
        ("coulomb_friction", "dry_friction", "coulomb friction at mass", ""),
        ("stiffness", "stiffness", "stiffness at mass", ""),
        ("inner_spall", "width", "inner spall at mass", "width"),
    ],
)
def test_an_effect_and_its_size_are_called_once(term: str, size: str, said: str, tile: str) -> None:
    found = replace(STOPS, term=term, severity=Severity(name=size, value=4.0, unit="N", low=3.0, high=5.0))
    assert (cause(found), size_name(found)) == (said, tile)
    assert severity(found) == f"{tile} 4 N (90 %: 3 N to 5 N)".strip()
    text = told(driven(found))
    assert f"{tile} of {said}, 90 %" in text if tile else f"4 N{said}, 90 %: 3 N to 5 N" in text


def test_a_size_with_a_power_of_ten_has_three_figures() -> None:
    """Two said 4.0e+10 (4.0e+10 to 4.1e+10) of what is told to 4.02e+10."""
    size = Severity(name="cubic", value=4.0207e10, unit="N/m^3", low=3.9584e10, high=4.083e10)
    assert sizes(size) == ("4.02e+10 N/m³", "3.96e+10 N/m³", "4.08e+10 N/m³")


def test_a_changed_number_is_told_as_a_change() -> None:
    size = Severity(name="stiffness", value=1.15e5, unit="N/m", low=1.13e5, high=1.17e5)
    text = told(driven(replace(STOPS, term="stiffness", severity=size), held_out=BARE))
    assert "without the change of stiffness at mass" in text
    assert "without stops on both sides at mass" in told(driven(STOPS, held_out=BARE))


def test_the_list_tells_a_law_by_its_name() -> None:
    assert cause_key(STOPS) == "stops@mass"
    assert cause_key(replace(STOPS, term="outer_spall", site="bearing1")) == "outer_spall@bearing1"


def test_a_law_is_told_with_its_unit() -> None:
    force = EstimatedForce(site="mass", samples={}, law="4.07e+05 sgn z", coefficients={"stops": 4.07e5})
    assert "stops on both sides: 407 kN/m" in told(driven(STOPS, force=force))


def test_the_ends_of_an_interval_of_a_gain_part() -> None:
    assert gain(BARE) == "99.70 % (90 %: 99.69 % to 99.71 %)"
    assert gain(HELD) == "40 % (90 %: 20 % to 55 %)"
    assert gains(replace(BARE, gain=1.0, gain_low=1.0, gain_high=1.0)) == ("100 %", "100 %", "100 %")


def test_only_what_is_drawn_is_explained() -> None:
    bare, full = told(driven(STOPS, held_out=BARE)), told(driven(STOPS, held_out=HELD))
    for word in ("Retuned", "Black box", "Placebos", "An effect that is there", "Expected of a perfect model"):
        assert word not in bare and word in full
    assert "Line through a bar's end" in bare and "Held out:" not in bare and "Held out: each" in full
    assert "retuned parameters only" not in bare and "retuned parameters only" in full
    assert bare.split("gain over")[1].count("–") == 1, "of the model without it"
    assert "the middle of them" in full
    best = (Placebo(term="rub", site="fan", gain=0.1, draws=9),)
    assert "the middle and the strongest of them" in told(driven(STOPS, held_out=replace(HELD, placebos=best)))
    half = told(driven(STOPS, held_out=replace(BARE, retuned=0.1)))
    assert "Retuned" in half and "Black box" not in half


def test_what_was_seen_of_a_fault_reads_well() -> None:
    assert tidied("held: 100.000% of the samples; 1 stretches, the first at 0 to 5 s") == (
        "held: 100 % of the samples; one stretch, 0 to 5 s"
    )
    assert tidied("cut off: 2.125% of the samples; 3 stretches, the first at 1 to 2 s") == (
        "cut off: 2.12 % of the samples; 3 stretches, the first at 1 to 2 s"
    )
    assert tidied("the error falls from 12.345 % to 0.26 %") == "the error falls from 12.345 % to 0.26 %"
    assert "100 % of" in told(driven(STOPS, sentence="held (100.000% of the samples)"))


@pytest.mark.parametrize(("mode", "said"), [("A", "the baseline"), ("B", "the model")])
def test_the_spectra_say_what_they_are_held_against(mode: str, said: str) -> None:
    spectra = [{"channel": "a", "frequency_hz": [1.0, 2.0], "observed_db": [0.0, 1.0], "before_db": [0.0, 0.5]}]
    report = replace(driven(STOPS, pictures={"spectra": spectra}), level="machine", stages=({"mode": mode},))
    assert f">without it: {said}<" in page(report)
    assert ">without it: the model<" in page(replace(report, level="driven"))


def test_names_of_rows_are_cut_where_they_have_no_room() -> None:
    long = "one-sided Hertz contact, −(−z − 0.377 mm)₊^1.5 beside stops on both sides"
    rows = [{"label": name, "score": 1.0, "low": 0.0, "high": 2.0, "named": name == long} for name in (long, "short")]
    drawn = ranking(rows)
    for layout, room in ((WIDE, WIDE.left), (NARROW, NARROW.width)):
        svg = next(part for part in drawn.split("</svg>") if layout.css in part)
        shown = re.findall(r'class="row-name[^>]*>([^<]+)<', svg)
        assert shown[0].endswith("…") and shown[0].startswith("one-sided Hertz contact") and shown[1] == "short"
        assert text_width(shown[0], bold=True) < room
    assert fitting("short", 400.0) == "short"


def test_the_figure_behind_a_bar_has_room() -> None:
    found = replace(BARE, gain=0.88, gain_low=0.8, gain_high=0.97, retuned=-0.41, placebo=0.05)
    for svg in gain_bars(found, "stops on both sides at mass").split("</svg>")[:2]:
        width = float(re.findall(r'viewBox="0 0 ([0-9.]+)', svg)[0])
        for at, said in re.findall(r'x="([0-9.]+)"[^>]*class="tick said">([^<]+)<', svg):
            assert float(at) + text_width(said, size=11.0) <= width - RIGHT + 0.1, said


def test_a_table_tells_each_cell_with_its_head_where_the_screen_is_narrow() -> None:
    assert '<td data-head="score">40</td>' in page(driven(STOPS))


def test_a_share_that_rounds_to_nothing_has_no_sign() -> None:
    assert [percent(x) for x in (-0.001, 0.0, -0.14, 0.155, None)] == ["0 %", "0 %", "-14 %", "16 %", "–"]


def test_a_gain_that_rounds_to_nothing_has_no_sign() -> None:
    assert gains(replace(HELD, gain=-0.001, gain_low=-0.02, gain_high=0.01)) == ("0 %", "-2 %", "1 %")
