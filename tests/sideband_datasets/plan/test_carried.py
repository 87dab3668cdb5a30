"""Sampling rates that cannot carry the lines of the classes."""

from __future__ import annotations

import pytest

from sideband_datasets import make_plan
from sim.core.errors import SpecError
from tests.sideband_datasets.small import document, tiny

LONG = {"duration_s": 1.0, "windows": {"length_s": 0.5}}


def test_a_rate_below_every_line_of_a_class_is_refused_with_the_one_it_needs():
    with pytest.raises(SpecError) as told:
        make_plan(tiny(sampling_rate_hz=100, **LONG))
    first = told.value.problems[0]
    assert (first.field, first.given) == ("sampling_rate_hz", 100)
    least = float(first.allowed.removeprefix(">= "))
    assert not make_plan(tiny(sampling_rate_hz=least, **LONG)).warnings


def test_a_rate_below_the_third_harmonic_is_warned_of():
    told = make_plan(tiny(sampling_rate_hz=400, **LONG)).warnings
    assert any("class outer: sampling_rate_hz 400 Hz carries fewer than 3 harmonics" in line for line in told)
    assert not make_plan(tiny()).warnings


def test_the_clock_of_the_chain_counts():
    chain = document()["measurement"]
    chain[0]["chain"]["clock"] = {"sampling_rate_hz": 400}
    told = make_plan(tiny(measurement=chain, **LONG)).warnings
    assert any("measurement.chain.clock.sampling_rate_hz 400 Hz" in line for line in told)


def test_an_effect_of_one_line_needs_only_that():
    faults = [{"name": "unbalance", "terms": [{"term": "unbalance", "sites": ["disc"]}]}]
    assert not make_plan(tiny(faults=faults, sampling_rate_hz=100, **LONG)).warnings
