"""Spectra say what they are of, and lines at one place are all named."""

from __future__ import annotations

import re

import numpy as np
import pytest

from reconcile.calibrate.chain import band_centres_hz
from reconcile.report import page
from reconcile.report.figures.envelope import envelope
from reconcile.report.figures.gains import gains
from reconcile.report.figures.sketch import sketch
from reconcile.report.figures.spectrum import in_third_octaves, spectrum
from reconcile.verdict import HeldOut, LineChange, Report, Word

THIRDS = band_centres_hz().tolist()
NARROW = np.linspace(0.0, 2000.0, len(THIRDS)).tolist()


def picture(frequency_hz: list[float]) -> dict[str, object]:
    level = np.random.default_rng(1).normal(size=len(frequency_hz)).tolist()
    curves = dict.fromkeys(("observed_db", "before_db", "after_db"), level)
    return {"channel": "casing", "frequency_hz": frequency_hz, **curves}


def line(label: str, hz: float, change_db: float = 6.0) -> LineChange:
    return LineChange(label=label, frequency_hz=hz, change_db=change_db, channel="casing")


def names(svg: str) -> list[str]:
    return re.findall(r'class="tick mid said [a-z]+-name[^>]*>([^<]*)<', svg)


def test_third_octaves_are_known_by_their_centres() -> None:
    assert in_third_octaves(THIRDS) and in_third_octaves([100.0, 125.9, 158.5])
    assert not in_third_octaves(NARROW) and not in_third_octaves([]) and not in_third_octaves([1.0, 2.0, 4.0])


@pytest.mark.parametrize("verdict", ["explained", "nothing_missing"])
def test_axes_title_and_words_say_third_octaves_where_they_are(verdict: Word) -> None:
    said = [
        page(Report(verdict=verdict, sentence="x", level="machine", pictures={"spectra": [picture(hz)]}))
        for hz in (THIRDS, NARROW)
    ]
    for words in ("Third-octave spectra", "centre of the third octave, Hz", "level of the third octave, dB"):
        assert words in said[0] and words not in said[1]
    assert "single lines are not told apart" in said[0] and "third" not in said[1]
    assert "frequency, Hz" in said[1] and "<h2>Spectra</h2>" in said[1]


def test_families_that_share_a_line_are_both_named() -> None:
    drawn = spectrum(picture(THIRDS), [line("2*f_o1", 300.0), line("f_i2", 300.5, 5.0), line("f_c", 900.0)])
    assert names(drawn) == ["2\u00a0f_o1 or f_i2", "f_c"]


def test_names_stay_on_the_picture() -> None:
    drawn = spectrum(picture(THIRDS), [line("a name that is as long as some are", THIRDS[-1])])
    (at,) = re.findall(r'<text x="([0-9.]+)"[^>]*mark-name', drawn)
    assert float(at) <= 720.0 - 0.5 * 7.0 * 34


def test_in_the_envelope_too() -> None:
    depth = {"label": "test 1", "order_step": 0.01, "depth": [0.1] * 1200}
    lines = [
        {"label": "BPFO", "order": 3.58, "kind": "own"},
        {"label": "2 BSF", "order": 4.7, "kind": "other"},
        {"label": "BPFI", "order": 4.7, "kind": "other"},
        {"label": "output", "order": 1.0, "kind": "other"},
    ]
    drawn = envelope({"shaft": "input", "channel": "de", "band_hz": [1.0, 2.0], "test": depth, "lines": lines})
    assert sorted(names(drawn)) == ["2 BSF or BPFI", "BPFO", "output"]


def test_no_share_above_all_of_it_stands_on_the_axis_of_gains() -> None:
    held = HeldOut(
        metric="m", unit="dB", before=7.0, after=1.0, gain=0.86, gain_low=0.8, gain_high=0.9, retuned=0.1,
        black_box=0.7, placebo=0.4,
    )  # fmt: skip
    told = [float(x) for x in re.findall(r'class="tick mid">(-?[0-9.]+)<', gains(held, "it"))]
    assert max(told) == 100.0 and 0.0 in told


def test_the_ring_around_a_part_leaves_its_name_free() -> None:
    machine = {"shafts": [{"name": "s"}], "bodies": [{"name": "disc", "shaft": "s"}]}
    drawn = sketch(machine, {"disc": 1.0})
    ring = re.search(r'<circle cx="[0-9.]+" cy="([0-9.]+)" r="([0-9.]+)" class="located"', drawn)
    name = re.search(r'y="([0-9.]+)" class="part-name mid">disc<', drawn)
    assert ring and name
    assert float(ring[1]) + float(ring[2]) + 12.0 <= float(name[1]), "a letter is twelve high"
