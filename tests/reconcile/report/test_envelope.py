"""The envelope over orders of the level of kinematics is on the page: curves, lines by name, nothing colliding."""

from __future__ import annotations

import re
from dataclasses import replace

import numpy as np
import pytest

from reconcile.kinematics import read_kinematic_spec, reconcile_kinematics
from reconcile.kinematics.picture import POINTS
from reconcile.report import page
from reconcile.report.figures.envelope import LETTER, envelope
from reconcile.report.plot import BOTTOM, TOP
from reconcile.report.style import STYLE
from reconcile.verdict import Report
from tests.strategies.impulses import SPEED_HZ, recorded, sound, train

SPEC = read_kinematic_spec(
    {
        "kinematics": {
            "shafts": [{"name": "shaft"}],
            "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
        }
    }
)
DEPTH = [0.02] * 900
PICTURE = {
    "family": "bearing1.inner",
    "order": 5.4,
    "band_hz": [3000.0, 5000.0],
    "channel": "a0",
    "shaft": "input",
    "speed_hz": 25.0,
    "lines": [
        *({"label": f"{k} BPFI", "order": 5.4 * k, "kind": "own"} for k in (1, 2, 3)),
        {"label": "", "order": 4.4, "kind": "sideband"},
        {"label": "FTF", "order": 0.4, "kind": "other"},
        {"label": "input", "order": 1.0, "kind": "other"},
        {"label": "output", "order": 1.1, "kind": "other"},
        {"label": "beyond", "order": 40.0, "kind": "other"},
    ],
    "test": {"label": "test 1", "order_step": 0.02, "depth": DEPTH},
    "baseline": {"label": "baseline 1", "order_step": 0.02, "depth": DEPTH},
}


def reported(picture: object) -> str:
    pictures = {"envelope": picture}
    return page(Report(verdict="explained", sentence="Found.", level="kinematics", pictures=pictures))


def names(text: str) -> list[tuple[float, float, str]]:
    found = re.findall(r'<text x="([\d.]+)" y="([\d.]+)" class="tick mid said comb-name \w+">([^<]*)<', text)
    return [(float(x), float(y), label) for x, y, label in found]


def test_both_curves_axes_with_units_and_the_lines_are_drawn() -> None:
    text = reported(PICTURE)
    assert "Envelope over orders" in text and "a0, 3000 to 5000 Hz, input at 25 Hz" in text
    assert "order, cycles per turn of input" in text and "depth of modulation" in text
    assert text.count('class="curve observed"') == 1 and text.count('class="curve before"') == 1
    assert text.count('class="comb own"') == 3 and text.count('class="mark side"') == 1
    assert {"1 BPFI", "2 BPFI", "3 BPFI", "FTF"} <= {label for _, _, label in names(text)}
    assert "beyond" not in text


def test_what_wanders_slowly_does_not_flatten_the_lines() -> None:
    lined = [0.5, *DEPTH[1:]]
    lined[270] = 0.1
    text = reported({**PICTURE, "test": {**PICTURE["test"], "depth": lined}})  # type: ignore[dict-item]
    drawn = re.findall(r'<(?:path|polyline)[^>]*class="curve observed"[^>]*>', text)[0]
    points = [(float(x), float(y)) for x, y in re.findall(r"([\d.]+)[, ]([\d.]+)", drawn)]
    floor, (highest, place) = max(y for _, y in points), min((y, x) for x, y in points)
    top, low = TOP, 290.0 - BOTTOM
    assert (low - highest) / (low - top) == pytest.approx(1.0 / 1.3, abs=0.02), "the line fills the frame"
    assert (low - floor) / (low - top) == pytest.approx(0.02 / 0.13, abs=0.02)
    assert place > points[0][0] + 100.0, "and what is slow is not drawn over it"


