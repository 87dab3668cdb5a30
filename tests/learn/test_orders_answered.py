"""Whatever orders a bearing is stated to have, they are answered or refused."""

from __future__ import annotations

import warnings

import numpy as np
import pytest
from hypothesis import HealthCheck, example, given, settings
from hypothesis import strategies as st

from learn.classify import classify
from learn.describe import sites
from learn.model import default_model
from reconcile.kinematics import read_kinematic_spec
from signals.recording import Operating, Recording
from sim.core.errors import SpecError
from sim.core.response import Channel

NOISE = Recording(
    sampling_rate_hz=5000.0,
    channels=(Channel(name="a", quantity="acceleration", unit="m/s^2", location="", axis=""),),
    samples=np.random.default_rng(3).standard_normal((1, 5000)),
    operating=Operating(shaft="a", speed_hz=25.0),
)
"""25 turns: two stretches, and so also the answer by the whole."""
POSITIVE = st.floats(min_value=0, exclude_min=True, allow_infinity=False)
PLAUSIBLE = st.builds(lambda z, g: (z / 2 * (1 - g), z / 2 * (1 + g)), st.integers(3, 64), st.floats(1e-3, 0.89))


def answer(orders: dict[str, float | None]) -> dict:  # type: ignore[type-arg]
    """Of noise and a bearing with these orders."""
    bearing = {"name": "de", "shaft": "a", "orders": {k: v for k, v in orders.items() if v is not None}}
    spec = read_kinematic_spec({"kinematics": {"shafts": [{"name": "a"}], "bearings": [bearing]}})
    return classify(NOISE, default_model(), sites(spec, "a"), trust_speed=True)


@pytest.mark.slow
@settings(max_examples=60, deadline=None, derandomize=True, suppress_health_check=[HealthCheck.too_slow])
@given(
    races=st.one_of(PLAUSIBLE, st.tuples(POSITIVE, POSITIVE)),
    bsf=st.one_of(st.none(), POSITIVE, st.floats(0.3, 30)),
    ftf=st.one_of(st.none(), POSITIVE, st.floats(0.01, 0.99)),
)
@example(races=(5.4, 3.5), bsf=None, ftf=None)
@example(races=(3.585, 5.415), bsf=0.1, ftf=None)
@example(races=(3.585, 5.415), bsf=None, ftf=0.5)
@example(races=(31.9, 32.1), bsf=None, ftf=None)
@example(races=(0.21, 2.79), bsf=None, ftf=None)
def test_any_orders_are_answered_or_refused(races: tuple[float, float], bsf: float | None, ftf: float | None) -> None:
    try:
        with warnings.catch_warnings(action="error"):
            found = answer({"bpfo": races[0], "bpfi": races[1], "bsf": bsf, "ftf": ftf})
    except SpecError as error:
        assert all(p.field and p.message for p in error.problems)
    else:
        assert sum(found["probabilities"].values()) == pytest.approx(1.0)


@pytest.mark.slow
def test_a_bearing_whose_outer_ring_turns_is_answered_and_remarked() -> None:
    found = answer({"bpfo": 3.585, "bpfi": 5.415, "bsf": 2.357, "ftf": 0.602})
    assert len(found["lines"]) == 4
    assert any("outer ring turns" in remark for remark in found["remarks"])


@pytest.mark.slow
def test_lines_beyond_what_is_searched_are_told() -> None:
    found = answer({"bpfo": 19.8, "bpfi": 20.2, "bsf": None, "ftf": None})
    assert any("2 BSF above order" in remark for remark in found["remarks"])
    assert "2 BSF" not in [line["family"] for line in found["lines"]]
