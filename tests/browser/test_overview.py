"""The first page: health, jobs, cancel, delete, what happens when the server is away."""

from __future__ import annotations

from tests.browser.conftest import DEMO, Service
from tests.browser.driver import ENTER, Browser, eventually

LONG = {**DEMO, "duration_s": 60, "channels": ["resonator1.y.acceleration"]}


def test_health_of_every_part_is_shown_as_the_api_tells_it(browser: Browser, service: Service) -> None:
    browser.open(service.page())
    browser.find('.tile[data-tile="broker"][data-status="ok"]')
    for part in ("service", "broker", "workers", "queue", "store", "throughput"):
        assert browser.find(f'.tile[data-tile="{part}"]')
    told = service.client.get("/v1/health").json()
    assert browser.text('.tile[data-tile="workers"] .tile-value') == str(len(told["workers"]))
    assert told["version"] in browser.text('.tile[data-tile="service"]')


def test_nothing_is_fetched_from_elsewhere(browser: Browser, service: Service) -> None:
    browser.open(service.page(f"/jobs/{service.demo}"))
    browser.find(".peaks-table tr[data-label]")
    script = "return performance.getEntriesByType('resource').map((e) => new URL(e.name).origin)"
    assert set(browser.run(script)) == {service.url.rstrip("/")}


def test_a_job_is_cancelled_and_deleted_with_the_keyboard(browser: Browser, service: Service) -> None:
    job = service.client.post("/v1/simulations", json=LONG).json()["id"]
    row = f'tr[data-job="{job}"]'
    browser.open(service.page())
    browser.find(f"{row}[data-status=running] [role=progressbar]")
    eventually(
        lambda: float(browser.run(f"return document.querySelector('{row} [role=progressbar]').ariaValueNow")) > 0,
        what="progress",
    )
    browser.run(f"document.querySelector('{row} .job-actions button').focus()")
    browser.type(f"{row} .job-actions button", ENTER)
    browser.type("dialog [data-choice=all]", ENTER)
    browser.find(f"{row}[data-status=dismissed]")
    service.wait(job, "dismissed")
    browser.click(f"{row} .danger")
    browser.click("dialog [data-choice=delete]")
    eventually(lambda: browser.count(row) == 0, what="the row to go")
    assert service.client.get(f"/v1/jobs/{job}").status_code == 410


def test_keeping_a_job_changes_nothing(browser: Browser, service: Service) -> None:
    browser.open(service.page())
    browser.click(f'tr[data-job="{service.demo}"] .danger')
    browser.click("dialog button:not(.danger)")
    eventually(lambda: browser.count("dialog") == 0, what="the dialog to close")
    assert service.client.get(f"/v1/jobs/{service.demo}").json()["status"] == "successful"


def test_a_server_that_is_away_is_told_and_its_return_noticed(browser: Browser, service: Service) -> None:
    browser.open(service.page())
    browser.find('.tile[data-tile="broker"][data-status="ok"]')
    browser.cdp("Network.enable")
    offline = {"latency": 0, "downloadThroughput": -1, "uploadThroughput": -1}
    browser.cdp("Network.emulateNetworkConditions", offline=True, **offline)
    try:
        eventually(lambda: "does not answer" in browser.text("#banner"), what="the banner")
        assert browser.find('#health-pill[data-status="away"]')
    finally:
        browser.cdp("Network.emulateNetworkConditions", offline=False, **offline)
    browser.find('#health-pill[data-status="ok"]')
    eventually(lambda: browser.count("#banner > *") == 0, what="the banner to go")
    assert all("ERR_INTERNET_DISCONNECTED" in line for line in browser.complaints())


def test_what_the_sender_did_wrong_does_not_degrade_the_service(browser: Browser, service: Service) -> None:
    browser.show(service.page())
    script = (
        "return import('/js/overview/health.js').then(async (m) => { const health = await (await fetch('/v1/health'))"
        ".json(); const e = m.healthStrip({ ...health, failures_last_hour: arguments[0] }).element"
        ".querySelector('[data-tile=throughput]'); return [e.dataset.status, e.textContent]; })"
    )
    status, told = browser.run(script, {"refused": 2, "not-reconcilable": 1})
    assert status == "ok" and "no failures" in told and "3 for the sender to change: " in told and "refused 2" in told
    status, told = browser.run(script, {"refused": 2, "timeout": 1})
    assert status == "degraded" and "1 failed: timeout 1" in told and "2 for the sender to change: refused 2" in told
