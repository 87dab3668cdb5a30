"""Recordings and reconciliations in the dashboard."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

import numpy as np

from signals.encode import describe, encode
from signals.readers.formats import FORMATS
from tests.browser.conftest import Service
from tests.browser.driver import Browser, eventually
from tests.strategies.impulses import recorded, sound, train

MACHINE = {
    "kinematics": {
        "shafts": [{"name": "shaft"}],
        "bearings": [{"name": "bearing1", "shaft": "shaft", "catalogue": "6205"}],
    }
}
HEADS = (
    "return [...PAGE.querySelectorAll('table')].filter((t) => t.offsetParent)"
    ".map((t) => [...t.querySelectorAll('th')].map((h) => h.textContent))"
)
"""Heads of the tables that are seen of PAGE."""
FRAMED = "document.querySelector('iframe.report-frame').contentDocument"
SCROLLED = f"return {FRAMED.replace('.contentDocument', '?.contentDocument')}?.querySelector('main') ? scrollY : -1"
"""How far the page is scrolled, once the report is in its frame."""
PHONE = 390
LOOSE = """
    const scrolls = (e) => getComputedStyle(e).overflowX === "auto";
    const boxed = (e) => e && e !== document.body && (scrolls(e) || boxed(e.parentElement));
    const wide = (e) => e.getBoundingClientRect().right > innerWidth + 1;
    const parts = [...document.querySelectorAll("table, svg.plot, pre")];
    return parts.filter((e) => wide(e) && !boxed(e)).map((e) => e.tagName);
"""
"""What is wider than the screen and lies in no box that scrolls by itself."""
HIDDEN_OR_BLANK = """
    const frame = document.querySelector("iframe.report-frame");
    const whole = frame.contentDocument.querySelector("main").getBoundingClientRect().bottom;
    return Math.abs(frame.clientHeight - whole) > 2 ? frame.clientHeight - whole : 0;
