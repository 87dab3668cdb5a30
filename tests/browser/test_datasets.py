"""Datasets in the dashboard: a recipe is changed, estimated, made, looked at."""

from __future__ import annotations

import re

from tests.browser.conftest import Service
from tests.browser.driver import Browser, eventually

SET = (
    "const e = document.querySelector(arguments[0]); e.value = arguments[1];"
    "e.dispatchEvent(new Event('input')); e.dispatchEvent(new Event('change'));"
)
WIDTH = "return document.documentElement.scrollWidth"
INK = (
    "const c = document.querySelector(arguments[0]);"
    "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height);"
    "return new Set(new Uint32Array(d.data.buffer)).size"
)


def test_a_text_that_is_no_recipe_makes_nothing(browser: Browser, service: Service) -> None:
    browser.open(service.page("/datasets"))
    browser.find("#dataset-preset", within_s=30)
    before = service.client.get("/v1/datasets").json()["total"]
    browser.run(SET, "#dataset-preset", "small")
    browser.run(SET, "#dataset-healthy_share", "150")
    eventually(lambda: "150 %" in browser.text("#dataset-form .message"), what="the share as its field has it")
    told = browser.text("#dataset-form .message")
    assert "100 %" in told and "1.5" not in told
    sound = browser.run("return document.querySelector('#dataset-json').value").replace("1.5", "0.5")
    for text in (sound[:-1], "[]", "5"):
        browser.run(SET, "#dataset-json", text)
        assert "No estimate" in browser.text("#dataset-estimate"), text
        assert browser.count("#dataset-form .message") == 0, "an error of the recipe before"
        assert browser.run("return document.querySelector('#dataset-form [type=submit]').disabled"), text
        browser.run("document.querySelector('#dataset-form').dispatchEvent(new Event('submit', {cancelable: true}))")
    assert browser.run("return document.querySelector('#dataset-json').value") == "5", "the text stays"
    browser.run(SET, "#dataset-json", '{"faults": 5}')
    eventually(lambda: "must change" in browser.text("#dataset-form .message"), what="the server's refusal")
    browser.run(SET, "#dataset-json", sound)
    eventually(lambda: "32" in browser.text("#dataset-estimate .facts"), what="the estimate")
    assert not browser.run("return document.querySelector('#dataset-form [type=submit]').disabled")
    assert service.client.get("/v1/datasets").json()["total"] == before
    assert all("422" in told for told in browser.complaints()), "the refusals were asked for"


def test_a_dataset_from_a_recipe_to_its_rows(browser: Browser, service: Service) -> None:
    browser.open(service.page("/datasets"))
    browser.find("#dataset-preset", within_s=30)
    browser.run(SET, "#dataset-preset", "small")
    eventually(lambda: "32" in browser.text("#dataset-estimate .facts"), what="the estimate")
    browser.run(SET, "#dataset-count", "0")
    eventually(lambda: "Recordings" in browser.text("#dataset-form .message"), what="the refusal at its field")
    assert all("422" in told for told in browser.complaints()), "the refusal was asked for"
    browser.run(SET, "#dataset-count", "8")
    browser.run(SET, "#dataset-healthy_share", "50")
    eventually(lambda: "outer" in browser.text("[aria-label='Planned rows']"), what="the balance")
    assert '"healthy_share": 0.5' in browser.run("return document.querySelector('#dataset-json').value")
    browser.run(SET, "#dataset-format", "npz")
    browser.size(360)
    assert browser.run(WIDTH) <= 360
    browser.cdp("Emulation.clearDeviceMetricsOverride")
    browser.click("#dataset-form button[type=submit]")
    browser.find("#dataset-rows[data-row]", within_s=180)
    assert "npz" in browser.text("#dataset-facts")
    assert "healthy" in browser.text("[aria-label='Class balance']")
    eventually(lambda: browser.run(INK, "#dataset-rows canvas") > 5, what="the signal to be drawn")
    made = service.client.get("/v1/datasets").json()["jobs"][0]["id"]
    rows = [row["columns"] for row in service.client.get(f"/v1/datasets/{made}/rows?limit=16").json()["rows"]]
    assert f"Row {rows[0]['row']} of the plan" in browser.text("#dataset-rows h2")
    place = next(k for k, row in enumerate(rows) if row["fault_type"] == "outer")
    browser.run(SET, "#row-place", str(place))
    eventually(lambda: "width" in browser.text("#dataset-rows .dataset-facts"), what="the size with its name")
    assert re.search(r"width [0-9.]+\sµ?m", browser.text("#dataset-rows .dataset-facts"))
    assert "envelope" in [peak["spectrum"] for peak in rows[place]["peaks"]]
    eventually(lambda: browser.run(INK, "#row-envelope canvas") > 5, what="the envelope's spectrum to be drawn")
    assert "Hz" in browser.text("#row-envelope p")
    first = browser.text("#dataset-rows .dataset-facts")
    browser.run(SET, "#row-place", str((place + 9) % 16))
    eventually(lambda: browser.text("#dataset-rows .dataset-facts") != first, what="another row")
    assert browser.text("[aria-label='Labelled peaks'] tbody tr")
    browser.size(360)
    assert browser.run(WIDTH) <= 360
    browser.cdp("Emulation.clearDeviceMetricsOverride")
    browser.open(service.page("/datasets"))
    browser.find("[aria-label=Datasets] tr[data-status=successful]")
    browser.open(service.page("/"))
    eventually(lambda: "dataset of 16 rows" in browser.text("main"), what="the dataset among the jobs")
