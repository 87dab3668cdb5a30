"""Laws told by an accelerometer; companions that chance brought along go; a motion that jumps between branches."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.driven import nominate, reconcile_driven
from reconcile.driven.analysis import analyse
from reconcile.driven.answer import answer
from reconcile.driven.channels import driven_of
from reconcile.driven.fit import Fitted, fit
from reconcile.driven.forced import Analysis, calibrate
from reconcile.driven.judge import BRANCHES, NOT_ALL, judge
from reconcile.driven.latent import latent_force
from reconcile.driven.missing import Missing
from reconcile.driven.model import LINEAR, Model, Run, ready, simulated
from reconcile.driven.motion import moved
from reconcile.driven.nominate import Nominated, free_power, trial
from reconcile.driven.settle import Case, faintest_first, renominated, sensitive, settle
from reconcile.driven.split import order_of_use, parts_of
from reconcile.force_law.library import CUBIC, DRAG, FRICTION, QUADRATIC
from sim.presets import preset
from tests.reconcile.driven.shaken import DAMPING, LAWS, MASS, STIFFNESS, pair

SPEC = preset("oscillator")
BODY = SPEC.bodies[0].model_copy(
    update={"mass_kg": MASS, "stiffness_y_n_per_m": STIFFNESS, "damping_y_ns_per_m": DAMPING}
)
OWN = SPEC.model_copy(update={"bodies": [BODY]})
TRUE = Model(stiffness=STIFFNESS / MASS, damping=DAMPING / MASS, gain=1 / MASS)


@pytest.fixture(scope="module")
def jumping() -> Analysis:
    return analyse(
        parts_of([driven_of(r, OWN) for r in pair("hard", "m", seed=0, n=9000, noise=0.01, force_noise=0.002)]), 0
    )


@pytest.mark.slow
@pytest.mark.parametrize(
    ("key", "unit", "n"),
    [("cubic", "m/s^2", 5500), ("drag", "m/s^2", 3600), ("dry_friction", "g", 3600), ("stops", "g", 7000)],
)
def test_an_accelerometer_tells_the_law(key: str, unit: str, n: int) -> None:
    """What stiffens is the more sensitive, and takes the longer records."""
    report = reconcile_driven(OWN, pair(key, unit, seed=1 + len(unit), n=n), seed=0)
    first, size = report.causes[0], LAWS[key][0]
    assert report.verdict == "explained", (report.sentence, report.undecidable)
    assert [c.severity.name for c in report.causes if c.named and c.severity] == [key]
    assert first.severity is not None and first.severity.low < size < first.severity.high
    assert first.severity.high - first.severity.low < 0.1 * size
    assert report.held_out is not None and report.held_out.after < 0.02
    power = next((s["exponent_by_free_run"] for s in report.stages if "exponent_by_free_run" in s), None)
    assert (power is not None) == (key == "cubic")
    assert power is None or abs(power[0] - 3.0) < 0.1  # type: ignore[index]


@pytest.mark.slow
def test_a_spring_that_is_no_listed_law_gets_no_name() -> None:
    """Like a sine: a square spring and stops bring the error from 46 % to 18 %, and were called the law."""
    report = reconcile_driven(OWN, pair("sine", "m/s^2", seed=5), seed=1)
    assert report.verdict in ("unknown_physics", "ambiguous"), report.sentence
    assert not any(c.named for c in report.causes)


@pytest.mark.slow
def test_an_accelerometer_on_a_linear_mass_tells_no_law() -> None:
    report = reconcile_driven(OWN, pair("none", "m/s^2", seed=0), seed=0)
    assert report.verdict == "nothing_missing" and not report.causes


@pytest.mark.slow
def test_no_constant_force_is_told_by_an_acceleration() -> None:
    """Left free it put the motion 15 mm aside, of 2 mm, and no law was found there."""
    part = parts_of([driven_of(r, OWN) for r in pair("cubic", "m/s^2", seed=1, n=4000)])[0]
    found = calibrate(part)
    assert found.linear.model.offset == 0.0
    x, _ = moved(found.linear.model, found.run)
    assert abs(x.mean()) < 0.2 * x.std()
    shifted = replace(found.run, data=replace(found.run.data, answer=found.run.data.answer + 5.0))
    assert fit(found.linear.model, shifted).model.output_offset == pytest.approx(5.0, abs=0.2)


@pytest.mark.slow
def test_a_bias_of_the_sensor_is_not_divided_by_a_response_of_nothing() -> None:
    """At 0 Hz an acceleration answers to no force: the estimate overflowed there."""
    part = parts_of([driven_of(r, OWN) for r in pair("cubic", "m/s^2", seed=1, n=4000)])[0]
    found = calibrate(part)
    estimate = latent_force(found.linear.model, found.run, found.linear.error + 50.0)
    assert np.all(np.isfinite(estimate.force_n))


@pytest.mark.slow
@pytest.mark.parametrize("order", [0, 1, 2])
def test_the_motion_is_that_of_the_mass_whatever_was_measured(order: int) -> None:
    data = driven_of(pair("none", "m", seed=2, n=3000)[0], OWN)
    model = TRUE.with_laws((CUBIC,), (3e9 / MASS,))
    run = ready(data, 0.2)
    x = simulated(model, run)
    quantity, unit = [("displacement", "m"), ("velocity", "m/s"), ("acceleration", "m/s^2")][order]
    other = replace(data, answer_channel=replace(data.answer_channel, quantity=quantity, unit=unit))
    of_it = replace(run, data=other)
    answered = replace(of_it, data=replace(other, answer=simulated(model, replace(of_it, skip=0))))
    found, rate = moved(model, answered)
    middle = slice(run.skip, -100)
    assert np.std((found - x)[middle]) < 0.05 * np.std(x[middle])
    assert rate.shape == x.shape


@pytest.mark.slow
def test_a_law_that_chance_brought_along_goes_and_the_right_one_stays() -> None:
    parts = parts_of([driven_of(r, OWN) for r in pair("dry_friction", "m/s^2", seed=3)])
    fit_part, held_part = order_of_use(parts)
    start = calibrate(fit_part)
    case = Case(
        parts=parts, start=start, held=ready(held_part.data, start.linear.model.memory_s),
        names=(fit_part.name, held_part.name), seed=0,
    )  # fmt: skip
    both = (replace(FRICTION, shape=1e-3), DRAG)
    chosen = trial(start.linear.model, both, start.run, start.other)
    found = settle(case, chosen.fitted.model)
    assert [law.key for law in found.dropped] == ["drag"]
    assert [law.key for law in found.final.model.laws] == ["dry_friction"]
    _, low, high = found.final.interval(LINEAR, per_gain=True)
    assert low < 3.0 < high and high - low < 0.2
    single = trial(start.linear.model, (DRAG,), start.run, start.other)
    none = trial(start.linear.model, (), start.run, start.other)
    again = renominated(Nominated(linear=none, singles=(single,), chosen=chosen), found, case)
    assert [t.laws[0].key for t in again.singles] == ["dry_friction", "drag"]
    assert again.chosen is again.singles[0]


def test_thefaintest_first_of_several_goes_first_and_a_lone_law_stays() -> None:
    def fitted(laws: tuple, sizes: tuple, errors: tuple) -> Fitted:  # type: ignore[type-arg]
        covariance = np.diag([0.0] * LINEAR + [e * e for e in errors])
        return Fitted(model=TRUE.with_laws(laws, sizes), covariance=covariance, error=np.zeros(4))

    assert faintest_first(fitted((CUBIC, DRAG, QUADRATIC), (1.0, 1.0, 1.0), (0.1, 5.0, 2.0))) == [1, 2, 0]
    assert faintest_first(fitted((CUBIC,), (1.0,), (9.0,))) == []


@pytest.mark.slow
def test_a_motion_that_jumps_between_branches_is_explained_and_not_predicted_freely(jumping: Analysis) -> None:
    noise = Missing(statistic=0.002, null_95=0.004, p_value=0.5)
    report = answer(OWN, replace(jumping, left=noise), seed=0, provenance={})
    assert any(v.led for v in jumping.validations), [v.after for v in jumping.validations]
    assert report.verdict == "explained", report.undecidable
    assert report.causes[0].named and report.causes[0].severity is not None
    assert report.causes[0].severity.low < LAWS["hard"][0] < report.causes[0].severity.high
    assert any(text.startswith("Not predictable freely here") for text in report.where.limits)


@pytest.mark.slow
def test_a_jumping_motion_whose_rest_is_not_noise_is_not_decided(jumping: Analysis) -> None:
    rest = Missing(statistic=0.05, null_95=0.01, p_value=0.0025)
    found = replace(jumping, left=rest)
    judgement = judge(found)
    assert judgement.verdict == "not_decidable" and judgement.reasons == (BRANCHES, NOT_ALL)
    report = answer(OWN, found, seed=0, provenance={})
    assert report.machine is None and not any(c.named for c in report.causes)
    assert "leaves for another branch" in report.sentence and report.next_experiment is not None
    free = tuple(replace(v, led=False) for v in jumping.validations)
    assert judge(replace(found, validations=free)).verdict == "explained"
    assert judge(replace(found, validations=free, dropped=(DRAG,))).verdict == "unknown_physics"
    rough = tuple(replace(v, after=0.12) for v in free)
    assert judge(replace(found, validations=rough)).reasons == (NOT_ALL,)
    noise = replace(rest, p_value=0.5)
    assert judge(replace(found, validations=rough, left=noise)).verdict == "explained"


@pytest.mark.slow
def test_a_run_that_settles_is_not_sensitive(jumping: Analysis) -> None:
    data = driven_of(pair("none", "m", seed=2, n=3000)[0], OWN)
    run = ready(data, 0.5)
    wrong = replace(TRUE, damping=1.5 * TRUE.damping)
    tight = np.diag([(1e-4 * x) ** 2 for x in wrong.vector()])
    assert not sensitive(Fitted(model=wrong, covariance=tight, error=np.zeros(4)), run)
    assert sensitive(jumping.final, jumping.held_run)


@pytest.mark.slow
def test_why_no_law_is_named_is_said(jumping: Analysis) -> None:
    noise = Missing(statistic=0.002, null_95=0.004, p_value=0.5)
    bad = replace(jumping.validations[0], gain=(0.1, 0.0, 0.2))
    found = replace(jumping, left=noise, validations=(bad, *jumping.validations[1:]))
    report = answer(OWN, found, seed=0, provenance={})
    assert report.verdict == "unknown_physics"
    assert any("No law is named" in said and "gain not above" in said for said in report.undecidable)


@pytest.mark.slow
def test_an_exponent_is_no_surer_than_two_stretches_agree_on(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(nominate, "WIDEST_POWER", np.inf)

    def run_of(key: str) -> tuple[Model, Run]:
        found = calibrate(parts_of([driven_of(r, OWN) for r in pair(key, "m", seed=1, n=4000)])[0])
        return found.linear.model, found.run

    linear, run = run_of("cubic")
    final = fit(linear.with_laws((CUBIC,), (0.0,)), run).model
    alike, other = (free_power(linear, final, run, o) for o in (run, run_of("stops")[1]))
    assert alike is not None and other is not None
    assert alike.value == other.value and alike.low < 3.0 < alike.high
    assert other.high - other.low > 1.2 * (alike.high - alike.low)


@pytest.mark.slow
@pytest.mark.parametrize(("error", "told"), [(0.2, True), (5.0, False)])
def test_an_exponent_that_may_be_anything_is_not_told(
    monkeypatch: pytest.MonkeyPatch, error: float, told: bool
) -> None:
    found = calibrate(parts_of([driven_of(r, OWN) for r in pair("cubic", "m", seed=1, n=2000)])[0])
    final = fit(found.linear.model.with_laws((CUBIC,), (0.0,)), found.run).model
    monkeypatch.setattr(nominate, "_lowest", lambda *_: (3.01, error))
    assert (free_power(found.linear.model, final, found.run, found.other) is not None) == told
