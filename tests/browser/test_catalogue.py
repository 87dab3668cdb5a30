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
    eventually(lambda: browser.count(f"{card} .law-panel canvas") == 2, what="the pictures of its law", within_s=40)
    told = service.client.get("/v1/terms/outer_spall/law").json()["panels"]
    assert [panel["title"] for panel in told] == browser.run(
        "return [...document.querySelectorAll(arguments[0])].map((e) => e.textContent)", f"{card} .law-panel h4"
    )
    eventually(lambda: browser.count(f"{card} .catalogue-example canvas") == 2, what="the example", within_s=40)
    for term in terms[:4]:
        browser.run("document.querySelector(`[data-term=${arguments[0]}]`).open = true", term["key"])
    eventually(lambda: browser.count(".catalogue [aria-busy]") == 0, what="all contents", within_s=90)
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


def test_the_law_is_drawn_with_and_without_the_effect(browser: Browser, service: Service) -> None:
    browser.open(service.page("/catalogue/pedestal_looseness"))
    panel = '[data-term="pedestal_looseness"] .law-panel'
    text = browser.text(panel)
    assert "with it" in text and "without it" in text and "bearing 1 outer y" in text
    name = browser.run("return document.querySelector(arguments[0]).ariaLabel", f"{panel} canvas")
    assert name.startswith("Force over displacement")
    inked = (
        "const c = document.querySelector(arguments[0]);"
        "const d = c.getContext('2d').getImageData(0, 0, c.width, c.height).data;"
        "return d.some((v, i) => i % 4 === 3 && v > 0)"
    )
    eventually(lambda: browser.run(inked, f"{panel} canvas"), what="the drawing")


def test_the_page_of_an_effect_is_read_in_the_dashboard(browser: Browser, service: Service) -> None:
    browser.open(service.page("/catalogue/tooth_crack"))
    browser.click('[data-term="tooth_crack"][open] a[href$="/page"]')
    text = browser.text("article h1")
    assert "tooth_crack" in text
    assert browser.count("article table") >= 1 and browser.count("article h2") >= 3
    assert "| ---" not in browser.text("article") and "```" not in browser.text("article")


def test_every_page_is_rendered_without_remains_of_its_markup(browser: Browser, service: Service) -> None:
    browser.open(service.page("/api"))
    browser.find(".api-calls")
    script = (
        "const [{ markdown }, reply] = await Promise.all([import('/js/lib/markdown.js'), fetch(arguments[0])]);"
        "const made = markdown(await reply.text(), () => '#/');"
        "made.forEach((e) => e.querySelectorAll('code').forEach((c) => c.remove()));"
        "return made.map((e) => e.textContent).join('\\n')"
    )
    for term in service.client.get("/v1/terms").json()["terms"]:
        text = browser.run(script, f"/v1/terms/{term['key']}/page")
        assert len(text) > 300
        assert "](" not in text and "|--" not in text and "\n#" not in text and "**" not in text, term["key"]


def test_the_calls_of_the_api_are_listed_and_the_document_is_linked(browser: Browser, service: Service) -> None:
    browser.open(service.page("/catalogue"))
    browser.click("footer a[href='#/api']")
    browser.find(".api-calls code")
    text = browser.text("main")
    paths = service.client.get("/openapi.json").json()["paths"]
    assert all(path in text for path in paths)
    assert browser.count("footer a[href='/openapi.json']") == 1
