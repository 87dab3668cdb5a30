"""The result page: plots that draw and zoom, families that switch, a table that agrees with the API."""

from __future__ import annotations

import pytest

from tests.browser.conftest import DEMO, Service
from tests.browser.driver import Browser, eventually

SPECTRUM = "#card-spectrum canvas.plot-canvas"
AMPLITUDE = ".peaks-table th[data-key=amplitude]"
"""The head of the column holds its unit."""
UNTHINNED = 6000
"""A stretch of so many samples is fetched as it is."""
INKED = """
const canvas = document.querySelector(arguments[0]);
const data = canvas.getContext("2d").getImageData(0, 0, canvas.width, canvas.height).data;
let inked = 0;
for (let i = 3; i < data.length; i += 4) if (data[i] > 0) inked += 1;
return inked / (data.length / 4);
"""


@pytest.fixture
def result(browser: Browser, service: Service) -> Browser:
    browser.open(service.page(f"/jobs/{service.demo}"))
    return drawn(browser)


@pytest.fixture
def seen(browser: Browser, service: Service) -> Browser:
    """The page for tests that change nothing of it: one load for all that follow each other."""
    browser.show(service.page(f"/jobs/{service.demo}"))
    return drawn(browser)


def drawn(browser: Browser) -> Browser:
    browser.find(".peaks-table tr[data-label]")
    eventually(lambda: int(markers(browser)) > 0, what="marked peaks")
    return browser


def markers(browser: Browser) -> str:
    return str(browser.run(f"return document.querySelector('{SPECTRUM}').dataset.markers ?? '0'"))


def view(browser: Browser, css: str) -> tuple[float, float]:
    low, high = browser.run("return document.querySelector(arguments[0]).dataset.view", css).split()
    return float(low), float(high)


def test_how_many_steps_it_took_stands_once(seen: Browser) -> None:
    eventually(lambda: seen.run(INKED, SPECTRUM) > 0.01, what="the page")
    told = seen.run("return document.body.innerText.match(/\\bSteps\\b/g).length")
    assert told == 1, "what was estimated beside what it took"


@pytest.mark.parametrize("card", ["#card-time", "#card-spectrum", "#card-envelope", "#card-inner", "#card-orbit"])
def test_every_plot_is_drawn_and_named(seen: Browser, card: str) -> None:
    canvas = f"{card} canvas[role=img]"
    eventually(lambda: seen.run(INKED, canvas) > 0.01, what=f"ink in {card}")
    assert len(seen.run("return document.querySelector(arguments[0]).getAttribute('aria-label')", canvas)) > 20


def test_the_table_says_what_the_api_says(seen: Browser, service: Service) -> None:
    peaks = service.client.get(f"/v1/jobs/{service.demo}/result/peaks").json()["peaks"]
    mesh = next(peak for peak in peaks if peak["label"] == "1*f_m")
    text = seen.text('.peaks-table tr[data-label="1*f_m"]')
    assert "690" in text and mesh["status"] in text and "mesh 1" in text
    assert f"{mesh['amplitude']:.3g}"[:3] in text
    known = sum(1 for peak in peaks if peak["family"] and peak["status"] in ("present", "ambiguous"))
    assert f"{known} of {len(peaks)} lines" in seen.text("#card-peaks .card-head")


def test_quality_is_told_as_it_is(seen: Browser, service: Service) -> None:
    quality = service.client.get(f"/v1/jobs/{service.demo}/result").json()["quality"]
    text = seen.text("#card-quality")
    for name in ("Energy balance", "Step error", "Start-up transient"):
        assert name in text
    assert f"limit {quality['energy']['limit'] * 100:.2g} %" in text


@pytest.mark.parametrize(("kind", "start"), [("npz", b"PK"), ("csv", b""), ("wav", b"RIFF"), ("parquet", b"PAR1")])
def test_files_come_as_asked(seen: Browser, service: Service, kind: str, start: bytes) -> None:
    asked = seen.run(
        "const [format] = arguments; let path = null; const click = HTMLAnchorElement.prototype.click;"
        "HTMLAnchorElement.prototype.click = function () { path = this.getAttribute('href'); };"
        "const card = document.getElementById('card-downloads'); card.querySelector('select').value = format;"
        "card.querySelector('form').requestSubmit(); return new Promise((done) => setTimeout(() => {"
        "HTMLAnchorElement.prototype.click = click; done(path); }, 50))",
        kind,
    )
    reply = service.client.get(asked)
    assert reply.status_code == 200
    assert reply.content.startswith(start) and len(reply.content) > 10_000
    assert f".{kind}" in reply.headers["content-disposition"]


