"""Gaps of a motion of which a derivative was measured are counted from where the mass rests."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.driven.channels import driven_of
from reconcile.driven.fit import Fitted, _from_rest
from reconcile.driven.model import Model, ready, simulated
from reconcile.force_law.library import ABOVE, BELOW, CUBIC, DRAG, STOPS, Law
from sim.presets import preset
from tests.reconcile.driven.shaken import DAMPING, MASS, STIFFNESS, pair

OWN = preset("oscillator")
GAP = 1.5e-4
TRUE = Model(stiffness=STIFFNESS / MASS, damping=DAMPING / MASS, gain=1 / MASS, offset=4.0)


def settled(model: Model, order: int) -> Model:
    return _from_rest(Fitted(model=model, covariance=np.zeros((6, 6)), error=np.zeros(4)), order).model


@pytest.mark.slow
@pytest.mark.parametrize("law", [replace(ABOVE, shape=GAP), replace(BELOW, shape=GAP)])
def test_a_constant_force_goes_into_the_gap_and_the_motion_stays(law: Law) -> None:
    data = driven_of(pair("none", "m", seed=2, n=3000)[0], OWN)
    other = replace(data, answer_channel=replace(data.answer_channel, quantity="acceleration", unit="m/s^2"))
    model = TRUE.with_laws((law, DRAG), (1e5 / MASS, 20.0))
    found = settled(model, 2)
    assert found.offset == 0.0 and found.laws[0].shape != law.shape
    run = replace(ready(other, 0.2), skip=0)
    first, second = simulated(model, run)[1000:], simulated(found, run)[1000:]
    np.testing.assert_allclose(second, first, atol=1e-3 * float(np.std(first)))


@pytest.mark.parametrize(
    ("laws", "order"), [((ABOVE,), 0), ((CUBIC,), 2), ((STOPS,), 2), ((ABOVE, CUBIC), 2), ((DRAG,), 2)]
)
def test_a_constant_force_stays_where_it_is_told(laws: tuple[Law, ...], order: int) -> None:
    model = TRUE.with_laws(laws, (1e5,) * len(laws))
    assert settled(model, order) == model
