"""Individual pitch deviations: where each pair touches without load."""

from __future__ import annotations

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import TermSpec, TransmissionError
from sim.presets import preset
from sim.terms import REGISTRY
from tests.strategies.meshes import at_phase, element_of, root_of
from tests.strategies.systems import with_terms

RMS_M = 7e-6


@pytest.mark.slow
@pytest.mark.parametrize(("site", "teeth"), [("pinion", 23), ("gear", 81)])
def test_the_teeth_touch_where_their_deviations_put_them(site, teeth):
    plain = preset("gear-pair")
    mesh = plain.meshes[0].model_copy(update={"transmission_error": TransmissionError()})
    term = TermSpec(term="pitch_error", site=site, parameters={"rms": RMS_M})
    element = element_of(assemble(with_terms(plain.model_copy(update={"meshes": [mesh]}), term)), "mesh1")

    def rest_m(pair):
        # half way through the single contact of this pair (contact ratio 1.709)
        def force(s):
            return float(at_phase(element, 23, pair + 0.85, np.array([s, 0, 0, 0, 0.0]), np.zeros(5)).force[0])

        return root_of(force, -1e-4, 1e-4)

    found = np.array([rest_m(pair) for pair in range(teeth)])
    allowed = REGISTRY.get("pitch_error").validation[0].deviation
    assert float(np.sqrt(np.mean(found**2))) == pytest.approx(RMS_M, rel=allowed)
    assert float(np.mean(found)) == pytest.approx(0.0, abs=allowed * RMS_M)
    assert rest_m(teeth) == pytest.approx(found[0], abs=1e-12)
