"""Machines over time in the dashboard: a bearing whose outer race goes."""

from __future__ import annotations

import json
from collections.abc import Iterator
from typing import Any

import numpy as np
import pytest

from signals.encode import describe, encode
from tests.browser.conftest import Service
from tests.browser.driver import Browser, eventually
from tests.strategies.impulses import recorded, sound, train

KINEMATICS = {
    "shafts": [{"name": "shaft"}],
    "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
}
OUTER = 3.5848 * 0.992
SOUND = 16
HEIGHTS = (0.0, 0.0, 0.5, 0.7, 1.0)
"""Of the impulses, recording by recording after those of the sound machine."""


def send(service: Service, day: int, height: float, *, baseline: bool, machine: str = "fan-3") -> str:
    made = recorded(sound(day) + height * train(np.random.default_rng(day), OUTER, 1.0), names=["drive_end"])
    about: dict[str, Any] = json.loads(json.dumps(describe(made)))
    about |= {
        "machine": machine,
        "recorded_at": f"2026-04-{day:02d}T06:00:00Z",
        "kinematics": KINEMATICS,
        "condition": "baseline" if baseline else "unknown",
    }
    reply = service.client.post(
        "/v1/recordings",
        data={"description": json.dumps(about)},
        files={"file": (f"day-{day:02d}.npz", encode(made, "npz"))},
    )
    return str(reply.raise_for_status().json()["id"])


@pytest.fixture(scope="module")
def sent(service: Service) -> Iterator[list[str]]:
    """Recordings that go again: other tests look at the first one in the list."""
    ids = [send(service, day, 0.0, baseline=True) for day in range(1, SOUND + 1)]
    ids += [send(service, day, height, baseline=False) for day, height in enumerate(HEIGHTS, start=SOUND + 1)]
    few = [send(service, day, 0.0, baseline=day == 1, machine="fan-4") for day in (1, 4)]
    for each in [*ids, *few]:
        service.wait(each, "successful")
    asked = {"machine": {"kinematics": KINEMATICS}, "recordings": ids[-1:], "baselines": ids[:1]}
    made = service.client.post("/v1/reconciliations", json=asked).raise_for_status().json()["id"]
    service.wait(made, "successful", within_s=180)
    yield ids
    for address in (*(f"/v1/recordings/{each}" for each in [*ids, *few]), f"/v1/jobs/{made}"):
        service.client.delete(address).raise_for_status()


def test_a_failing_bearing_is_seen_from_the_list_to_the_line(
    browser: Browser, service: Service, sent: list[str]
) -> None:
    browser.open(service.page("/machines"))
    assert "alarm" in browser.text("tr[data-machine=fan-3]") and "21 (16 baseline)" in browser.text("tr[data-machine]")
    browser.click("tr[data-machine=fan-3] a")
    browser.find(".trend-svg .trend-mark")
    assert browser.run("return document.querySelector('[aria-label=Feature]').value") == "bearing1.outer"
    assert browser.count(".trend-svg .trend-mark") == 21 and browser.count(".trend-svg [data-mark=baseline]") == SOUND
    assert browser.count(".trend-svg [data-mark=alarm]") >= 1
    assert browser.count(f".trend-svg [data-mark=alarm][data-recording='{sent[-1]}']") == 1
    assert browser.count(f".trend-svg [data-mark=ok][data-recording='{sent[SOUND]}']") == 1
    assert "bearing1: outer race" in browser.text("[aria-label=Alarms] tr[data-alarm=family]")
    assert "explained" in browser.text("[aria-label='Last verdicts'] tr a")
    browser.click(f".trend-svg [data-recording='{sent[-1]}']")
    browser.find("[aria-label='Recording day-21.npz']")
    browser.click("[aria-label='Recording day-21.npz'] summary")
    assert "% of the envelope" in browser.text("[aria-label='Named lines']")
    browser.run(
        "const e = document.querySelector('[aria-label=Feature]');"
        "e.value = 'rms'; e.dispatchEvent(new Event('change'));"
    )
    eventually(lambda: browser.count(".trend-svg[aria-label^='RMS about the mean']") == 1, what="the other feature")
    browser.click("[aria-label='Last verdicts'] tr a")
    browser.find("#answer-verdict")


def test_what_cannot_be_judged_is_not_called_well(browser: Browser, service: Service, sent: list[str]) -> None:
    browser.open(service.page("/machines"))
    listed = browser.text("tr[data-machine=fan-4]")
    assert listed.count("not judged") == 2 and "ok" not in listed
    browser.open(service.page("/machines/fan-4"))
    browser.find(".trend-svg [data-mark=unjudged]")
    alarms = browser.text("section[aria-label=Alarms]")
    assert "not judged" in alarms and "there is 1 baseline like it" in alarms and "8 are needed" in alarms
    assert "1 baseline like it, 8 needed" in browser.text("[aria-label=Recordings] tbody tr")
    labels = browser.run("return [...document.querySelectorAll('.trend-grid text')].map((e) => e.textContent)")
    dates = [text for text in labels if "," in text or " " in text]
    assert len(dates) == len(set(dates)) > 3, dates


def test_the_pages_of_machines_are_for_everyone(browser: Browser, service: Service, sent: list[str]) -> None:
    for path, ready in (("/machines", "tr[data-machine]"), ("/machines/fan-3", ".trend-svg .trend-mark")):
        browser.size(360)
        browser.open(service.page(path))
        browser.find(ready)
        assert browser.run("return document.documentElement.scrollWidth") <= 360, path
    browser.open(service.page("/machines/nothing"))
    assert "nothing" in browser.text("main .message")
    browser.complaints()  # the browser logs the 404 that was asked for
