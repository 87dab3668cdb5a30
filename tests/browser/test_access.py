"""For everyone: names for assistive technology, contrast, narrow screens, themes, API keys."""

from __future__ import annotations

from hashlib import sha256
from pathlib import Path

import pytest

from app.settings import Settings
from tests.browser.conftest import Service
from tests.browser.driver import Browser, eventually
from tests.service.parts import LiveServer, open_parts

NAMELESS = """
const named = (e) => e.getAttribute("aria-label") || e.labels?.length || e.textContent.trim() || e.title;
const seen = (e) => e.getClientRects().length && e.getAttribute("aria-hidden") !== "true";
return [...document.querySelectorAll("button, input, select, a, canvas[role=img]")]
  .filter((e) => seen(e) && !named(e)).map((e) => e.outerHTML.slice(0, 120));
"""
COLOURS = """
const style = getComputedStyle(document.documentElement);
return Object.fromEntries(arguments[0].map((name) => [name, style.getPropertyValue(name).trim()]));
"""
TEXT = ("--text", "--muted", "--accent-strong", "--ok", "--warn", "--bad")
MARKS = tuple(f"--family-{name}" for name in ("mesh", "shaft", "outer", "inner", "ball", "cage", "combination"))


def pages(service: Service) -> list[tuple[str, str]]:
    return [
        ("/", ".presets a"),
        ("/reconcile", "[aria-label='Start a reconciliation'] button"),
        ("/datasets", "#dataset-count"),
        ("/machines", "[aria-label=Machines] .empty a, [aria-label=Machines] tr[data-machine]"),
        ("/new", "[aria-label='Machine check'] .facts"),
        (f"/jobs/{service.demo}", ".peaks-table tr[data-label]"),
    ]


def luminance(colour: str) -> float:
    """Relative luminance of #rrggbb (WCAG 2.2)."""
    parts = [int(colour[i : i + 2], 16) / 255 for i in (1, 3, 5)]
    linear = [c / 12.92 if c <= 0.04045 else ((c + 0.055) / 1.055) ** 2.4 for c in parts]
    return 0.2126 * linear[0] + 0.7152 * linear[1] + 0.0722 * linear[2]


def contrast(a: str, b: str) -> float:
    low, high = sorted((luminance(a), luminance(b)))
    return (high + 0.05) / (low + 0.05)


@pytest.mark.parametrize("theme", ["light", "dark"])
def test_text_and_marks_stand_out_in_both_themes(browser: Browser, service: Service, theme: str) -> None:
    browser.open(service.page())
    browser.run("document.documentElement.dataset.theme = arguments[0]", theme)
    found = browser.run(COLOURS, ["--surface", *TEXT, *MARKS])
    for name in TEXT:
        assert contrast(found[name], found["--surface"]) >= 4.5, name
    for name in MARKS:
        assert contrast(found[name], found["--surface"]) >= 3.0, name


def test_everything_that_can_be_used_has_a_name(browser: Browser, service: Service) -> None:
    for path, ready in pages(service):
        browser.open(service.page(path))
        browser.find(ready)
        assert browser.run(NAMELESS) == [], path


@pytest.mark.parametrize("width", [360, 768, 1440])
def test_no_page_is_wider_than_the_screen(browser: Browser, service: Service, width: int) -> None:
    browser.size(width)
    for path, ready in pages(service):
        browser.open(service.page(path))
        browser.find(ready)
        assert browser.run("return document.documentElement.scrollWidth") <= width, path


def test_the_chosen_theme_is_kept(browser: Browser, service: Service) -> None:
    browser.open(service.page())
    browser.run("localStorage.removeItem('sideband-theme'); document.documentElement.removeAttribute('data-theme')")
    before = browser.run("return getComputedStyle(document.body).backgroundColor")
    browser.click("#theme-button")
    after = browser.run("return getComputedStyle(document.body).backgroundColor")
    assert after != before
    browser.open(service.page())
    assert browser.run("return getComputedStyle(document.body).backgroundColor") == after
    browser.run("localStorage.removeItem('sideband-theme')")


def test_a_server_with_keys_asks_for_one(browser: Browser, tmp_path: Path) -> None:
    static = Settings.__dataclass_fields__["static_folder"].default
    parts = open_parts(tmp_path)
    try:
        app = parts.app(api_keys={sha256(b"open sesame").hexdigest(): "ali"}, static_folder=static)
        with LiveServer(app) as client:
            browser.open(f"{client.base_url}/#/reconcile")
            eventually(
                lambda: "once an API key is given" in browser.text("[aria-label=Recordings]"), what="why there is none"
            )
            browser.open(f"{client.base_url}/#/")
            browser.type("#key-field", "open sesame")
            browser.click("#key-form button")
            browser.find('.tile[data-tile="broker"][data-status="ok"]')
            eventually(lambda: browser.count("#key-form") == 0, what="the question to go")
            assert "No job yet" in browser.text("[aria-label=Jobs]")
            browser.leave()  # or its page asks the ended server while the next test runs
    finally:
        parts.close()
    assert all("401" in line or "ERR_CONNECTION" in line for line in browser.complaints())