def test_the_note_of_the_start_up_says_only_what_is_seen(seen: Browser, service: Service) -> None:
    summary = service.client.get(f"/v1/jobs/{service.demo}/result").json()
    canvas = "#card-time canvas.plot-canvas"
    eventually(lambda: seen.run("return document.querySelector(arguments[0])?.dataset.view", canvas), what="a view")
    assert view(seen, canvas)[0] == pytest.approx(summary["analysed_from_s"]), "nothing before it is in sight"
    note = seen.text("#card-time .notes")
    assert "The view begins there; what is before is shaded in the whole record." in note


PLACED = """
return import("/js/plot/labels.js").then(({ placer }) => {
  const box = { left: 0, right: 400, top: 0, bottom: 300 };
  const scale = { px: (v) => v };
  const series = { x: [0, 99, 100, 101, 139, 140, 141, 400], y: [300, 300, 50, 300, 300, 200, 300, 300] };
  const plot = { box, series, x: scale, y: scale, view: [0, 400] };
  const marks = [{ x: 100, y: 50 }, { x: 140, y: 200 }, { x: 140, y: 200 }, { x: 2, y: 4 }];
  const place = placer(plot, marks);
  return marks.map((mark) => place(mark, 60));
});
"""


def test_texts_cover_neither_each_other_nor_the_curve(seen: Browser) -> None:
    high, beside, crowded, cornered = seen.run(PLACED)
    assert high["left"] <= 100 - 30 + 2 and high["leader"] is None, "centred above its own peak"
    assert beside["left"] > 101, "moved off the stem of the higher peak"
    assert crowded is None or crowded["leader"] is not None, "lifted over its neighbour, or left out"
    assert cornered is None, "no room in the corner"
    texts = int(seen.run(f"return document.querySelector('{SPECTRUM}').dataset.texts"))
    assert texts >= 20


def test_a_family_is_switched_in_plot_and_table(result: Browser) -> None:
    before = int(markers(result))
    assert result.count('.peaks-table tr[data-label="1*f_m"]') == 1
    result.click('#card-spectrum [data-family="mesh"]')
    eventually(lambda: int(markers(result)) < before, what="fewer markers")
    assert result.count('.peaks-table tr[data-label="1*f_m"]') == 0
    assert result.run("return document.querySelector('#card-peaks [data-family=mesh]').ariaPressed") == "false"
    result.click('#card-peaks [data-family="mesh"]')
    eventually(lambda: int(markers(result)) == before, what="the markers again")


def test_absent_lines_are_listed_with_what_would_have_been_seen(result: Browser) -> None:
    result.click('[aria-label="Status of the lines"] [data-value="absent"]')
    assert "<" in result.text('.peaks-table tr[data-status="absent"]')
    assert result.count('.peaks-table tr[data-status="present"]') == 0


def test_keys_and_buttons_zoom_and_move(result: Browser) -> None:
    first = view(result, SPECTRUM)
    result.type(SPECTRUM, "++")
    eventually(lambda: view(result, SPECTRUM)[1] - view(result, SPECTRUM)[0] < 0.6 * (first[1] - first[0]), what="zoom")
    zoomed = view(result, SPECTRUM)
    result.click('#card-spectrum [aria-label="Move right"]')
    eventually(lambda: view(result, SPECTRUM)[0] > zoomed[0], what="a move")
    result.click('#card-spectrum [aria-label="Show all"]')
    eventually(lambda: view(result, SPECTRUM)[1] > 7000, what="the whole axis")


def test_a_zoomed_time_signal_is_fetched_in_detail(result: Browser) -> None:
    canvas = "#card-time canvas.plot-canvas"
    result.find(canvas)
    for _ in range(6):
        result.click('#card-time [aria-label="Zoom in"]')
    script = """
    const low_high = document.querySelector(arguments[0]).dataset.view.split(" ").map(Number);
    const fetched = performance.getEntriesByType("resource").map((e) => new URL(e.name))
      .filter((u) => u.pathname.endsWith("/signals") && u.searchParams.get("channel") === "resonator1.y.acceleration");
    const last = fetched.at(-1).searchParams;
    return [Number(last.get("start_s")) <= low_high[0], Number(last.get("end_s")) >= low_high[1],
            Number(last.get("end_s")) - Number(last.get("start_s")), low_high[1] - low_high[0]];
    """

    def detailed() -> bool:
        starts, ends, fetched_s, seen_s = result.run(script, canvas)
        return bool(starts and ends and seen_s < 0.1 and fetched_s * DEMO["sampling_rate_hz"] <= UNTHINNED)

    eventually(detailed, what="the stretch in view")


