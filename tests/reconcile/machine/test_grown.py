"""What is named and was in the machine file already is said to have been there, with its size then."""

from __future__ import annotations

import pytest

from reconcile.machine.grown import with_grown
from reconcile.verdict import Cause, Report
from sim.core.spec import TermSpec
from sim.presets import preset

HAS = TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 2e-5})
MACHINE = preset("paper-lightly-damped").model_copy(update={"terms": [HAS]})


def report(site: str, named: bool) -> Report:
    cause = Cause(term="fit_clearance", site=site, severity=None, score=9.0, named=named)
    return Report(verdict="explained", sentence="Fit clearance.", level="machine", causes=(cause,))


@pytest.mark.parametrize(
    ("site", "named", "said"), [("bearing1", True, True), ("bearing1", False, False), ("bearing2", True, False)]
)
def test_a_named_effect_that_the_file_has_is_said_to_have_grown(site: str, named: bool, said: bool) -> None:
    found = with_grown(report(site, named), MACHINE).sentence
    assert (found == "Fit clearance.") is not said
    assert not said or found.endswith("at bearing1 is in the machine file already, with 20 µm.")
