"""Sensors, indicators and the words of a request, against a real server."""

from __future__ import annotations

from collections.abc import Iterator

import pytest

import sideband_client
from sideband_client import Client, Job, errors

pytestmark = pytest.mark.slow  # everything here waits for a worker that simulates or reads


@pytest.fixture(scope="module")
def done(url: str) -> Iterator[Job]:
    with sideband_client.connect(url) as client:
        yield client.simulate("oscillator", duration_s=0.5, seed=21).wait()


def test_sensors_and_indicators(client: Client, done: Job) -> None:
    found = client.sensors()
    assert "icp-magnet" in {preset["name"] for preset in found["presets"]}
    place = {"location": "mass", "direction_deg": 90}
    chain = {"channels": [{"kind": "accelerometer", "name": "acc", "preset": "icp-magnet", "place": place}]}
    result = client.simulate("oscillator", duration_s=0.1, sensors=chain).wait().result()
    assert [channel.name for channel in result.channels] == ["acc"]
    cepstrum = done.result().indicators("cepstrum", start_s=0.1, end_s=0.4)
    assert (cepstrum["kind"], cepstrum["duration_s"]) == ("cepstrum", pytest.approx(0.3))
    with pytest.raises(errors.InvalidRequest, match="max_alpha_hz"):
        done.result().indicators("cyclic", max_alpha_hz=1e6)


def test_one_word_for_changes_and_for_every_output(client: Client) -> None:
    heavy = {"bodies.mass.mass_kg": 2.0}
    for given in (client.check("oscillator", set=heavy), client.check("oscillator", overrides=heavy)):
        assert given["machine"]["bodies"][0]["mass_kg"] == 2.0
    with pytest.raises(ValueError, match="not both"):
        client.check("oscillator", set=heavy, overrides=heavy)
    job = client.simulate("oscillator", duration_s=0.1, channels="all", set=heavy, seed=33)
    assert job.state.request["channels"] == ["mass.y.displacement", "mass.y.acceleration"]
    assert job.state.request["set"] == heavy
