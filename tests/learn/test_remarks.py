"""What an answer does not say by itself is said beside it."""

from __future__ import annotations

import numpy as np
import pytest

from learn.remarks import check_learnt, of_parts, of_speed
from learn.speed import Speed
from signals.recording import Operating, Recording
from sim.core.errors import SpecError
from sim.core.response import Channel


def recording(speed_hz: float) -> Recording:
    return Recording(
        sampling_rate_hz=1000.0,
        channels=(Channel(name="a", quantity="acceleration", unit="m/s^2", location="", axis=""),),
        samples=np.zeros((1, 10)),
        operating=Operating(shaft="shaft", speed_hz=speed_hz),
    )


@pytest.mark.parametrize("rpm", [1797.0, 1000.0, 600.0])
def test_revolutions_per_minute_are_refused_with_what_to_state(rpm: float) -> None:
    with pytest.raises(SpecError) as refused:
        check_learnt(rpm)
    (problem,) = refused.value.problems
    assert problem.field == "operating.speed_hz" and problem.given == rpm and f"{rpm / 60:.4g} Hz" in problem.message


@pytest.mark.parametrize("speed_hz", [8.0, 29.95, 64.0, 190.0, 400.0, 5000.0])
def test_other_speeds_are_not(speed_hz: float) -> None:
    check_learnt(speed_hz)


def test_how_a_speed_is_known_is_said_where_it_misleads() -> None:
    one = recording(20.0)
    assert of_speed(one, Speed(speed_hz=20.0, method="tacho", standing=0.0)) == []
    assert of_speed(one, Speed(speed_hz=20.0, method="lines", standing=9.0)) == []
    (stated,) = of_speed(one, Speed(speed_hz=20.0, method="stated", standing=0.0))
    assert "no line confirms 20 Hz" in stated
    (found,) = of_speed(one, Speed(speed_hz=20.0, method="scan", standing=0.0))
    assert "none is stated" in found
    (slow,) = of_speed(one, Speed(speed_hz=20.0, method="lines", standing=0.0), ratio=0.25)
    assert "5 Hz is not among" in slow and "minute" not in slow
    (fast,) = of_speed(recording(1797.0), Speed(speed_hz=1797.0, method="given", standing=0.0))
    assert "as revolutions per minute it would be 29.95 Hz" in fast


def part(label: str, chance: float, *, z: float = 9.0, stage: str | None = None, geometry: str = "known") -> dict:
    lines = [{"family": family, "z": z} for family in ("BPFO", "BPFI", "2 BSF")]
    return {
        "bearing": None if stage else "drive", "stage": stage, "label": label, "probabilities": {label: chance},
        "geometry": geometry, "lines": lines,
    }  # fmt: skip


def test_a_sure_answer_of_a_race_needs_no_remark() -> None:
    assert of_parts([part("inner", 0.98), part("healthy", 0.9, z=0.2)]) == []


def test_a_bearing_beside_a_damaged_tooth_is_not_to_be_acted_on() -> None:
    tooth = {**part("tooth", 1.0, stage="m1"), "gear": "pinion"}
    hollow = {**part("ball", 0.89, z=1.9), "lines": [{"family": "4 FTF", "z": 8.9}, {"family": "2 BSF", "z": 1.9}]}
    said = of_parts([part("healthy", 0.9), hollow, tooth])
    assert any("do not act on 'ball'" in one and "the damaged tooth at pinion" in one for one in said)
    assert sum("damaged tooth" in one for one in said) == 1, "a healthy one needs no word"
    firm = of_parts([part("inner", 0.98, z=16.0), tooth])
    assert any("stands beside the damaged tooth" in one for one in firm) and not any(
        "do not act" in one for one in firm
    )
    assert not any("damaged tooth" in one for one in of_parts([hollow, part("healthy", 0.9, stage="m1")]))


def test_what_is_unsure_is_said() -> None:
    (low,) = of_parts([part("outer", 0.57)])
    assert "0.57 is below 0.7" in low
    (ball,) = of_parts([part("ball", 0.97)])
    assert "balls are the least sure" in ball
    (hollow,) = of_parts([part("inner", 0.9, z=1.1)])
    assert "no line that stands out" in hollow and "1.1" in hollow
    (vague,) = of_parts([part("inner", 0.9, geometry="unknown")])
    assert "size is not known" in vague
    (gear,) = of_parts([part("tooth", 0.9, stage="m1")])
    assert gear.startswith("m1: ") and "measurement" in gear
