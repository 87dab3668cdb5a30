"""One short case through simulation and measurement."""

from __future__ import annotations

import numpy as np
import pytest

from paper.cases import Case, Setting
from paper.measure.mean import total_stiffness
from paper.run import pair_law, run


@pytest.mark.slow
def test_law_of_the_measure_is_the_law_of_the_simulation() -> None:
    window, response = run(Case(setting=Setting(preset="paper", form="true"), gap_um=10.0))
    law = pair_law(response.machine)
    assert law is not None
    k, a = window.signals["k"], window.signals["a"]
    phase = np.arange(k.size) / window.per_mesh
    expected = total_stiffness(law, phase, a)
    inside = np.abs(expected / k - 1.0) < 0.1  # a sample on a jump may fall on either side
    assert inside.mean() > 0.95
    np.testing.assert_allclose(expected[inside], k[inside], rtol=1e-9)
