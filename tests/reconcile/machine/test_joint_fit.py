"""A loose seat at two speeds, from the recordings to the revised machine: fitted together with the machine."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from reconcile.atlas.candidates import Candidate
from reconcile.calibrate.uncertain import DRIFT, draw_offsets, moved, uncertain_numbers
from reconcile.entry import reconcile_recordings
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings
from tests.reconcile import prebuilt
from tests.reconcile.few import BUDGET
from tests.reconcile.machine.test_reconcile_machine import RATE_HZ, SETTLE_S
from tests.reconcile.remembered import Simulated

SPEEDS_HZ = (30.0, 39.0)
SENSORS = ("resonator1.y.acceleration", "resonator2.y.acceleration")
LOSS = 0.5
LOOSE = TermSpec(term="pedestal_looseness", site="bearing2", parameters={"loss": LOSS})
NOMINATED = tuple(
    Candidate(term=term, site=site)
    for term, site in (
        ("pedestal_looseness", "bearing1"),
        ("pedestal_looseness", "bearing2"),
        ("bearing_stiffness", "bearing2"),
        ("tooth_friction", "mesh1"),
    )
)


def wanted() -> list[prebuilt.Wanted]:
    """The atlases of both speeds, which stand beside this test."""
    nominal, folder = preset("paper-lightly-damped"), Path(__file__).parent / "atlas"
    places = tuple(f"bearing{s[9]}.y" for s in SENSORS)
    return [prebuilt.wanted(nominal, NOMINATED, places, hz, folder / f"loose-{hz:g}hz.npz") for hz in SPEEDS_HZ]


def measured(machine: MachineSpec, speed_hz: float, seed: int) -> Recording:
    """1.2 s with white noise of a tenth of each signal's deviation."""
    assert machine.operating is not None
    turning = machine.model_copy(
        update={"operating": machine.operating.model_copy(update={"speed_hz": speed_hz, "profile": None})}
    )
    response = simulate(
        turning, duration_s=SETTLE_S + 1.2, output_rate_hz=RATE_HZ, channels=list(SENSORS), seed=seed,
        settings=Settings(rtol=1e-3, estimate_error=False),
    )  # fmt: skip
    rows = np.asarray(response.signals)[:, round(SETTLE_S * RATE_HZ) :]
    noise = np.random.default_rng(seed).normal(size=rows.shape) * 0.1 * rows.std(axis=1, keepdims=True)
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=tuple(
            Channel(name=s, quantity="acceleration", unit="m/s^2", location=f"bearing{s[9]}", axis="y") for s in SENSORS
        ),
        samples=rows + noise,
        operating=Operating(shaft="input", speed_hz=speed_hz, torque_nm=25.0),
    )


@pytest.mark.slow
@pytest.mark.long
@pytest.mark.xdist_group("reconcile-machine")
def test_a_loose_seat_is_named_and_the_revised_machine_is_the_one_that_fits_with_it(
    simulated: Simulated, tmp_path: Path, few_machines: None
) -> None:
    nominal = preset("paper-lightly-damped")
    numbers = uncertain_numbers(nominal)
    base = draw_offsets(numbers, np.random.default_rng(91))
    later = base.mixed(draw_offsets(numbers, np.random.default_rng(92)), DRIFT)
    real, drifted = (moved(nominal, numbers, o) for o in (base, later))
    loose = drifted.model_copy(update={"terms": [*drifted.terms, LOOSE]})
    report = reconcile_recordings(
        nominal,
        [measured(loose, hz, 610 + k) for k, hz in enumerate(SPEEDS_HZ)],
        [measured(real, hz, 600 + k) for k, hz in enumerate(SPEEDS_HZ)],
        budget=BUDGET,
        keeper=prebuilt.kept(wanted(), tmp_path),
        mapper=simulated,
        nominated=NOMINATED,
    )
    assert report.verdict == "explained", report.sentence
    best = report.causes[0]
    assert (best.term, best.site) == ("pedestal_looseness", "bearing2")
    assert best.severity is not None and best.severity.low < LOSS < best.severity.high
    judge = next(dict(s) for s in report.stages if s["name"] == "judge")
    assert "pedestal_looseness@bearing2" in judge["fitted_with_the_machine"]
    assert judge["lines_explained"] > 0.5
    assert report.held_out is not None and report.held_out.gain > max(0.1, report.held_out.placebo or 0.0)
    assert report.machine is not None
    again = MachineSpec.model_validate(report.machine)
    assert again.terms[-1].term == "pedestal_looseness"
    stiffness = [m.bearings[0].support.stiffness_x_n_per_m for m in (again, nominal) if m.bearings[0].support]
    assert stiffness[0] != stiffness[1] and abs(stiffness[0] / stiffness[1] - 1.0) < 0.2