def test_names_do_not_collide() -> None:
    crowd = [{"label": f"part{i}", "order": 0.3 * i, "kind": "other"} for i in range(1, 40)]
    shown = names(reported({**PICTURE, "lines": [*PICTURE["lines"], *crowd]}))  # type: ignore[misc]
    assert len(shown) > 8
    for i, (x, y, label) in enumerate(shown):
        for x2, y2, other in shown[i + 1 :]:
            assert y != y2 or abs(x - x2) > 0.5 * LETTER * (len(label) + len(other))


def test_without_a_baseline_one_curve_is_drawn_and_without_a_test_none() -> None:
    alone = {k: v for k, v in PICTURE.items() if k != "baseline"}
    assert 'class="curve before"' not in reported(alone) and "</i>baseline" not in reported(alone)
    for broken in ({}, {**PICTURE, "test": None}, {"test": {"depth": []}}, {"test": {"depth": "x", "order_step": 1}}):
        assert envelope(broken) == "" and "Envelope over orders" not in reported(broken)  # type: ignore[arg-type]


def test_where_no_family_is_there_none_is_marked_and_it_is_said() -> None:
    bare = {k: v for k, v in PICTURE.items() if k not in ("family", "order")} | {"lines": []}
    text = reported(bare)
    assert "so none are marked" in text and 'class="curve observed"' in text
    assert 'class="comb' not in text and 'class="mark' not in text and "Violet:" not in text
    assert "so none are marked" not in reported(PICTURE) and "Violet:" in reported(PICTURE)


def test_a_family_has_another_colour_than_the_baseline() -> None:
    """Both were red."""
    rules = dict(re.findall(r"(?<![-\w])(\.before|\.comb\.own|\.mark\.side)[^{}]*{[^}]*stroke:(var\([^)]*\))", STYLE))
    assert rules[".before"] not in (rules[".comb.own"], "var(--bad)") and rules[".comb.own"] != "var(--bad)"


@pytest.mark.slow
def test_the_level_of_kinematics_gives_all_lines_however_long_the_record_is() -> None:
    """1200 bins were a tenth of an order of a long record: no line of a bearing was in the picture."""
    rng = np.random.default_rng(2)
    hurt = recorded(sound(2) + train(rng, 5.4152 * 0.992, 1.0, load=0.8))
    thrice = np.tile(hurt.samples, 3)  # a recorder adds noise of its own: else it is one buffer written again
    long = replace(hurt, samples=thrice + 0.01 * rng.standard_normal(thrice.shape))
    report = reconcile_kinematics(SPEC, [long], [recorded(sound(1))], seed=3)
    assert re.search(r", its depth of modulation \d+ dB above the baseline's", report.sentence), report.sentence
    picture = report.pictures["envelope"]
    assert isinstance(picture, dict) and picture["family"] == "bearing1.inner" and picture["shaft"] == "shaft"
    assert picture["speed_hz"] == pytest.approx(SPEED_HZ, rel=1e-3)
    for name in ("test", "baseline"):
        curve = picture[name]
        assert len(curve["depth"]) <= POINTS
        assert len(curve["depth"]) * curve["order_step"] > 3 * 5.4
    labels = {line["label"]: line["order"] for line in picture["lines"]}
    assert {"BPFI", "2 BPFI", "3 BPFI", "BPFO", "2 BSF", "FTF", "shaft"} <= set(labels)
    curve = picture["test"]
    depth = np.asarray(curve["depth"])
    for name in ("BPFI", "2 BPFI"):
        place = round(labels[name] / curve["order_step"])
        assert depth[place - 2 : place + 3].max() > 10 * np.median(depth)
    assert "2 BPFI" in page(report)


def test_ticks_are_explained_where_there_are_any() -> None:
    side = {"order": 4.6, "kind": "side", "label": "1*f_o1+1*f_r1"}
    assert "ticks on the upper edge" in reported({**PICTURE, "lines": [*PICTURE["lines"], side]})  # type: ignore[misc]
    bare = [x for x in PICTURE["lines"] if x["kind"] in ("own", "other")]  # type: ignore[attr-defined]
    assert "ticks on the upper edge" not in reported({**PICTURE, "lines": bare})
