"""Cage slip: the balls' passing falls by the share that is lost, in the kinematics and in a simulated signal."""

from __future__ import annotations

import numpy as np
import pytest

from signals.recording import from_response
from signals.spectra import amplitude_spectrum
from sim.assembly.assemble import assemble
from sim.solve.api import simulate
from sim.solve.settings import Settings
from sim.terms.cage_slip import TERM
from tests.strategies.bearings import bearing_with, element_of, turned


@pytest.mark.parametrize("share", [0.0, 0.02, 0.3])
def test_the_balls_turn_slower_by_the_share_and_the_inner_pass_keeps_the_sum(share):
    system, element = element_of(bearing_with(("cage_slip", {"share": share})))
    healthy, sound = element_of(bearing_with())
    assert element.parameters[3] == pytest.approx(sound.parameters[3] * (1.0 - share), rel=1e-12)
    bases, usual = system.bases_hz, healthy.bases_hz
    assert bases["f_c1"] == pytest.approx(usual["f_c1"] * (1.0 - share), rel=1e-12)
    assert bases["f_o1"] + bases["f_i1"] == pytest.approx(9.0 * 30.0, rel=1e-12)


@pytest.mark.slow
@pytest.mark.parametrize("speed_hz", [12.0, 25.0, 40.0])
def test_the_load_passes_at_the_slipped_frequency(speed_hz):
    machine = turned(bearing_with(("cage_slip", {"share": 0.05})), speed_hz)
    run = simulate(machine, duration_s=4.2, output_rate_hz=6_000.0, settings=Settings(estimate_error=False))
    recording = from_response(run).select(start_s=0.2)
    spectrum = amplitude_spectrum(recording.series("bearing1.outer.x.acceleration"))
    rolling = 4.5 * speed_hz * (1.0 - 0.00794 / 0.03904)
    near = (spectrum.frequency_hz > 0.9 * rolling) & (spectrum.frequency_hz < 0.98 * rolling)
    found = spectrum.frequency_hz[near][np.argmax(spectrum.values[near])]
    assert found == pytest.approx(assemble(machine).bases_hz["f_o1"], abs=spectrum.resolution_hz)
    allowed = TERM.validation[0].deviation
    assert found == pytest.approx(0.95 * rolling, rel=allowed)
