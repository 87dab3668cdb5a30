"""Examples: bounded, plain JSON, and the effect is seen at its line."""

from __future__ import annotations

import json

import numpy as np
import pytest

from jobs.example import MAX_POINTS, example
from sim.terms import REGISTRY


def level(curve: dict[str, list[float]], hz: float) -> float:
    return float(np.max(np.array(curve["y"])[np.abs(np.array(curve["x"]) - hz) <= 2.1]))


@pytest.mark.parametrize(("key", "kind"), [("unbalance", "amplitude"), ("outer_spall", "envelope")])
def test_the_leading_line_rises_with_the_effect(key, kind):
    found = example(REGISTRY.get(key))
    spectrum, hz = found["spectrum"], found["lines"][0]["frequency_hz"]
    assert spectrum["kind"] == kind
    assert level(spectrum["with"], hz) > 2 * level(spectrum["without"], hz)


@pytest.mark.slow
@pytest.mark.parametrize("key", REGISTRY.keys())
def test_every_effect_has_an_example_of_bounded_size(key):
    found = json.loads(json.dumps(example(REGISTRY.get(key)), allow_nan=False))
    for curve in (*found["signal"].values(), *found["spectrum"].values()):
        if isinstance(curve, dict):
            assert 2 < len(curve["x"]) == len(curve["y"]) <= MAX_POINTS
    assert found["spectrum"]["with"]["x"][-1] <= 10_000.0


@pytest.mark.slow
@pytest.mark.parametrize("key", ["outer_spall", "inner_spall", "ball_spall"])
def test_the_envelope_of_a_spall_shows_its_rate_before_anything_else(key):
    document = example(REGISTRY.get(key))
    curve, lines = document["spectrum"]["with"], document["lines"]
    x, y = np.array(curve["x"]), np.array(curve["y"])
    inner = np.flatnonzero((y[1:-1] > y[:-2]) & (y[1:-1] >= y[2:]) & (x[1:-1] > 4.0)) + 1
    strongest = x[inner[np.argmax(y[inner])]]
    assert strongest == pytest.approx(lines[0]["frequency_hz"], abs=document["spectrum"]["resolution_hz"])
