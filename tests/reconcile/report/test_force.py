"""The pictures of a force: titles, what is which, one axis for curve and map; levels of spectra and their reference."""

from __future__ import annotations

import re

import numpy as np

from reconcile.report import page
from reconcile.report.action import to_do
from reconcile.report.figures.spectrum import spectrum
from reconcile.verdict import Cause, EstimatedForce, Report

LAW = {"x_label": "displacement, m", "y_label": "force beyond linear, N", "x": [-1.0, 0.0, 1.0],
       "force": [-1.0, 0.0, 1.0], "low": [-1.1, -0.1, 0.9], "high": [-0.9, 0.1, 1.1],
       "fitted": [-1.0, 0.0, 1.0]}  # fmt: skip
PLANE = {"x_label": "displacement, m", "y_label": "velocity, m/s", "value_label": "N", "x": [-1.5, 0.5, 2.5],
         "y": [0.0, 1.0], "value": [[1.0, None, 1.0], [-1.0, 2.0, 0.5]]}  # fmt: skip
CAUSE = Cause(term="cubic_support", site="mass", score=9.0, named=True)


def drawn(law: dict[str, object], plane: dict[str, object]) -> str:
    force = EstimatedForce(site="mass", samples={}, law="z", coefficients={})
    pictures = {"law": law, "force_map": plane}
    return page(
        Report(verdict="explained", sentence="x", level="driven", causes=(CAUSE,), force=force, pictures=pictures)
    )


def places(text: str) -> list[list[tuple[str, str]]]:
    """Place and figure of the ticks of the horizontal axis of each panel."""
    panels = re.findall(r"<svg.*?</svg>", text[text.index("Estimated force") :], re.S)
    return [re.findall(r'<text x="([\d.]+)" y="[\d.]+" class="tick mid">([^<]*)<', panel) for panel in panels]


def test_curve_and_map_have_titles_a_legend_and_one_axis() -> None:
    text = drawn(LAW, PLANE)
    for said in (
        "<h3>Force beyond linear over displacement</h3>",
        "<h3>Force over displacement and velocity</h3>",
        "estimated from the recording",
        "its 90 % band",
        "the named law",
        "blank where the motion never came",
    ):
        assert said in text, said
    curve, plane = places(text)
    assert curve == plane and len(curve) > 3
    curve, plane = places(drawn(LAW | {"x_label": "velocity, m/s"}, PLANE))
    assert curve != plane


def test_what_is_not_drawn_is_not_in_the_legend() -> None:
    text = drawn(LAW | {"fitted": None, "low": None}, PLANE)
    assert "estimated from the recording" in text and "the named law" not in text and "90 % band" not in text


def test_levels_have_a_reference_and_end_below_what_was_measured() -> None:
    """Predictions that go on to -250 dB left the measured curve a strip."""
    level = np.linspace(-80.0, -150.0, 50).tolist()
    deep = np.linspace(-80.0, -260.0, 50).tolist()
    picture = {"channel": "z", "frequency_hz": np.linspace(0.0, 100.0, 50).tolist(), "observed_db": level,
               "before_db": deep, "after_db": deep}  # fmt: skip
    drawn_text = spectrum({**picture, "reference": "1 (m)^2/Hz"}, ())
    assert "level, dB re 1 (m)^2/Hz" in drawn_text and "level, dB<" in spectrum(picture, ())
    lowest = min(float(v) for v in re.findall(r'class="tick end">(-\d+)<', drawn_text))
    assert -170.0 <= lowest < -120.0


def test_what_one_drives_is_not_inspected_at_a_stop() -> None:
    said = to_do(Report(verdict="explained", sentence="x", level="driven", causes=(CAUSE,)))
    assert "stop" not in said and "take it into the model of mass" in said
    turning = to_do(Report(verdict="explained", sentence="x", level="machine", causes=(CAUSE,)))
    assert turning.startswith("inspect mass at the next stop")
