"""Every registered effect has a picture of its law, which shows the effect and nothing where there is none."""

from __future__ import annotations

import json

import numpy as np
import pytest

from jobs.demonstration import demonstration
from jobs.law_document import law_document, panels
from sim.assembly.assemble import BUILT_IN
from sim.core.spec import TermSpec
from sim.solve.law_picture import law_picture
from sim.terms import REGISTRY

UNITS = {"m", "rad", "m/s", "rad/s", "s", "Hz", "N", "N*m", "N/m"}
MOST_POINTS = 2048
ALL = [pytest.param(term, id=term.key) for term in REGISTRY]
HEALTHY = [pytest.param(t, id=t.key) for t in REGISTRY if t.key not in BUILT_IN and t.severity and t.zero_is_healthy]


@pytest.mark.slow
@pytest.mark.parametrize("term", ALL)
def test_the_picture_shows_the_effect(term):
    found = panels(term, demonstration(term))
    assert found, "no panel shows what the effect changes"
    for panel in found:
        assert panel.title and panel.caption.endswith(".") and panel.x.label and panel.y.label
        assert {panel.x.unit, panel.y.unit} <= UNITS
        assert 2 < panel.values.size <= MOST_POINTS
        assert np.all(np.diff(panel.values) > 0.0)
        for curve in panel.curves:
            assert curve.here.shape == panel.values.shape and np.all(np.isfinite(curve.here))
            assert (curve.without is None) == (term.key in BUILT_IN)
            assert curve.without is None or (
                curve.without.shape == curve.here.shape and np.all(np.isfinite(curve.without))
            )
        assert panel.telling


@pytest.mark.slow
@pytest.mark.parametrize("term", HEALTHY)
def test_at_zero_severity_there_is_nothing_to_show(term):
    shown = demonstration(term)
    values = {**term.demo.values, term.severity: 0.0}
    acting = TermSpec(term=term.key, site=shown.site, parameters=values)
    machine = shown.without.model_copy(update={"terms": [*shown.without.terms, acting]})
    assert law_picture(machine, shown.without, site=shown.site) == ()


@pytest.mark.slow
@pytest.mark.parametrize("key", ["tooth_crack", "fit_clearance", "mesh_pairs"])
def test_documents_are_plain(key):
    found = json.loads(json.dumps(law_document(REGISTRY.get(key)), allow_nan=False))
    first = found["panels"][0]
    assert len(first["x"]["values"]) == len(first["curves"][0]["with"])
    assert (first["curves"][0]["without"] is None) == (key in BUILT_IN)
