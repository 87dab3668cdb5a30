"""Labels of machines whose speed changes: frequencies of the analysed stretch, or the reason why there are none."""

from __future__ import annotations

import pytest

from jobs.analysis import analyse
from jobs.stretch import at_stretch
from signals.overrides import apply_overrides
from sim.core.spec import MachineSpec, MeasuredSpeed, RampSpeed, SpeedProfile
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings


def turning(profile: SpeedProfile) -> MachineSpec:
    machine = preset("paper-demo")
    assert machine.operating is not None
    return machine.model_copy(update={"operating": machine.operating.model_copy(update={"profile": profile})})


@pytest.mark.slow
def test_a_ramp_that_is_over_leaves_the_frequencies_of_the_new_speed() -> None:
    machine = turning(RampSpeed(end_ratio=0.9, duration_s=0.15))
    response = simulate(machine, duration_s=1.0, output_rate_hz=20_000.0, settings=Settings(estimate_error=False))
    late = at_stretch(response, 0.3)
    assert late.bases_hz["f_m"] == pytest.approx(0.9 * 690.0)
    documents = analyse(response, discard_transient=True)
    start_s = documents.summary["analysed_from_s"]
    peaks = {p["label"]: p for p in documents.peaks["peaks"]} if start_s > 0.15 else {}
    if peaks:
        assert peaks["1*f_m"]["status"] == "present"
        assert peaks["1*f_m"]["frequency_hz"] == pytest.approx(621.0, abs=2.0)


@pytest.mark.slow
def test_a_long_ramp_is_not_labelled_and_says_why() -> None:
    machine = turning(RampSpeed(end_ratio=1.5, duration_s=0.3))
    response = simulate(machine, duration_s=0.3, output_rate_hz=20_000.0, settings=Settings(estimate_error=False))
    documents = analyse(response, discard_transient=False)
    assert "order spectrum" in str(documents.peaks["reason"])
    assert [s.kind for s in documents.spectra if s.kind == "order"]


@pytest.mark.slow
def test_a_shaft_that_stands_still_has_no_order_spectrum() -> None:
    machine = turning(RampSpeed(end_ratio=0.0, duration_s=0.2))
    response = simulate(machine, duration_s=0.3, output_rate_hz=20_000.0, settings=Settings(estimate_error=False))
    documents = analyse(response, discard_transient=False)
    assert not [s.kind for s in documents.spectra if s.kind == "order"]


def test_measured_speeds_come_through_json() -> None:
    machine = turning(MeasuredSpeed(step_s=0.1, ratios=(1.0, 0.9, 1.0)))
    again = MachineSpec.model_validate_json(machine.model_dump_json())
    assert again == machine
    assert apply_overrides(machine, {}) == machine
