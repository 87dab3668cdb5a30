"""The form: generated from the declared terms, checked by the server, understandable when it refuses."""

from __future__ import annotations

import pytest

from tests.browser.conftest import Service
from tests.browser.driver import Browser, eventually

CLEARANCE = '[data-effect="fit_clearance@bearing1"]'
RPM = "document.querySelector('[aria-label=\"Shaft speed in rpm\"]')"
GAP = f"{CLEARANCE} [data-param=gap] input[type=number]"


@pytest.fixture
def form(browser: Browser, service: Service) -> Browser:
    browser.open(service.page("/new?preset=paper-demo"))
    browser.find("aside, [aria-label='Machine check'] .facts")
    return browser


def test_every_parameter_of_a_term_is_shown_as_declared(form: Browser, service: Service) -> None:
    terms = {term["key"]: term for term in service.client.get("/v1/terms").json()["terms"]}
    form.click(f"{CLEARANCE} summary")
    for param in terms["fit_clearance"]["parameters"]:
        text = form.text(f'{CLEARANCE} [data-param="{param["name"]}"]')
        assert param["sentence"] in text
    assert "0 to 500 µm" in form.text(f"{CLEARANCE} [data-param=gap]")
    assert float(form.run(f"return document.querySelector('{GAP}').value")) == pytest.approx(20)
    assert terms["fit_clearance"]["sentence"] in form.text(CLEARANCE)


def test_the_machine_check_follows_the_speed(form: Browser) -> None:
    form.type("[data-param=speed_hz] input", "60", clear=True)
    eventually(lambda: "154.41 Hz" in form.text("[aria-label='Machine check']"), what="f_o1 at twice the speed")
    assert form.run(f"return {RPM}.value") == "3600"


def test_a_speed_may_be_given_in_rpm(form: Browser) -> None:
    form.type('[aria-label="Shaft speed in rpm"]', "3600", clear=True)
    eventually(lambda: "154.41 Hz" in form.text("[aria-label='Machine check']"), what="f_o1 at twice the speed")
    assert form.run("return document.querySelector('[data-param=speed_hz] input').value") == "60"


def test_values_are_stepped_by_round_amounts_within_their_bounds(form: Browser) -> None:
    value = f"return document.querySelector('{GAP}').value"
    form.click('[aria-label="More gap"]')
    assert form.run(value) == "22"
    form.type(GAP, "\ue015" * 2)  # arrow down
    assert form.run(value) == "18"
    form.type(GAP, "495", clear=True)
    form.click('[aria-label="More gap"]')
    form.click('[aria-label="More gap"]')
    assert form.run(value) == "500"
    assert form.count("[aria-invalid=true]") == 0


def test_refused_values_are_named_with_what_is_allowed(form: Browser) -> None:
    form.type(GAP, "5000", clear=True)
    assert form.run(f"return document.querySelector('{GAP}').getAttribute('aria-invalid')") == "true"
    form.click("button[type=submit]")
    box = form.text(".form-problems [role=alert]")
    assert "Gap" in box
    assert "0.005 m" in box and "0 to 0.0005 m" in box
    assert form.run("return document.activeElement === document.querySelector('.form-problems [role=alert]')")
    assert any("422" in line for line in form.complaints())


def test_several_refusals_are_listed_together(form: Browser) -> None:
    form.type("[data-param=duration_s] input", "-1", clear=True)
    form.type("[data-param=sampling_rate_hz] input", "3", clear=True)
    form.click("button[type=submit]")
    box = form.text(".form-problems [role=alert]")
    assert "2 values must change" in box and "Duration" in box and "Sampling rate" in box
    assert form.count("[aria-invalid=true]") == 2
    assert any("422" in line for line in form.complaints())


def test_from_the_form_to_the_result(form: Browser, service: Service) -> None:
    form.type(GAP, "50", clear=True)
    form.type("[data-param=duration_s] input", "0.8", clear=True)
    eventually(lambda: "(4)" in form.text(".outputs-list"), what="the outputs to be known")
    form.click("button[type=submit]")
    form.find("#card-time canvas", within_s=60)
    job = form.run("return location.hash").rsplit("/", 1)[1]
    request = service.client.get(f"/v1/jobs/{job}").json()["request"]
    assert request["preset"] == "paper-demo"
    assert request["set"] == {"fit_clearance@bearing1.gap": pytest.approx(5e-5)}
    assert {"bearing1.inner.x.displacement", "mesh1.stiffness", "resonator1.y.acceleration"} <= set(request["channels"])
    assert "bearing 1 gap 50" in form.text(".result-title")


