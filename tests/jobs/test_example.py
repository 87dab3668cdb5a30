"""Examples: bounded, plain JSON, and they show what their effect predicts."""

from __future__ import annotations

import json
from collections.abc import Iterator
from functools import cache
from typing import Any

import numpy as np
import pytest

from jobs import example as module
from jobs.demonstration import demonstration, predicted
from jobs.example import MAX_POINTS, example
from signals.recording import Recording
from sim.core.spec import MachineSpec
from sim.terms import REGISTRY

RISE = 1.99
"""The document gives five digits; the lines are chosen by a factor of 2."""
VISIBLE = 3e-4
"""Least share of the largest amplitude in the picture, whose axis is logarithmic."""
NO_LINES = {
    "coulomb_friction": "damps; moves energy out of all lines",
    "coupling_backlash": "changes the stiffness between the ends of a shaft",
    "coupling_nonlinearity": "changes the stiffness between the ends of a shaft",
    "force_load": "built in: the load's own frequency is not an order of the machine",
    "gravity": "a constant load",
    "squeeze_film": "damps",
    "support_mode": "adds a resonance, not a line",
}
"""Effects that predict no lines, and why."""


@pytest.fixture(scope="module", autouse=True)
def runs() -> Iterator[None]:
    """One run a machine: many effects are shown against the same one without them."""
    made: dict[str, Recording] = {}
    run = module._recorded

    def once(machine: MachineSpec) -> Recording:
        document = machine.model_dump_json()
        if document not in made:
            made[document] = run(machine)
            made[document].samples.flags.writeable = False
        return made[document]

    with pytest.MonkeyPatch.context() as patched:
        patched.setattr(module, "_recorded", once)
        yield


@cache
def shown(key: str) -> dict[str, Any]:
    """An example is half a second of a core, and several tests look at the same one."""
    term = REGISTRY.get(key)
    assert term is not None
    return example(term)


def level(curve: dict[str, list[float]], hz: float) -> float:
    return float(np.max(np.array(curve["y"])[np.abs(np.array(curve["x"]) - hz) <= 1.1]))


def test_the_effects_without_lines_are_those_that_declare_none():
    silent = {term.key for term in REGISTRY if not predicted(term, demonstration(term))}
    assert silent == set(NO_LINES)


@pytest.mark.slow
@pytest.mark.parametrize(("key", "kind"), [("unbalance", "amplitude"), ("outer_spall", "envelope")])
def test_the_leading_line_rises_with_the_effect(key, kind):
    found = shown(key)
    spectrum, hz = found["spectrum"], found["lines"][0]["frequency_hz"]
    assert spectrum["kind"] == kind
    assert level(spectrum["with"], hz) > 2 * level(spectrum["without"], hz)


@pytest.mark.slow
@pytest.mark.parametrize("key", REGISTRY.keys())
def test_every_example_is_of_bounded_size_and_shows_what_its_effect_predicts(key):
    term = REGISTRY.get(key)
    found = json.loads(json.dumps(shown(key), allow_nan=False))
    for curve in (*found["signal"].values(), *found["spectrum"].values()):
        if isinstance(curve, dict):
            assert 2 < len(curve["x"]) == len(curve["y"]) <= MAX_POINTS
    here, there = found["spectrum"]["with"], found["spectrum"]["without"]
    assert here["x"][-1] <= 10_000.0
    marked = found["lines"]
    assert bool(marked) == (key not in NO_LINES)
    assert not {line["label"] for line in marked} & set(found["unseen"])
    for line in marked:
        assert line["frequency_hz"] <= here["x"][-1]
        if there is not None:
            a, b = (level(curve, line["frequency_hz"]) for curve in (here, there))
            assert (b > RISE * a) if term.demo.falls else (a > RISE * b), line
    if marked:
        assert max(level(here, line["frequency_hz"]) for line in marked) >= VISIBLE * max(here["y"])


@pytest.mark.slow
@pytest.mark.parametrize(
    ("key", "expected"),
    [
        ("rub", {"1/2*f_r1", "3/2*f_r1"}),
        ("pedestal_looseness", {"1/2*f_r1", "3/2*f_r1"}),
        ("fit_clearance", {"1*f_o1", "2*f_o1", "3*f_o1"}),
        ("missing_tooth", {"3*f_m-1*f_r1", "3*f_m+1*f_r1"}),
        ("tooth_crack", {"3*f_m-1*f_r1"}),
        ("bearing_stiffness", {"2*f_r1", "3*f_r1"}),
    ],
)
def test_the_lines_that_its_page_speaks_of_are_marked(key, expected):
    assert expected <= {line["label"] for line in shown(key)["lines"]}


@pytest.mark.slow
def test_tip_relief_of_the_default_size_calms_the_mesh():
    found = shown("tip_relief")["signal"]
    assert np.std(found["with"]["y"]) < 0.25 * np.std(found["without"]["y"])


@pytest.mark.slow
@pytest.mark.parametrize("key", ["outer_spall", "inner_spall", "ball_spall"])
def test_the_envelope_of_a_spall_shows_its_rate_before_anything_else(key):
    document = shown(key)
    curve, lines = document["spectrum"]["with"], document["lines"]
    x, y = np.array(curve["x"]), np.array(curve["y"])
    inner = np.flatnonzero((y[1:-1] > y[:-2]) & (y[1:-1] >= y[2:]) & (x[1:-1] > 4.0)) + 1
    strongest = x[inner[np.argmax(y[inner])]]
    assert strongest == pytest.approx(lines[0]["frequency_hz"], abs=document["spectrum"]["resolution_hz"])
