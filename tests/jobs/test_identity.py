"""Identity: the same meaning is the same id, another meaning another."""

from __future__ import annotations

import json

import pytest
from hypothesis import given
from hypothesis import strategies as st

from jobs.identity import canonical_json, job_id
from jobs.limits import Limits
from jobs.request import SimulationRequest
from jobs.resolve import resolve
from tests.service.fakes import FakeEngine, machine

documents = st.recursive(
    st.none()
    | st.booleans()
    | st.integers(-(2**53), 2**53)
    | st.floats(allow_nan=False, allow_infinity=False)
    | st.text(),
    lambda inner: st.lists(inner, max_size=4) | st.dictionaries(st.text(), inner, max_size=4),
    max_leaves=12,
)


@pytest.mark.slow
@given(documents)
def test_canonical_text_means_the_document(document: object) -> None:
    assert json.loads(canonical_json(document)) == document


@pytest.mark.slow
@given(st.dictionaries(st.text(), st.integers(), min_size=2, max_size=6))
def test_order_of_keys_does_not_matter(document: dict[str, int]) -> None:
    assert canonical_json(dict(reversed(document.items()))) == canonical_json(document)


def test_nan_has_no_canonical_text() -> None:
    with pytest.raises(ValueError):
        canonical_json(float("nan"))


def identity(**body: object) -> str:
    resolved = resolve(SimulationRequest.model_validate(body), FakeEngine(), Limits())
    return job_id("simulation", resolved.document, "v1")


def test_preset_override_and_spelled_out_machine_are_one_job() -> None:
    by_override = identity(preset="oscillator", set={"bodies.mass.stiffness_y_n_per_m": 5e4})
    spelled = identity(machine=machine(stiffness=50000).model_dump(mode="json"))
    assert by_override == spelled
    assert len(spelled) == 32 and set(spelled) <= set("0123456789abcdef")


@pytest.mark.parametrize("change", [{"seed": 1}, {"duration_s": 0.9}, {"channels": ["mass.y.displacement"]}])
def test_every_setting_that_changes_the_result_changes_the_id(change: dict[str, object]) -> None:
    assert identity(preset="oscillator", **change) != identity(preset="oscillator")


def test_whole_numbers_may_be_written_either_way() -> None:
    assert identity(preset="oscillator", duration_s=2) == identity(preset="oscillator", duration_s=2.0)


def test_another_physics_is_another_job() -> None:
    assert job_id("simulation", {"a": 1}, "v1") != job_id("simulation", {"a": 1}, "v2")