def test_an_effect_of_the_preset_can_be_left_out(form: Browser, service: Service) -> None:
    form.click('[data-effect="eccentricity@pinion"] input[type=checkbox]')
    form.type("[data-param=duration_s] input", "0.5", clear=True)
    form.click("button[type=submit]")
    form.find(".result-title h1")
    job = form.run("return location.hash").rsplit("/", 1)[1]
    service.wait(job, "successful")
    form.find(".peaks-table tr[data-label]", within_s=30)
    peaks = service.client.get(f"/v1/jobs/{job}/result/peaks").json()["peaks"]
    assert not any("eccentricity" in mechanism for peak in peaks for mechanism in peak["mechanisms"])


def test_a_request_can_be_changed_and_run_again(form: Browser, service: Service) -> None:
    body = {
        "preset": "rotor",
        "set": {"operating.speed_hz": 41},
        "duration_s": 0.3,
        "sampling_rate_hz": 12000,
        "seed": 5,
    }
    job = service.client.post("/v1/simulations", json=body).json()["id"]
    form.open(service.page(f"/new?from={job}"))
    form.find("[aria-label='Machine check'] .facts")
    values = {
        name: form.run(f"return document.querySelector('[data-param={name}] input').value")
        for name in ("speed_hz", "duration_s", "seed")
    }
    assert values == {"speed_hz": "41", "duration_s": "0.3", "seed": "5"}
    assert form.run("return document.getElementById('preset').value") == "rotor"


ESTIMATE = "[aria-label=Estimate]"


def test_the_estimate_and_the_limits_are_the_servers(form: Browser, service: Service) -> None:
    limits = service.client.get("/v1/limits").json()
    assert f"to {limits['duration_s']:g} s" in form.text("[data-param=duration_s]")
    eventually(lambda: "Solver steps" in form.text(ESTIMATE), what="the estimate")
    assert "2\u202fmin of simulated time" in form.text(ESTIMATE)
    before = form.text(ESTIMATE)
    form.type("[data-param=duration_s] input", "20", clear=True)
    eventually(lambda: form.text(ESTIMATE) != before, what="another estimate")


def test_what_the_server_refuses_of_the_run_is_told_at_its_field(form: Browser, service: Service) -> None:
    form.type("[data-param=sampling_rate_hz] input", "500", clear=True)
    field = "[data-param=sampling_rate_hz]"
    eventually(lambda: "too low for the labels" in form.text(field), what="the refusal at the field")
    assert form.count(f"{field} [aria-invalid=true]") == 1
    assert "No estimate" in form.text(ESTIMATE)
    assert any("422" in line for line in form.complaints())


def test_a_measurement_chain_is_put_together_and_simulated(form: Browser, service: Service) -> None:
    add = "const s = document.querySelector(arguments[1]);s.value = arguments[0]; s.dispatchEvent(new Event('change'))"
    chooser = "[aria-label='Add a sensor']"
    known = {sensor["name"]: sensor for sensor in service.client.get("/v1/sensors").json()["sensors"]}
    form.run(add, "icp-100mv-g", chooser)
    form.run(add, "once-per-turn", chooser)
    assert known["icp-100mv-g"]["sentence"] in form.text("[data-sensor=icp-100mv-g]")
    form.type("#recorder-rate", "90000", clear=True)
    rate = "[data-param=recorder_rate_hz]"
    eventually(lambda: "nothing new would be seen" in form.text(rate), what="the refusal at the recorder's rate")
    assert any("422" in line for line in form.complaints())
    form.type("#recorder-rate", "12000", clear=True)
    eventually(
        lambda: "nothing new" not in form.text(rate) and "Recorded channels" in form.text(ESTIMATE), what="sense"
    )
    form.type("[data-param=duration_s] input", "0.6", clear=True)
    form.click("button[type=submit]")
    form.find(".result-title h1")
    job = form.run("return location.hash").rsplit("/", 1)[1]
    service.wait(job, "successful")
    request = service.client.get(f"/v1/jobs/{job}").json()["request"]
    assert [channel["preset"] for channel in request["sensors"]["channels"]] == ["icp-100mv-g", "once-per-turn"]
    form.find("#card-time canvas", within_s=30)
    form.open(service.page(f"/new?from={job}"))
    assert "The earlier request had" in form.text(".sensors")
