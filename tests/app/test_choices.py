"""What a request may say in more than one way: changes of the machine, the outputs."""

from __future__ import annotations

import httpx

TURNING = {
    "name": "turning",
    "bodies": [{"name": "mass", "mass_kg": 1.0, "axes": "y", "stiffness_y_n_per_m": 6e4}],
    "operating": {"shaft": "input", "speed_hz": 25.0},
}


def test_a_speed_profile_is_set_like_any_other_value(client: httpx.Client) -> None:
    ramp = {"kind": "ramp", "start_ratio": 0.5, "end_ratio": 2.0, "duration_s": 1.0}
    single = {f"profile.{name}": value for name, value in ramp.items()}
    for changes in ({"operating.profile": ramp}, {"profile": ramp}, single):
        reply = client.post("/v1/machines/check", json={"machine": TURNING, "set": changes})
        assert reply.json()["machine"]["operating"]["profile"] == ramp, reply.text
    profile = {"kind": "measured", "step_s": 0.01, "ratios": [1.0] * 500}
    reply = client.post("/v1/simulations", json={"machine": TURNING, "set": {"profile": profile}, "duration_s": 0.1})
    assert reply.json()["request"]["set"]["profile"]["ratios"] == "a list of 500"
    wrong = client.post("/v1/simulations", json={"machine": TURNING, "set": {"profile": {**ramp, "end_ratio": 20}}})
    (error,) = wrong.json()["errors"]
    assert (error["field"], error["given"], error["allowed"]) == ("set.profile.end_ratio", 20, "<= 10")


def test_all_channels_are_asked_for_by_one_word(client: httpx.Client) -> None:
    names = ["mass.y.displacement", "mass.y.acceleration"]
    body = {"preset": "oscillator", "seed": 14, "duration_s": 0.1}
    first, second = (
        client.post("/v1/simulations", json={**body, "channels": channels}).json() for channels in ("all", names)
    )
    assert first["id"] == second["id"] and first["request"]["channels"] == names
