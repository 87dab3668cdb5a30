"""What is named and was in the machine file already is said to have been there, with its size then."""

from __future__ import annotations

import pytest

from reconcile.machine.grown import with_grown
from reconcile.verdict import Cause, Report, Severity
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


def test_one_of_a_set_says_from_what_it_would_have_grown_to_what() -> None:
    size = Severity(name="gap", value=6.5e-5, unit="m", low=3.9e-5, high=1.07e-4)
    cause = Cause(term="fit_clearance", site="bearing1", severity=size, score=9.0, named=False)
    said = "The mechanism is not decided: fit clearance, rigid housing at bearing1, or internal clearance at bearing1."
    found = with_grown(Report(verdict="ambiguous", sentence=said, level="machine", causes=(cause,)), MACHINE).sentence
    assert found.endswith("already, with 20 µm, and would have grown to 65 µm (39 µm to 107 µm).")
