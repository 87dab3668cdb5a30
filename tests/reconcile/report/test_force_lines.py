"""The figure of a force by lines: a panel an operating point, both axes logarithmic, what may be nothing apart."""

from __future__ import annotations

import re
from dataclasses import replace

from reconcile.report import page
from reconcile.report.figures.force_lines import by_lines
from reconcile.report.plot import Frame, powers_of_ten
from reconcile.verdict import EstimatedForce, PointForce, Report

SAMPLES = {
    "frequency_hz": (60.0, 690.0, 1380.0), "order": (2.0, 23.0, 34.5), "speed_hz": (30.0, 30.0, 40.0),
    "torque_ratio": (1.0, 1.0, 0.5), "force_n": (0.0, 40.0, 7.0), "low_n": (0.0, 20.0, 4.0),
    "high_n": (9.0, 90.0, 15.0),
}  # fmt: skip
FORCE = EstimatedForce(
    site="bearing2", samples=SAMPLES, law=None, axes=("y",), remarks=("The work cannot be told.",),
    points=(
        PointForce(speed_hz=30.0, torque_ratio=1.0, lines=1, force_n=40.0, low_n=20.0, high_n=90.0),
        PointForce(speed_hz=40.0, torque_ratio=0.5, lines=0, force_n=0.0, low_n=0.0, high_n=15.0),
    ),
)  # fmt: skip


def test_every_point_has_a_panel_with_title_units_and_band() -> None:
    text = page(Report(verdict="unknown_physics", sentence="x", level="machine", force=FORCE))
    part = text[text.index("Estimated force</h2>") :]
    assert "Force over order at 30 Hz</h3>" in part and "Force over order at 40 Hz at 0.5 of the torque</h3>" in part
    assert "40 N rms (90 %: 20 N to 90 N) at 1 line<" in part and "at most 15 N rms of all lines (90 %)" in part
    assert part.count("order of the drive shaft") == 2 and part.count("force rms, N") == 2
    assert "The work cannot be told." in part and "size told: dot, with its 90 % band" in part
    assert "nan" not in part.lower().split("</section>")[0]


def test_what_may_be_nothing_reaches_the_foot_and_what_is_told_does_not() -> None:
    drawn = by_lines(FORCE)
    ends = {
        css: (float(y1), float(y2))
        for y1, y2, css in re.findall(r'y1="([\d.]+)" y2="([\d.]+)" class="(spread[^"]*)"', drawn)
    }
    foot = 280.0 - 40.0
    assert ends["spread open"][0] == foot and ends["spread"][0] < foot
    assert all(y2 < y1 for y1, y2 in ends.values())


def ticks_of(drawn: str, css: str) -> list[str]:
    return re.findall(rf'class="tick {css}">([^<]*)<', drawn)


def test_one_line_alone_has_figures_on_its_axis() -> None:
    one = {**{key: values[1:2] for key, values in SAMPLES.items()}}
    assert len(ticks_of(by_lines(replace(FORCE, samples=one)), "mid")) >= 2


def test_heights_over_many_decades_read_as_newtons() -> None:
    wide = {**SAMPLES, "low_n": (0.0, 0.02, 4.0), "high_n": (9.0, 3e5, 15.0)}
    drawn = by_lines(replace(FORCE, samples=wide))
    heights = ticks_of(drawn, "end")
    assert "force rms, N" in drawn and "kN" not in drawn
    assert {"1", "100", "10000", "1e+05"} <= set(heights) and len(heights) == 16, heights
    assert len(powers_of_ten(1e-9, 1e6)) <= 10


def test_an_open_line_has_its_ring_at_the_upper_end_and_the_legend_says_what_it_is() -> None:
    drawn = by_lines(FORCE)
    open_end = re.search(r'y2="([\d.]+)" class="spread open"', drawn)
    ring = re.search(r'cy="([\d.]+)" r="3.5" class="dot"', drawn)
    assert open_end is not None and ring is not None and open_end[1] == ring[1]
    assert "its 90 % upper end, a ring" in drawn and "order 2: at most 9 N" in drawn
    assert "products of others" in drawn


def test_without_lines_nothing_is_drawn() -> None:
    assert by_lines(EstimatedForce(site="a", samples={}, law=None)) == ""
    assert by_lines(EstimatedForce(site="a", samples=dict.fromkeys(SAMPLES, ()), law=None)) == ""


def test_a_logarithmic_height_is_even_over_decades() -> None:
    frame = Frame(x=(1.0, 10.0), y=(0.1, 1000.0), x_label="", y_label="", log=True, log_y=True)
    steps = [frame.py(10.0**k) - frame.py(10.0 ** (k + 1)) for k in range(-1, 3)]
    assert max(steps) - min(steps) < 1e-6 and steps[0] > 10.0
    assert powers_of_ten(0.05, 2000.0) == [0.1, 1.0, 10.0, 100.0, 1000.0]
    assert powers_of_ten(1.5, 30.0) == [2.0, 5.0, 10.0, 20.0]
