"""The list of recordings where there are many, and a reconciliation that failed."""

from __future__ import annotations

import json
from typing import Any

import numpy as np
import pytest

from signals.encode import describe, encode
from tests.browser.conftest import Service
from tests.browser.driver import Browser, eventually
from tests.browser.test_reconcile import FILL, MACHINE
from tests.strategies.impulses import recorded

NEWEST = 10
CARD = "section[aria-label=Recordings]"
ROWS = "tr[data-recording]"
MORE = f"{CARD} button[aria-expanded]"
FILTER = "[aria-label='Filter recordings by file name']"
NAMES = f"return [...document.querySelectorAll('{ROWS} strong')].map((name) => name.textContent)"
TYPED = "const e = document.querySelector(arguments[0]); e.value = arguments[1]; e.dispatchEvent(new Event('input'));"


def send(service: Service, name: str, seed: int, **more: str) -> str:
    made = recorded(np.random.default_rng(seed).normal(size=64))
    files = {"file": (name, encode(made, "npz"))}
    sent = service.client.post("/v1/recordings", data={"description": json.dumps(describe(made) | more)}, files=files)
    identifier: str = sent.raise_for_status().json()["id"]
    service.wait(identifier, "successful")
    return identifier


@pytest.fixture(scope="module")
def many(service: Service) -> list[str]:
    """Twelve, the newest last."""
    return [send(service, f"run{k:02}.npz", 700 + k) for k in range(12)]


def shown(browser: Browser) -> list[str]:
    names: list[str] = browser.run(NAMES)
    return names


def test_the_newest_are_shown_then_all_then_those_of_a_name(
    browser: Browser, service: Service, many: list[str]
) -> None:
    browser.open(service.page("/reconcile"))
    newest = [f"run{k:02}.npz" for k in range(11, 1, -1)]
    eventually(lambda: shown(browser) == newest, what="the newest ten")
    total = service.client.get("/v1/recordings").json()["total"]
    assert browser.text(MORE) == f"Show all {total}"
    assert f"10 of {total}" in browser.text(f"{CARD} .card-head")
    browser.run("document.querySelector(arguments[0]).focus()", MORE)
    browser.type(MORE, "\ue007")
    eventually(lambda: len(shown(browser)) == total, what="all of them")
    assert browser.run("return document.querySelector(arguments[0]).ariaExpanded", MORE) == "true"
    browser.run(TYPED, FILTER, "RUN0")
    eventually(lambda: shown(browser) == [f"run{k:02}.npz" for k in range(9, -1, -1)], what="those of that name")
    browser.run(TYPED, FILTER, "nothing is called so")
    eventually(lambda: "No file is called so" in browser.text(CARD), what="that there is none")
    browser.run(TYPED, FILTER, "")
    browser.click(MORE)
    eventually(lambda: shown(browser) == newest, what="the newest again")


def test_what_is_chosen_stays_in_sight(browser: Browser, service: Service, many: list[str]) -> None:
    browser.open(service.page("/reconcile"))
    browser.run(TYPED, FILTER, "run00")
    eventually(lambda: shown(browser) == ["run00.npz"], what="the oldest")
    browser.run(FILL, f"{ROWS} select", "recordings")
    browser.run(TYPED, FILTER, "")
    eventually(lambda: len(shown(browser)) == NEWEST + 1, what="the newest and the chosen one")
    assert shown(browser)[-1] == "run00.npz"
    browser.run(TYPED, FILTER, "run11")
    eventually(lambda: shown(browser) == ["run11.npz", "run00.npz"], what="the chosen one beside what was sought")
    assert browser.run(f"return [...document.querySelectorAll('{ROWS} select')].at(-1).value") == "recordings"


def test_a_recording_is_deleted_from_its_row(browser: Browser, service: Service, many: list[str]) -> None:
    gone = send(service, "mistaken.npz", 799)
    row = f'tr[data-recording="{gone}"]'
    browser.open(service.page("/reconcile"))
    browser.find(f"{row}[data-status=ready]")
    assert browser.run(f"return document.querySelector('{row} .danger').ariaLabel") == f"Delete mistaken.npz {gone[:8]}"
    browser.click(f"{row} .danger")
    assert "mistaken.npz" in browser.text("dialog")
    browser.click("dialog button:not(.danger)")
    eventually(lambda: browser.count("dialog") == 0, what="the dialog to close")
    assert service.client.get(f"/v1/recordings/{gone}").json()["status"] == "ready"
    browser.run(FILL, f"{row} select", "recordings")
    browser.click(f"{row} .danger")
    browser.click("dialog [data-choice=delete]")
    eventually(lambda: browser.count(row) == 0, what="the row to go, though it was chosen")
    assert service.client.get(f"/v1/recordings/{gone}").status_code == 410


def test_when_it_was_sent_stands_in_one_line(browser: Browser, service: Service, many: list[str]) -> None:
    browser.size(1280)
    browser.open(service.page("/reconcile"))
    browser.find(f"{ROWS}[data-status=ready]")
    lines = (
        f"return Math.max(...[...document.querySelectorAll('{ROWS} td[data-head=Sent]')].map((cell) => "
        "{ const all = document.createRange(); all.selectNodeContents(cell); return all.getClientRects().length; }))"
    )
    script = "document.querySelectorAll(\"td[data-head=Sent]\").forEach((e) => { e.textContent = '23 h 59 min ago'; });"
    assert browser.run(script + lines) == 1
    assert browser.run("return document.documentElement.scrollWidth") <= 1280
    wrap = f"{CARD} .table-wrap"
    assert (
        browser.run("const e = document.querySelector(arguments[0]); return e.scrollWidth - e.clientWidth", wrap) <= 0
    )


def test_a_failure_is_told_once_with_what_it_is_about(browser: Browser, service: Service, many: list[str]) -> None:
    same = send(service, "again.npz", 703, notes="sent again")
    body: dict[str, Any] = {"machine": MACHINE, "recordings": [many[3]], "baselines": [same], "seed": 7}
    found = service.client.post("/v1/reconciliations", json=body).raise_for_status().json()["id"]
    service.wait(found, "failed")
    message = service.client.get(f"/v1/jobs/{found}").json()["failure"]["detail"]["errors"][0]["message"]
    browser.open(service.page(f"/reconcile/{found}"))
    browser.find(".message")
    assert browser.text("main").count(message) == 1
    about = browser.text("#reconciliation-of")
    assert "run03.npz, against again.npz" in about and "quick, seed 7" in about and about.startswith("Machine ")
