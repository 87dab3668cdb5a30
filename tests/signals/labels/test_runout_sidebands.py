"""The pinion's run-out is what puts sidebands of the shaft speed beside the mesh lines."""

from __future__ import annotations

import pytest

from signals.labels.families import kinematic_lines
from signals.labels.machine import machine_kinematics
from signals.labels.match import label_peaks
from signals.series import Series
from signals.spectra.amplitude import amplitude_spectrum
from sim.assembly.assemble import assemble
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.settings import Settings

RATE_HZ = 30_000.0
SETTLED = 9_000
SIDEBANDS = ("1*f_m-1*f_r1", "1*f_m+1*f_r1")


def labels_of(machine):
    response = simulate(
        machine, duration_s=1.0, output_rate_hz=RATE_HZ, settings=Settings(estimate_error=False, steps_per_output=2)
    )
    channel = response.channels[0]
    series = Series(
        samples=response.signals[0, SETTLED:],
        sampling_rate_hz=RATE_HZ,
        unit=channel.unit,
        name=channel.name,
        quantity=channel.quantity,
        start_s=SETTLED / RATE_HZ,
    )
    kinematics = machine_kinematics(machine, response.bases_hz)
    lines = [
        *kinematic_lines(kinematics, response.bases_hz, max_frequency_hz=RATE_HZ / 2.56),
        *assemble(machine).lines,
    ]
    return label_peaks(amplitude_spectrum(series), lines, response.bases_hz, kinematics=kinematics, reference="f_r1")


@pytest.mark.slow
@pytest.mark.parametrize("rotation", ["printed", "geared"])
def test_sidebands_come_with_the_run_out_and_go_with_it(rotation):
    demo = preset("paper-demo")
    demo = demo.model_copy(update={"operating": demo.operating.model_copy(update={"rotation": rotation})})
    round_teeth = demo.model_copy(update={"terms": [t for t in demo.terms if t.term != "eccentricity"]})
    with_runout, without = labels_of(demo), labels_of(round_teeth)
    assert with_runout["1*f_m"].status == without["1*f_m"].status == "present"
    for label in SIDEBANDS:
        assert with_runout[label].status == "present", label
        assert without[label].status == "absent", label