def test_choosing_a_peak_shows_it_in_the_spectrum(result: Browser) -> None:
    result.click('.peaks-table tr[data-label="5*f_m"] .row-button')
    eventually(lambda: view(result, SPECTRUM)[0] < 3450 < view(result, SPECTRUM)[1], what="5 f_m in view")
    assert "chosen" in result.run("return document.querySelector('tr[data-label=\"5*f_m\"]').className")


def test_another_channel_brings_its_own_labels(result: Browser, service: Service) -> None:
    result.run(
        "const s = document.getElementById('channel'); s.value = 'bearing1.inner.y.displacement';"
        "s.dispatchEvent(new Event('change'))"
    )
    eventually(lambda: "µm" in result.text(AMPLITUDE) or "nm" in result.text(AMPLITUDE), what="lengths")
    assert "Envelope spectra are made of accelerations" in result.text("#card-envelope")


def test_other_spectra_are_a_click_away(result: Browser) -> None:
    result.click('#card-spectrum [data-value="order"]')
    eventually(lambda: "revolutions" in result.text("#card-spectrum .notes"), what="the order spectrum")
    result.click('#card-spectrum [data-value="psd"]')
    eventually(lambda: "averages" in result.text("#card-spectrum .notes"), what="the density")


def test_an_unknown_job_is_told(browser: Browser, service: Service) -> None:
    browser.open(service.page("/jobs/0123456789"))
    assert "0123456789" in browser.text("[role=alert]")
    assert any("404" in line for line in browser.complaints())


def finished(service: Service, **body: object) -> str:
    job = str(service.client.post("/v1/simulations", json=body).raise_for_status().json()["id"])
    service.wait(job, "successful")
    return job


def test_a_machine_without_lines_says_why(browser: Browser, service: Service) -> None:
    job = finished(service, preset="oscillator", duration_s=0.5)
    browser.open(service.page(f"/jobs/{job}"))
    eventually(lambda: "nothing turns in this machine" in browser.text(".peaks-table tbody"), what="the reason")


def test_the_start_up_does_not_set_the_scale(browser: Browser, service: Service) -> None:
    # Half of the record is transient: it is analysed whole, but seen from where it has settled.
    machine = service.client.get("/v1/presets/oscillator").json()
    machine["loads"].append({"kind": "force", "body": "mass", "axis": "y", "amplitude_n": 1.0, "frequency_hz": 20.0})
    job = finished(service, machine=machine, duration_s=0.5)
    browser.open(service.page(f"/jobs/{job}"))
    canvas = "#card-time canvas.plot-canvas"
    eventually(lambda: browser.run("return document.querySelector(arguments[0])?.dataset.view", canvas), what="a view")
    summary = service.client.get(f"/v1/jobs/{job}/result").json()
    assert summary["analysed_from_s"] == 0
    low, high = view(browser, canvas)
    assert low >= 0.2 and high == pytest.approx(0.5)


def test_a_ring_down_is_seen_from_its_beginning(browser: Browser, service: Service) -> None:
    job = finished(service, preset="oscillator", duration_s=0.5)
    browser.open(service.page(f"/jobs/{job}"))
    canvas = "#card-time canvas.plot-canvas"
    eventually(lambda: browser.run("return document.querySelector(arguments[0])?.dataset.view", canvas), what="a view")
    assert view(browser, canvas)[0] == 0.0
    text = browser.text("#card-quality")
    assert "Ring-down" in text and "simulate longer" not in text


def test_nothing_hidden_lengthens_the_page(result: Browser) -> None:
    result.size(400, 900)
    left = (
        "const foot = document.querySelector('footer').getBoundingClientRect();"
        "return document.documentElement.scrollHeight - foot.bottom - window.scrollY"
    )
    eventually(lambda: result.run(left) < 40, what="the page to end at its foot")


def test_a_machine_of_angles_is_labelled(browser: Browser, service: Service) -> None:
    job = finished(service, preset="gear-pair", duration_s=0.5)
    browser.open(service.page(f"/jobs/{job}"))
    browser.find('.peaks-table tr[data-label="1*f_m"]')
    assert "rad/s²" in browser.text(AMPLITUDE)
