"""A cubic about a point beside rest is told with the spring that it makes about rest; one about rest is not."""

from __future__ import annotations

import re
from dataclasses import replace

import pytest

from reconcile.driven.analysis import analyse
from reconcile.driven.another import beside_baseline
from reconcile.driven.answer import answer
from reconcile.driven.aside import Aside, aside, seen_from_rest
from reconcile.driven.changed import changes
from reconcile.driven.channels import driven_of
from reconcile.driven.fit import fit
from reconcile.driven.forced import Analysis
from reconcile.driven.law_words import law_words
from reconcile.driven.machine import driven_site
from reconcile.driven.measured import look
from reconcile.driven.model import Model, ready
from reconcile.driven.split import parts_of
from reconcile.force_law.library import CUBIC, QUADRATIC, STOPS
from sim.presets import preset
from tests.reconcile.driven.shaken import DAMPING, MASS, STIFFNESS, pair

SPEC = preset("oscillator")
BODY = SPEC.bodies[0].model_copy(
    update={"mass_kg": MASS, "stiffness_y_n_per_m": STIFFNESS, "damping_y_ns_per_m": DAMPING}
)
OWN = SPEC.model_copy(update={"bodies": [BODY]})
FROM_REST = (
    r"from a point ([\d.]+) mm from rest, beside a constant force of ([\d.]+) N, the input's mean with it\. "
    r"About rest the spring is not odd: it has ([\d.e+]+) N/m"
)
AWAY = 4e7 / 3e10
START = Model(
    stiffness=(STIFFNESS - 3e10 * AWAY**2) / MASS,
    damping=DAMPING / MASS,
    gain=1 / MASS,
    offset=(STIFFNESS * AWAY - 2e10 * AWAY**3) / MASS,
    output_offset=-AWAY,
)


@pytest.fixture(scope="module")
def cubic() -> Analysis:
    return analyse(parts_of([driven_of(r, OWN) for r in pair("cubic", "m", seed=1)]), 0)


@pytest.fixture(scope="module")
def leaning(cubic: Analysis) -> Analysis:
    """What the fit makes of a spring with an even part, where a cubic is asked for."""
    run = ready(driven_of(pair("leaning", "m", seed=1)[1], OWN), cubic.linear.model.memory_s)
    return replace(cubic, final=fit(START.with_laws((CUBIC,), (1e10 / MASS,)), run), held_run=run, power=None)


def of(found: Analysis, key: str) -> Analysis:
    """The same with the one law of that name about the model's own zero."""
    law = {"cubic": CUBIC, "quadratic": QUADRATIC, "stops": replace(STOPS, shape=1e-4)}[key]
    model = replace(found.final.model, laws=(law,), coefficients=(1e10 / MASS if key == "cubic" else 4e7 / MASS,))
    return replace(found, final=replace(found.final, model=model), validations=())


@pytest.mark.slow
def test_a_cubic_about_another_point_is_told_with_the_spring_about_rest(leaning: Analysis) -> None:
    report = answer(OWN, leaning, seed=0, provenance={})
    assert report.verdict == "explained" and report.machine is not None, report.sentence
    said = aside(leaning)
    assert said is not None
    mass = 1.0 / leaning.final.model.gain
    assert mass * said.stiffness == pytest.approx(STIFFNESS, rel=0.02)
    assert mass * said.even == pytest.approx(4e7, rel=0.05)
    limit = next(x for x in report.where.limits if "from rest" in x)
    found = re.search(FROM_REST, limit)
    assert found is not None, limit
    assert float(found[1]) == pytest.approx(AWAY * 1e3, rel=0.05)
    force = next(x for x in report.machine["loads"] if x["kind"] == "force")["constant_n"]
    assert float(found[2]) == pytest.approx(abs(force), rel=0.05)
    assert float(found[3]) == pytest.approx(STIFFNESS, rel=0.02)
    assert f"{found[1]} mm from rest" in report.sentence


@pytest.mark.slow
def test_a_cubic_about_rest_is_told_as_it_is(cubic: Analysis) -> None:
    found = cubic
    assert found.final.model.laws and aside(found) is None
    assert seen_from_rest(found) == () and "rest" not in law_words(found)


@pytest.mark.slow
def test_without_units_no_newtons_are_told(leaning: Analysis) -> None:
    data = leaning.held_run.data
    bare = replace(data, drive_channel=replace(data.drive_channel, quantity="voltage", unit="V"))
    told = seen_from_rest(replace(leaning, held_run=replace(leaning.held_run, data=bare)))[0]
    assert " N" not in told and "of half the travel from rest" in told and "times the revised machine's" in told


@pytest.mark.slow
def test_a_quadratic_spring_is_another_one_about_rest_and_stops_know_their_middle(leaning: Analysis) -> None:
    assert "About rest the spring is another" in seen_from_rest(of(leaning, "quadratic"))[0]
    assert aside(of(leaning, "stops")) is None
    assert isinstance(aside(of(leaning, "cubic")), Aside)


@pytest.mark.slow
def test_the_stiffness_beside_rest_is_not_held_against_the_baseline(leaning: Analysis) -> None:
    past = [look(driven_of(pair("none", "m", seed=3, n=3000)[0], OWN))]
    report, here = answer(OWN, leaning, seed=0, provenance={}), [look(leaning.held_run.data)]
    seen = beside_baseline(report, leaning, here, past, driven_site(OWN), 0)
    assert "stiffness" in {c.key for c in changes(here, past, driven_site(OWN), leaning.final)}
    assert not any("stiffness" in said for said in seen.undecidable)
