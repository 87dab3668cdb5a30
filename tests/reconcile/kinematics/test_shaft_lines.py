"""What is told of a shaft's line that grew: what is alike, and what would tell it apart."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.kinematics.shaft_lines import SHAFT_TERMS, shaft_report
from reconcile.kinematics.shafts import MULTIPLES, ShaftChange


def change(multiple: float) -> ShaftChange:
    return ShaftChange(
        shaft="input", multiple=multiple, order=multiple, channel="drive", growth_db=14.0, median_db=9.0, label="1"
    )


@pytest.mark.parametrize("multiple", MULTIPLES)
def test_every_multiple_that_is_looked_at_has_its_look_alikes_and_advice(multiple: float) -> None:
    tests = [SimpleNamespace(label="1", speed=SimpleNamespace(speed_hz=25.0))]
    told = shaft_report([change(multiple)], tests)  # type: ignore[arg-type]
    assert told.verdict == "ambiguous" and [c.term for c in told.causes] == list(SHAFT_TERMS[multiple])
    assert told.where.lines[0].frequency_hz == pytest.approx(25.0 * multiple)
    assert told.next_experiment is not None and "{" not in told.next_experiment.sentence


def test_unbalance_and_bow_load_alike_at_every_speed_so_no_speed_is_asked_for() -> None:
    tests = [SimpleNamespace(label="1", speed=SimpleNamespace(speed_hz=25.0))]
    told = shaft_report([change(1.0)], tests).next_experiment  # type: ignore[arg-type]
    assert told is not None and "Turn input slowly under a dial gauge" in told.sentence
    assert "two more speeds" not in told.sentence