"""
"""Pixels of the frame below its page, or less than none of a page that it cuts."""
FILL = "const e = document.querySelector(arguments[0]); e.value = arguments[1];"


def test_a_recording_is_sent_chosen_and_reconciled(browser: Browser, service: Service, tmp_path: Path) -> None:
    made = recorded(sound(2) + train(np.random.default_rng(2), 3.5848 * 0.992, 1.0))
    (tmp_path / "spalled.npz").write_bytes(encode(made, "npz"))
    browser.open(service.page("/reconcile"))
    browser.find("[aria-label='Recordings'] p.empty")
    assert "File" not in browser.text("[aria-label='Recordings']"), "no heads of a table that is empty"
    browser.type("#upload-file", str(tmp_path / "spalled.npz"))
    browser.run(FILL, "#upload-description", json.dumps(describe(made)))
    browser.click("[aria-label='Send a recording'] button[type=submit]")
    browser.find("tr[data-recording][data-status=ready]", within_s=90)
    eventually(lambda: "no defects in the samples" in browser.text("tr[data-recording]"), what="the quality")
    assert "spalled.npz" in browser.text("tr[data-recording]")
    browser.click("[aria-label='Start a reconciliation'] button[type=submit]")
    assert "at least one recording" in browser.text("[aria-label='Start a reconciliation'] .message")
    browser.run(FILL, "tr[data-recording] select", "recordings")
    browser.run(FILL, "#machine-json", json.dumps(MACHINE))
    browser.click("[aria-label='Start a reconciliation'] button[type=submit]")
    browser.find("#answer-verdict", within_s=180)
    assert "explained" in browser.text("#answer-verdict")
    assert "bearing 1" in browser.text("#answer-where .site-bar")
    assert "outer spall" in browser.text("#answer-causes")
    assert "width less than 1" in browser.text("#answer-causes"), "the bound of a size that is not told"
    assert browser.find("#answer-page iframe.report-frame")
    assert browser.run("return fetch(document.querySelector('iframe.report-frame').src).then((r) => r.status)") == 200
    for width in (360, 1400):
        browser.size(width)
        assert browser.run("return document.documentElement.scrollWidth") <= width
        eventually(lambda: browser.run(HIDDEN_OR_BLANK) == 0, what="the frame to be as high as its page")
    page = browser.run("return document.querySelector('iframe.report-frame').src")
    assert page.endswith("report.html"), "a fragment would scroll the dashboard too"
    here = browser.run(HEADS.replace("PAGE", "document"))
    assert ["Effect", "At", "Severity (90 %)", "Score", "Named"] in here
    framed = browser.run(HEADS.replace("PAGE", FRAMED))
    assert framed and not [heads for heads in framed if {"candidate", "line", "model"} & set(heads)]
    assert not browser.run(f"return {FRAMED}.querySelector('h1').offsetParent"), "the verdict is told above the frame"
    browser.open(service.page(f"/reconcile/{page.split('/')[-2]}"))
    eventually(lambda: browser.run(SCROLLED) >= 0 and browser.run(HIDDEN_OR_BLANK) == 0, what="the report in its frame")
    assert browser.run("return document.documentElement.scrollHeight > 1.5 * innerHeight"), "there is far to scroll"
    assert browser.run(SCROLLED) == 0, "the answer opens at its verdict"
    browser.open(page)
    assert [heads for heads in browser.run(HEADS.replace("PAGE", "document")) if "candidate" in heads], (
        "whole by itself"
    )
    _fits_a_phone(browser, service, page)
    browser.size(360)
    browser.open(service.page("/reconcile"))
    browser.find("[aria-label=Reconciliations] tr[data-status=successful]")
    cut = browser.run(
        "return [...document.querySelectorAll('.table-wrap')].filter((e) => e.scrollWidth > e.clientWidth + 1).length"
    )
    assert cut == 0, "rows of tables stand as blocks on a phone"
    listed = browser.text("[aria-label=Reconciliations] tr[data-status=successful]")
    assert "explained" in listed and "outer spall at bearing 1" in listed, "the list tells what was found"
    assert browser.run("return document.documentElement.scrollWidth") <= 360


def test_a_baseline_is_chosen_by_hand_and_a_refusal_names_its_file(
    browser: Browser, service: Service, tmp_path: Path
) -> None:
    browser.open(service.page("/reconcile"))
    now, rested = recorded(sound(3)), replace(recorded(sound(4)), sampling_rate_hz=12345.0)
    for name, made, more in (("now.npz", now, {}), ("rested.npz", rested, {"condition": "baseline"})):
        (tmp_path / name).write_bytes(encode(made, "npz"))
        description = {"description": json.dumps(describe(made) | more)}
        with (tmp_path / name).open("rb") as file:
            service.client.post("/v1/recordings", data=description, files={"file": (name, file)}).raise_for_status()
    row = "[...document.querySelectorAll('tr[data-recording][data-status=ready]')].find((r) => r.innerText.includes("
    for name in ("now.npz", "rested.npz"):
        eventually(lambda name=name: browser.run(f"return !!{row}'{name}'))"), what=name)
    assert browser.run(f"return {row}'rested.npz')).querySelector('select').value") == "", "nothing is chosen by itself"
    assert "described as a baseline" in browser.run(f"return {row}'rested.npz')).innerText")
    browser.run(f"{row}'now.npz')).querySelector('select').value = 'recordings'")
    browser.run(f"{row}'rested.npz')).querySelector('select').value = 'baselines'")
    browser.run(FILL, "#machine-json", json.dumps(MACHINE))
    browser.click("[aria-label='Start a reconciliation'] button[type=submit]")
    said = browser.text("[aria-label='Start a reconciliation'] .problem-fields")
    assert "rested.npz (baselines.0): sampling_rate_hz" in said, said
    assert all("422" in told for told in browser.complaints()), "the refusal was asked for"


def test_what_is_wrong_is_said_in_the_words_of_the_page(browser: Browser, service: Service, tmp_path: Path) -> None:
    browser.open(service.page("/reconcile"))
    (tmp_path / "a.csv").write_text("a\n1\n", encoding="utf-8")
    browser.type("#upload-file", str(tmp_path / "a.csv"))
    asked = browser.text("label[for=upload-file]").lower()
    endings = {"text": "csv", "wave": "wav", "mdf": "mdf4"}
    told = {endings.get(one.module, one.module) for one in FORMATS.values()} - {"values"}
    assert not [ending for ending in told if ending not in asked], "every format that can be read"
    browser.run(FILL, "#upload-description", json.dumps({"sampling_rate_hz": 20000}))
    browser.click("[aria-label='Send a recording'] button[type=submit]")
    said = browser.text("[aria-label='Send a recording'] .problem-fields")
    assert "Channels" in said and "Outputs" not in said
    browser.open(service.page(f"/reconcile/{'0' * 32}"))
    away = browser.text(".message")
    assert "Not found" in away and "no job has the id" in away and "must change" not in away
    assert all("422" in told or "404" in told for told in browser.complaints()), "the refusals were asked for"


def test_sizes_and_laws_have_their_words_and_units(browser: Browser, service: Service) -> None:
    browser.open(service.page("/reconcile"))
    names = browser.run(
        "return import('/js/lib/laws.js').then((m) => ["
        " m.effectName({ term: 'custom_force', severity: { name: 'stops' } }),"
        " m.sizeName({ term: 'custom_force', severity: { name: 'stops' } }), m.listedName('odd_square'),"
        " m.effectName({ term: 'inner_spall', severity: null }),"
        " m.sizeName({ term: 'inner_spall', severity: { name: 'width' } })])"
    )
    assert names == ["stops on both sides", "", "odd stiffness, square", "inner spall", "width"]
    units = browser.run("return import('/js/lib/format.js').then((m) => ['N/m^3', 'N/m^0.5', 'm/s^2'].map(m.unit))")
    assert units == ["N/m³", "N/m⁰·⁵", "m/s²"]
    browser.size(400)
    last = browser.run("return [...document.querySelectorAll('.top-bar nav a')].at(-1).getBoundingClientRect().right")
    assert last <= 400, "the menu is whole"


def test_lines_stand_as_on_the_page_of_the_report_and_five_are_open(browser: Browser, service: Service) -> None:
    browser.show(service.page("/reconcile"))
    changes = [1.0, -9.0, 3.0, 4.0, 5.0, 6.0, 7.0]
    lines = [
        {"label": f"{i}*f_o1-1*f_r2", "frequency_hz": 10.0 * i, "change_db": c, "locked_to": f"b{i}"}
        for i, c in enumerate(changes, 1)
    ]
    family = [{**lines[1], "label": "8*f_o1", "frequency_hz": 80.0}]
    tables = browser.run(
        "return import('/js/reconcile/lines.js').then((m) => { const e = document.createElement('div');"
        " e.append(...m.lineTable(arguments[0]).filter(Boolean)); document.body.append(e);"
        " const open = e.querySelector('details').open;"
        " const names = (t) => [...t.tBodies[0].rows].map((r) => r.cells[0].innerHTML);"
        " const told = [...e.querySelectorAll('table')].map(names);"
        " e.remove(); return [open, ...told]; })",
        [*lines, *family],
    )
    hidden, first, rest = tables
    assert hidden is False and len(first) == 5 and len(rest) == 2
    assert first[0].startswith("2&nbsp;<i>f</i><sub>o1</sub> − 1&nbsp;<i>f</i><sub>r2</sub>, 8&nbsp;<i>f</i>")
    assert first[1].startswith("7&nbsp;") and rest[-1].startswith("1&nbsp;"), "the largest change first"


def test_the_list_begins_with_what_was_asked_for_last(browser: Browser, service: Service) -> None:
    browser.show(service.page("/reconcile"))
    times = [f"2026-03-01T08:{minute:02}:00.5Z" for minute in (3, 50, *range(4, 30))]
    ids = browser.run(
        "return import('/js/reconcile/start.js').then((m) => m.latest(arguments[0].map((t) => ({ accepted_at: t })))"
        ".map((job) => job.accepted_at))",
        times,
    )
    assert ids == sorted(times, reverse=True)[:20]


def test_sizes_are_rounded_as_on_the_page_of_the_report(browser: Browser, service: Service) -> None:
    browser.show(service.page("/reconcile"))
    told = browser.run(
        "return import('/js/lib/format.js').then((m) => arguments[0].map((v) => m.quantity(v, 'm', 2, true)))",
        [1.664e-3, 3.751e-4, 7.391e-3, 9.24e-7],
    )
    assert [" ".join(text.split()) for text in told] == ["1.7 mm", "375 µm", "7.4 mm", "924 nm"]
    size = {"name": "width", "value": 1.664e-3, "unit": "m", "low": 3.751e-4, "high": 7.391e-3}
    causes = [
        {"term": "outer_spall", "severity": None, "values": {"width_below_m": 2.23e-3}},
        {"term": "outer_spall", "severity": None, "values": {}},
        {"term": "outer_spall", "severity": size, "values": {"width_below_m": 2.23e-3}},
    ]
    said = browser.run(
        "return import('/js/reconcile/answer.js').then((m) => arguments[0].map((c) => m.severity(c)))", causes
    )
    assert [" ".join(text.split()) for text in said] == [
        *("width less than 2.2 mm", "–"),
        "width 1.7 mm (375 µm to 7.4 mm)",
    ]


def test_every_channel_at_fault_is_told_whatever_its_kind(browser: Browser, service: Service) -> None:
    browser.show(service.page("/reconcile"))
    fault = {"kind": "silence", "channel": "fe", "detail": "never changes", "recordings": ["test 1"], "left_out": True}
    other = {**fault, "kind": "loose_sensor", "channel": "xe", "left_out": False, "doubtful": True}
    report = {
        "verdict": "measurement_fault",
        "sentence": "Silent.",
        "fault": fault,
        "measurement_faults": [fault, other],
        "where": {"sites": [], "lines": [], "limits": []},
        "causes": [],
        "undecidable": [],
    }
    told = browser.run(
        "return import('/js/reconcile/answer.js').then((m) => { const e = m.answer({ id: 'x', links: {},"
        " report: arguments[0] }); return [...e.querySelectorAll('#answer-measurement tbody tr')].map((row) =>"
        " [...row.cells].map((cell) => cell.textContent)); })",
        report,
    )
    assert told == [
        ["silence", "fe", "test 1", "never changes", "left out"],
        ["loose sensor", "xe", "test 1", "never changes", "or the machine's own"],
    ]
    pill = (
        "return import('/js/reconcile/answer.js').then((m) => { const p = m.answer({ id: 'x', links: {},"
        " report: arguments[0] }).querySelector('.pill'); return [p.dataset.tone, p.textContent]; })"
    )
    assert browser.run(pill, report) == ["bad", "measurement fault"]
    assert browser.run(pill, {**report, "fault": other}) == ["warn", "perhaps the measurement"]


def _fits_a_phone(browser: Browser, service: Service, page: str) -> None:
    """No page is wider than the screen; tables and charts that are scroll in their own box."""
    browser.size(PHONE)
    answer = service.page(f"/reconcile/{page.split('/')[-2]}")
    for address, part in (
        (page, "svg.plot"),
        (answer, "#answer-causes table"),
        (f"{service.url.rstrip('/')}/docs", "section pre"),
    ):
        browser.open(address)
        browser.find(part)
        assert browser.run("return document.documentElement.scrollWidth") <= PHONE, address
        assert browser.run(LOOSE) == [], address
