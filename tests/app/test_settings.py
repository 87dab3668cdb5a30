"""Settings from the environment: a wrong one is named, never a traceback."""

from __future__ import annotations

import pytest

from app.settings import Settings
from sim.core.errors import SpecError


@pytest.mark.parametrize(
    ("name", "text"),
    [
        ("SIDEBAND_PORT", "abc"),
        ("SIDEBAND_PORT", "70000"),
        ("SIDEBAND_PORT", "-1"),
        ("SIDEBAND_MAX_DURATION_S", "nan"),
        ("SIDEBAND_MAX_STEPS", "inf"),
        ("SIDEBAND_MAX_WAITING", "many"),
        ("SIDEBAND_API_KEYS_PER_MINUTE", "0.5"),
    ],
)
def test_an_unusable_number_is_named(name: str, text: str) -> None:
    with pytest.raises(SpecError) as caught:
        Settings.from_environment({name: text})
    problem = caught.value.problems[0]
    assert (problem.field, problem.given) == (name, text) and problem.allowed


def test_numbers_are_taken_and_an_empty_text_is_the_default() -> None:
    settings = Settings.from_environment(
        {"SIDEBAND_PORT": "8001", "SIDEBAND_MAX_STEPS": "2e6", "SIDEBAND_MAX_WAITING": ""}
    )
    assert settings.port == 8001
    assert settings.limits.steps == 2_000_000
    assert settings.limits.waiting_jobs == Settings.from_environment({}).limits.waiting_jobs


def test_calls_of_plain_keys_are_bounded_unless_switched_off() -> None:
    assert Settings.from_environment({}).requests_per_minute == 6000
    assert Settings.from_environment({"SIDEBAND_API_KEYS_PER_MINUTE": "90"}).requests_per_minute == 90
    assert Settings.from_environment({"SIDEBAND_API_KEYS_PER_MINUTE": "0"}).requests_per_minute == 0


def test_a_file_of_keys_makes_keys_needed_and_none_does_not() -> None:
    assert Settings.from_environment({"SIDEBAND_API_KEYS_FILE": "keys.json"}).keys_required
    assert not Settings.from_environment({"SIDEBAND_API_KEYS_FILE": ""}).keys_required
