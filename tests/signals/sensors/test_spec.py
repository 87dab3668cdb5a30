"""The chain as it is written: presets, bounds, what is refused."""

from __future__ import annotations

import json
from pathlib import Path

import pytest
from pydantic import ValidationError

from signals.sensors import PRESETS, SensorChain
from signals.sensors.spec import MAX_CHANNELS

PLACE = {"location": "disc"}


def channel(**more: object) -> dict:
    return {"kind": "accelerometer", "name": "a", "place": PLACE, **more}


def needed(kind: str) -> dict:
    return {"shaft": "input"} if kind in ("tacho", "torque") else {"place": PLACE}


@pytest.mark.parametrize("name", PRESETS)
def test_every_preset_makes_a_channel_that_reads_back_the_same(name: str) -> None:
    preset = PRESETS[name]
    one = {"kind": preset.kind, "name": "a", "preset": name, **needed(preset.kind)}
    chain = SensorChain.model_validate({"channels": [one]})
    document = json.loads(json.dumps(chain.model_dump(mode="json")))
    assert SensorChain.model_validate(document) == chain
    assert preset.sentence.endswith(".") and preset.source
    plain = SensorChain.model_validate({"channels": [{k: v for k, v in one.items() if k != "preset"}]})
    assert plain.channels[0] != chain.channels[0]


def test_own_stages_win_over_those_of_a_preset_and_null_leaves_one_out() -> None:
    (found,) = SensorChain.model_validate(
        {"channels": [channel(preset="icp-100mv-g", mounting=None, noise={"density_per_sqrt_hz": 1.0})]}
    ).channels
    assert found.mounting is None and found.noise.density_per_sqrt_hz == 1.0
    assert found.sensor.sensitivity_v_per_unit == pytest.approx(0.1 / 9.80665)
    again = SensorChain.model_validate({"channels": [found.model_dump(mode="json")]}).channels[0]
    assert again == found


@pytest.mark.parametrize(
    ("chain", "told"),
    [
        ({"channels": []}, "at least 1"),
        ({"channels": [channel(), channel()]}, "twice: a"),
        ({"channels": [channel(name=f"a{i}") for i in range(MAX_CHANNELS + 1)]}, f"at most {MAX_CHANNELS}"),
        ({"channels": [channel(name="time_s")]}, "time_s"),
        ({"channels": [channel(name="a b")]}, "pattern"),
        ({"channels": [channel(preset="nonesuch")]}, "icp-100mv-g"),
        ({"channels": [channel(preset="velocity-coil")]}, "icp-100mv-g"),
        ({"channels": [channel(kind="microphone")]}, "accelerometer"),
        ({"channels": [channel(gain=3)]}, "gain"),
        ({"channels": [channel(converter={"bits": 33})]}, "32"),
        ({"channels": [channel(converter={"bits": "16"})]}, "integer"),
        ({"channels": [channel()], "schema_version": 2}, "1"),
        ({"channels": [channel()], "clock": {"rate_error_ppm": 1e9}}, "10000"),
        ({"channels": [channel()], "seed": -1}, "0"),
        (
            {
                "channels": [
                    channel(
                        name=f"a{i}", path={"kind": "impulse_response", "sampling_rate_hz": 1e4, "taps": [1.0] * 16_000}
                    )
                    for i in range(3)
                ]
            },
            "taps",
        ),
    ],
)
def test_what_is_refused_says_what_is_allowed(chain: dict, told: str) -> None:
    with pytest.raises(ValidationError, match=told):
        SensorChain.model_validate(chain)


def test_nothing_of_a_chain_can_be_changed_afterwards() -> None:
    chain = SensorChain.model_validate({"channels": [channel()]})
    with pytest.raises(ValidationError):
        chain.seed = 3  # type: ignore[misc]


def test_the_page_shows_a_chain_that_is_one_and_every_preset() -> None:
    page = (Path(__file__).resolve().parents[3] / "docs" / "sensors.md").read_text(encoding="utf-8")
    chain = SensorChain.model_validate(json.loads(page.split("```json")[1].split("```")[0]))
    assert [c.name for c in chain.channels] == ["acc1", "key"]
    assert all(f"| `{name}` | {preset.kind} |" in page for name, preset in PRESETS.items())
