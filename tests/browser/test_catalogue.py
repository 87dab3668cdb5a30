"""The catalogue: every effect with what it declares, found by any word said of it."""

from __future__ import annotations

from tests.browser.conftest import Service
from tests.browser.driver import Browser, eventually

SEEN = "return [...document.querySelectorAll('.catalogue-effect:not([hidden])')].map((e) => e.dataset.term)"


def test_every_effect_is_listed_and_told_in_full(browser: Browser, service: Service) -> None:
    terms = service.client.get("/v1/terms").json()["terms"]
    browser.open(service.page("/catalogue/outer_spall"))
    card = '[data-term="outer_spall"][open]'
    text = browser.text(card)
    assert set(browser.run(SEEN)) == {term["key"] for term in terms}
    (shown,) = (term for term in terms if term["key"] == "outer_spall")
    assert all(param["sentence"] in text for param in shown["parameters"])
    assert all(check["source"] in text for check in shown["validation"])
    assert all(reference in text for reference in shown["references"])
    assert f"{shown['predicted_lines'][0]['frequency_hz']:.6g}" in text
    eventually(lambda: browser.count(f"{card} .catalogue-example canvas") == 2, what="the example", within_s=40)
    for term in terms[:4]:
        browser.run("document.querySelector(`[data-term=${arguments[0]}]`).open = true", term["key"])
    eventually(lambda: browser.count(".catalogue-example[aria-busy]") == 0, what="all contents", within_s=60)
    assert not browser.run("return document.querySelector('.catalogue').innerText.match(/undefined|NaN|\\[object/)")


def test_the_filter_takes_every_word(browser: Browser, service: Service) -> None:
    browser.open(service.page("/catalogue"))
    browser.find('[data-term="outer_spall"]')
    browser.type("#catalogue-filter", "spall inner")
    eventually(lambda: "inner_spall" in browser.run(SEEN), what="the effect")
    assert "unbalance" not in browser.run(SEEN)
    browser.type("#catalogue-filter", " nothing-has-this")
    eventually(lambda: browser.run(SEEN) == [], what="an empty list")


def test_it_fits_a_narrow_screen(browser: Browser, service: Service) -> None:
    browser.size(390, 800)
    browser.open(service.page("/catalogue/outer_spall"))
    browser.find('[data-term="outer_spall"][open] table')
    assert browser.run("return document.documentElement.scrollWidth <= 390")
