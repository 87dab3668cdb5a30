"""What an answer says beside its label, and which models and pulses cannot answer."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest

from learn.assess import check_heads
from learn.classify import classify
from learn.describe import sites
from learn.model import Model, default_model
from learn.remarks import of_sites
from reconcile.kinematics import KinematicSpec, read_kinematic_spec
from signals.recording import Operating, Recording, Tacho
from sim.core.errors import SpecError
from sim.core.response import Channel

RATE, SPEED = 20_000.0, 25.0


def spec(**bearings: str) -> KinematicSpec:
    listed = [{"name": name, "shaft": "a", "catalogue": size} for name, size in bearings.items()]
    return read_kinematic_spec({"kinematics": {"shafts": [{"name": "a"}], "bearings": listed}})


def recording(samples, pulses=None) -> Recording:  # type: ignore[no-untyped-def]
    return Recording(
        sampling_rate_hz=RATE,
        channels=(Channel(name="c", quantity="acceleration", unit="m/s^2", location="", axis=""),),
        samples=np.stack([samples]),
        operating=Operating(shaft="a", speed_hz=SPEED),
        tacho=None if pulses is None else Tacho(shaft="a", pulse_times_s=pulses, pulses_per_revolution=1),
    )


def test_bearings_of_equal_orders_are_one_and_both_are_named() -> None:
    (both,) = sites(spec(de="6205", nde="6205"), "a")
    assert (both.name, both.alike) == ("de", ("nde",))
    assert any("de: nde has the same orders" in said for said in of_sites([both]))
    assert [s.alike for s in sites(spec(de="6205", nde="6206"), "a")] == [(), ()]


def test_whose_bearing_the_catalogue_has_is_said() -> None:
    (said,) = of_sites(sites(spec(de="6306"), "a"))
    assert "de: 6306 is taken as Timken" in said and "7 balls" in said and "inferred" in said
    orders = {"name": "de", "shaft": "a", "orders": {"bpfo": 3.585, "bpfi": 5.415}}
    stated = read_kinematic_spec({"kinematics": {"shafts": [{"name": "a"}], "bearings": [orders]}})
    assert of_sites(sites(stated, "a")) == []


@pytest.mark.parametrize(
    ("change", "known", "field"),
    [
        (lambda heads: {k: h for k, h in heads.items() if k != "known"}, True, "model.heads"),
        (lambda heads: {k: h for k, h in heads.items() if k != "unknown"}, False, "model.heads"),
        (lambda heads: heads | {"whole": replace(heads["whole"], classes=("a", "b", "c", "d"))}, True, "whole.classes"),
        (lambda heads: heads | {"known": replace(heads["known"], classes=("a", "b", "c", "d"))}, True, "known.classes"),
        (
            lambda heads: heads | {"unknown": replace(heads["unknown"], classes=heads["unknown"].classes[::-1])},
            False,
            "whole.classes",
        ),
    ],
)
def test_a_model_that_cannot_answer_is_refused(change: Callable, known: bool, field: str) -> None:  # type: ignore[type-arg]
    model = default_model()
    check_heads(model, known)
    with pytest.raises(SpecError) as refused:
        check_heads(Model(heads=change(dict(model.heads)), made_by={}), known)
    assert refused.value.problems[0].field.endswith(field)


def test_a_refusal_that_pulses_may_have_caused_names_them(impacts) -> None:  # type: ignore[no-untyped-def]
    slow = np.arange(0.0, 1.6, 0.5)
    with pytest.raises(SpecError) as refused:
        classify(recording(impacts(3.585), slow), default_model())
    assert [p.field for p in refused.value.problems] == ["samples", "tacho"]
    assert "25 Hz are stated" in refused.value.problems[1].message


@pytest.mark.slow
def test_a_sensor_that_hears_nothing_is_said_first() -> None:
    noise = np.random.default_rng(1).standard_normal(60_000)
    found = classify(recording(noise), default_model())
    assert found["remarks"][0].startswith("c: noise") and found["measurement_faults"][0]["kind"] == "noise"
