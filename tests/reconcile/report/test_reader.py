"""What a reader of the page is told: forms, remarks, operating points, gains with their limit, axes with units."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from reconcile.judge.screen import Screen
from reconcile.machine.decide import decide
from reconcile.report import page
from reconcile.report.held import METRICS
from reconcile.report.panels import MOST_PANELS
from reconcile.report.plot import Frame, decades
from reconcile.report.score import SCORE
from reconcile.report.words import FORMS, LEFT_OVER, PART_LEFT, WIDTH_BELOW
from reconcile.verdict import AngleWindow, Cause, HeldOut, LineChange, Report, Where, operating_point
from tests.reconcile.report.test_report import Balanced, full_report

ROOT = Path(__file__).resolve().parents[3]
HELD = HeldOut(
    metric="log_spectral_distance", unit="dB", before=7.0, after=4.2, gain=0.4, gain_low=0.2, gain_high=0.55,
    retuned=-3.5, black_box=-0.02, placebo=0.01, ceiling=0.79,
    held="each operating point in turn, fitted on the others: 22.5 Hz, 30 Hz",
)  # fmt: skip


def told(report: Report) -> str:
    parser = Balanced()
    parser.feed(page(report))
    assert not parser.open
    return parser.text


def measured(points: int = 3, channels: int = 2) -> dict[str, object]:
    """Pictures as the engine makes them, of 20 Hz, 21 Hz and so on."""
    names = [f"bearing{c + 1}.outer.y.acceleration" for c in range(channels)]
    bands = (25.0 * 10.0 ** (np.arange(27) / 10.0)).tolist()
    level = np.random.default_rng(1).normal(size=27)
    spectra = [
        {"channel": name, "speed_hz": 20.0 + p, "torque_ratio": 1.0, "frequency_hz": bands, "observed_db": level + c,
         "before_db": level, "after_db": level}
        for p in range(points)
        for c, name in enumerate(names)
    ]  # fmt: skip
    value = np.random.default_rng(2).normal(size=(channels, 72))
    heat = [
        {"shaft": "input", "speed_hz": 20.0 + p, "torque_ratio": 1.0, "angle_deg": 5.0 * np.arange(72) + 2.5,
         "rows": names, "value": value, "value_label": "energy, dB over the mean of the baseline"}
        for p in range(points)
    ]  # fmt: skip
    return {"spectra": spectra, "heat": heat}


def drawn(**pictures: object) -> Report:
    return Report(verdict="explained", sentence="x", level="machine", pictures={**measured(), **pictures})


def test_table_and_ranking_tell_the_same_forms() -> None:
    rows = [("fit_clearance", 44.1, ""), ("rub", 43.0, ""), ("bearing_stiffness", 41.8, "fit_clearance@bearing1")]
    ranking = [
        {
            "label": f"{term}@bearing1",
            "score": score,
            "low": score - 1,
            "high": score + 1,
            "named": False,
            "form_of": of,
        }
        for term, score, of in rows
    ]
    causes = (
        Cause(term="fit_clearance", site="bearing1", score=44.1, forms={"bearing_stiffness": 41.8}),
        Cause(term="rub", site="bearing1", score=43.0),
    )
    text = told(replace(drawn(ranking=ranking), causes=causes))
    assert "or: bearing stiffness (41.8)" in text
    places = [text.index(s) for s in ("fit clearance at", "or: bearing stiffness at bearing1", "rub at")]
    assert places == sorted(places), "a form stands under the effect that it counts with"
    assert FORMS in text
    assert FORMS not in told(replace(drawn(), causes=causes[1:]))


def test_a_name_with_a_rest_says_what_that_means_and_what_to_do() -> None:
    values = np.array([30.0, 0.0])
    screen = Screen(
        names=("outer_spall@bearing1", "rub@pinion"), evidence=values, direct=np.array([20.0, 0.0]),
        weights=np.array([1.0, 0.0]), by=np.zeros(2, dtype=int), p_any=0.0, strongest=10.0, p_best=0.0, p_direct=0.0,
        misfit=0.999, length=90.0,
    )  # fmt: skip
    decision = decide(screen, views=9)
    assert decision.word == "explained" and decision.reasons
    causes = tuple(
        Cause(term=t, site=s, score=1.0, named=n, reasons=decision.reasons)
        for t, s, n in (("outer_spall", "bearing1", True), ("rub", "pinion", False))
    )
    assert decision.reasons[0] not in told(replace(drawn(), causes=causes[:1]))
    text = told(replace(drawn(), causes=causes))
    assert text.count(LEFT_OVER) == 1
    assert decision.reasons[0] not in text, "once, in plain words, and not of effects that are not named"
    assert LEFT_OVER not in told(replace(drawn(), causes=tuple(replace(c, reasons=()) for c in causes)))


def test_a_reason_of_all_is_said_once() -> None:
    causes = tuple(Cause(term="rub", site=s, score=1.0, reasons=("the place is not decided",)) for s in "abc")
    text = told(replace(drawn(), verdict="ambiguous", causes=causes))
    assert text.count("the place is not decided") == 1
    own = (*causes, Cause(term="rub", site="d", score=1.0, reasons=("once a turn",)))
    assert told(replace(drawn(), causes=own)).count("once a turn") == 1


@pytest.mark.parametrize(("unit", "said"), [("deviations", "robust deviations"), ("dB", "by how many decibels")])
def test_a_score_of_frequencies_alone_says_its_unit(unit: str, said: str) -> None:
    cause = Cause(term="rub", site="pinion", score=9.0, score_unit=unit)
    text = told(replace(drawn(), level="kinematics", causes=(cause,)))
    assert text.count("Score: ") == 1 and said in text
    assert said not in told(replace(drawn(), causes=(cause,)))


def test_a_score_is_evidence_only_where_there_is_a_model() -> None:
    report = replace(drawn(), causes=(Cause(term="rub", site="pinion", score=9.0),))
    assert SCORE in told(report)
    assert SCORE not in told(replace(report, level="kinematics"))


def test_every_operating_point_is_there_and_says_which_it_is() -> None:
    whole = page(drawn())
    assert whole.count("<summary>Operating point 20 Hz</summary>") == 2
    assert whole.count('<details class="point" open="">') == 2, "the first one of spectra and turns is open"
    text = told(drawn())
    for speed in (20, 21, 22):
        assert f"bearing2.outer.y.acceleration, {speed} Hz" in text
        assert f"Shaft input at {speed} Hz" in text
    assert "Operating point" not in told(
        Report(verdict="explained", sentence="x", level="machine", pictures=measured(1))
    )
    assert operating_point(30.0, 0.5) == "30 Hz at 0.5 of the torque"


@pytest.mark.slow
def test_a_page_of_many_points_and_channels_stays_small() -> None:
    whole = page(drawn(**measured(24, 40)))
    assert len(whole) < 3e6
    assert f"{40 - MOST_PANELS // 24} channels that changed less are left out" in whole
    assert "bearing40.outer.y.acceleration, 43 Hz" in whole, "what changed most is kept at every point"
    assert "bearing1.outer.y.acceleration, 43 Hz" not in whole


def test_lines_say_their_operating_point_and_are_marked_in_its_spectrum_alone() -> None:
    line = LineChange(
        label="3*f_m", frequency_hz=900.0, change_db=9.0, channel="bearing1.outer.y.acceleration", speed_hz=21.0
    )
    report = replace(drawn(), where=Where(lines=(line,)))
    assert "operating point" in told(report) and "21 Hz" in told(report)
    marks = page(report).split('class="mark up"')
    assert len(marks) == 2
    assert marks[0].rindex("acceleration, 21 Hz") > marks[0].rindex("acceleration, 20 Hz")
    unknown = replace(report, where=Where(lines=(replace(line, speed_hz=None),)))
    assert "operating point" not in told(unknown)


def test_held_out_data_are_drawn_with_interval_limit_and_rivals() -> None:
    report = replace(drawn(), held_out=HELD, causes=(Cause(term="rub", site="pinion", score=9.0, named=True),))
    whole, text = page(report), told(report)
    assert "Held out: each operating point in turn, fitted on the others: 22.5 Hz, 30 Hz." in text
    limits = ("expected of a perfect model: 1.47 dB", "expected of a perfect model: 79 %")
    figures = ("7 dB", "4.2 dB", "40 % (90 %: 20 % to 55 %)", "-350 %, beyond the scale")
    for said in ("without rub at pinion", "with rub at pinion", "placebo", *limits, *figures):
        assert said in text, said
    assert whole.count('class="whisker"') == 2 * 3, "for wide and for narrow screens"
    assert whole.count('class="bar on"') == 2 * 2 and whole.count('class="bar rival"') == 2 * 3
    assert "interval is above zero" in text
    assert "interval reaches zero" in told(replace(report, held_out=replace(HELD, gain_low=-0.1)))
    assert "Not beaten" not in text
    close = told(replace(report, held_out=replace(HELD, black_box=0.38, retuned=0.25)))
    assert "Not beaten by more than the interval: retuned parameters (25 %), the black box (38 %)" in close


def test_held_out_figures_that_are_none_draw_nothing_wrong() -> None:
    gone = replace(HELD, gain=math.nan, gain_low=math.nan, before=math.nan, after=math.nan, ceiling=None)
    whole = page(replace(drawn(), held_out=gone))
    assert "nan" not in whole and "expected of a perfect model:" not in whole


def test_a_turn_has_sensors_degrees_and_a_scale_with_its_unit() -> None:
    report = replace(
        drawn(), where=Where(angle_window=AngleWindow(shaft="input", centre_deg=5.0, low_deg=-5.0, high_deg=15.0))
    )
    whole, text = page(report), told(report)
    for said in ("angle of shaft input, degrees", "sensor", "energy, dB over the mean of the baseline"):
        assert said in text, said
    assert ">315</text>" in whole and ">360</text>" in whole
    assert whole.count('class="window"') == 6, "in two pieces at each of three points"
    ordered = {"shaft": "input", "angle_deg": [0.0, 90.0], "order": [1.0, 2.0], "value": [[2.0, -1.0], [0.0, 2.0]]}
    plain = told(drawn(heat=ordered))
    assert "order of shaft input" in plain and "change, dB" in plain


def test_over_a_turn_only_sensors_that_change_over_it_are_drawn() -> None:
    flat = {"shaft": "input", "angle_deg": [0.0, 90.0, 180.0], "rows": ["still", "lively"]}
    text = told(drawn(heat={**flat, "value": [[1.0, 2.0, 3.9], [0.0, None, 3.1]]}))
    assert "lively" in text and "still" not in text and "left out: 1." in text
    assert "Over the turn of a shaft" not in told(drawn(heat={**flat, "value": [[1.0, 2.0, 3.9], [0.0, None, 2.0]]}))
    assert "nothing stands out over the turn" not in told(drawn())


def test_a_measure_is_explained_where_it_is_told() -> None:
    text = told(drawn_with("free-run NRMSE"))
    assert "Measure: free-run NRMSE, the error's root mean square over the spread of what was measured" in text
    assert "Measure: log spectral distance, how far the predicted" in told(drawn_with(HELD.metric))
    assert "Measure: share of lines." in told(drawn_with("share_of_lines"))


def drawn_with(metric: str) -> Report:
    return replace(drawn(), held_out=replace(HELD, metric=metric))


class Pictures(Balanced):
    """Text of the page as the dashboard shows it: without what is `told`."""

    def __init__(self) -> None:
        super().__init__()
        self.told: list[bool] = []

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        super().handle_starttag(tag, attrs)
        if len(self.open) > len(self.told):
            self.told.append(dict(attrs).get("class") == "told" or any(self.told))

    def handle_endtag(self, tag: str) -> None:
        super().handle_endtag(tag)
        self.told.pop()

    def handle_data(self, data: str) -> None:
        self.text += "" if any(self.told) else data


@pytest.mark.slow
def test_what_the_dashboard_leaves_out_are_words_and_tables() -> None:
    report = full_report("A sentence.")
    whole, parser = page(report), Pictures()
    script = (ROOT / "app/dashboard/static/js/reconcile/answer.js").read_text(encoding="utf-8")
    assert 'const TOLD = ".told";' in script and 'class="told"' in whole
    parser.feed(whole)
    for left_out in ("locked to", "severity", "gain over", "Revised machine (JSON)", "Limits", "What is undecided"):
        assert left_out in told(report) and left_out not in parser.text, left_out
    for kept in (
        "Loads back into the simulator",
        "angle of shaft input",
        "share of that error taken off",
        "score: log evidence",
        "frequency, Hz",
    ):
        assert kept in parser.text, kept


def test_the_dashboard_says_it_in_the_same_words() -> None:
    script = (ROOT / "app/dashboard/static/js/reconcile/answer.js").read_text(encoding="utf-8")
    assert FORMS in script and LEFT_OVER in script and f'"{PART_LEFT}"' in script
    assert f"cause.values?.{WIDTH_BELOW};" in script
    for words in METRICS.values():
        assert f'"{words}"' in script


def test_third_octaves_have_a_logarithmic_axis() -> None:
    frame = Frame(x=(25.0, 2500.0), y=(0.0, 1.0), x_label="", y_label="", log=True)
    assert math.isclose(frame.px(250.0), 0.5 * (frame.px(25.0) + frame.px(2500.0)))
    assert decades(25.0, 2500.0) == [50.0, 100.0, 200.0, 500.0, 1000.0, 2000.0]
