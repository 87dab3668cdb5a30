"""Units, exchanged channels and spoiled samples of a driven oscillator end in a verdict with kind and channel."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import numpy as np
import pytest
from scipy.signal import lsim

from reconcile.driven import reconcile_driven
from reconcile.driven.channels import driven_of
from reconcile.driven.machine import driven_site
from reconcile.driven.measured import Look, against_file, exchanged, look, remarks, scaled
from reconcile.driven.model import Model, errors, ready, share_kept
from reconcile.driven.spoiled import mended, with_bad
from reconcile.report import page, strict_json
from signals.recording import Recording
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.presets import preset
from tests.reconcile.driven.made import DAMPING, FREQUENCY, MASS, RATE, STIFFNESS, recording

SPEC = preset("oscillator")
W = 2 * np.pi * FREQUENCY
BODY = SPEC.bodies[0].model_copy(
    update={"mass_kg": MASS, "stiffness_y_n_per_m": STIFFNESS, "damping_y_ns_per_m": 2 * DAMPING * W * MASS}
)
OWN = SPEC.model_copy(update={"bodies": [BODY]})
"""The machine file of the made oscillator; SPEC is that of another one."""
FORCE, MOTION = 0, 1


def times(one: Recording, row: int, factor: float) -> Recording:
    samples = one.samples.copy()
    samples[row] *= factor
    return replace(one, samples=samples)


def with_row(one: Recording, row: int, change: Callable[[np.ndarray], None]) -> Recording:
    samples = one.samples.copy()
    change(samples[row])
    return replace(one, samples=samples)


def swapped(one: Recording) -> Recording:
    return replace(one, samples=one.samples[::-1].copy())


@pytest.mark.slow
@pytest.mark.parametrize(
    ("row", "factor", "kind", "words"),
    [
        (FORCE, 1e-3, "unit_mismatch", "kN against N"),
        (MOTION, 1e3, "unit_mismatch", "mm against m"),
        (FORCE, 9.80665, "unit_mismatch", "kgf against N"),
        (MOTION, 1 / 39.3701, "unit_mismatch", "inch against m"),
        (MOTION, 1.7, "gain_change", "no ratio of units"),
    ],
)
def test_a_channel_of_another_unit_than_the_baselines_is_known(
    linear: Recording, sound: Recording, row: int, factor: float, kind: str, words: str
) -> None:
    report = reconcile_driven(SPEC, [times(linear, row, factor)], [sound], seed=1)
    assert report.verdict == "measurement_fault"
    assert report.fault is not None
    assert (report.fault.kind, report.fault.channel) == (kind, ("force", "displacement")[row])
    assert words in report.sentence
    assert f"{factor:.4g} times too large" in report.sentence
    assert report.measurement_faults == (report.fault,)
    assert "The measurement" in page(report)
    assert strict_json(report)


@pytest.mark.slow
def test_the_machine_file_tells_a_unit_where_the_frequency_is_its_own(linear: Recording) -> None:
    clear = reconcile_driven(OWN, [times(linear, MOTION, 1e3)], seed=1)
    assert clear.fault is not None
    assert (clear.fault.kind, clear.fault.channel) == ("unit_mismatch", "displacement"), "no mass moves by a metre"
    either = reconcile_driven(OWN, [times(linear, FORCE, 1e-3)], seed=1)
    assert either.verdict == "measurement_fault"
    assert either.fault is not None
    assert (either.fault.kind, either.fault.channel) == ("unit_mismatch", "")
    assert "kN against N or mm against m" in either.sentence
    assert either.undecidable
    other = reconcile_driven(SPEC, [times(linear, FORCE, 1e-3)], seed=1)
    assert other.verdict == "nothing_missing", "another machine's file says nothing of units"
    assert "look at the units" in other.where.limits[-1]


@pytest.mark.slow
def test_force_and_motion_exchanged_are_put_right(linear: Recording, stiffening: Recording) -> None:
    for spec in (SPEC, OWN):
        report = reconcile_driven(spec, [swapped(linear)], seed=1)
        assert report.verdict == "measurement_fault"
        assert report.fault is not None
        assert (report.fault.kind, report.fault.channel) == ("swapped_channels", "force")
    with_law = reconcile_driven(SPEC, [swapped(stiffening)], seed=1)
    assert with_law.verdict == "explained"
    assert "cubic support, odd stiffness" in with_law.sentence
    assert "swapped channels on force" in with_law.sentence
    assert with_law.fault is not None


def _clipped(share: float) -> Callable[[np.ndarray], None]:
    def change(x: np.ndarray) -> None:
        most = np.quantile(np.abs(x), share)
        np.clip(x, -most, most, out=x)

    return change


def _gaps(x: np.ndarray) -> None:
    for k in range(1000, 9000, 1500):
        x[k : k + 150] = 0.0


def _no_numbers(x: np.ndarray) -> None:
    x[500:505] = np.nan
    x[3500] = np.inf


def _held(x: np.ndarray) -> None:
    x[3000:3600] = x[3000]


def _silent(x: np.ndarray) -> None:
    x[:] = 0.0


@pytest.mark.slow
@pytest.mark.parametrize("row", [FORCE, MOTION])
@pytest.mark.parametrize(
    ("change", "kind"),
    [
        (_clipped(0.9), "clipped"),
        (_gaps, "dropouts"),
        (_no_numbers, "not_finite"),
        (_held, "stuck"),
        (_silent, "silence"),
    ],
)
def test_a_spoiled_channel_of_a_linear_oscillator_is_the_answer(
    linear: Recording, row: int, change: Callable[[np.ndarray], None], kind: str
) -> None:
    report = reconcile_driven(SPEC, [with_row(linear, row, change)], seed=1)
    assert report.verdict == "measurement_fault", report.sentence
    assert report.fault is not None
    assert (report.fault.kind, report.fault.channel) == (kind, ("force", "displacement")[row])


@pytest.mark.slow
def test_a_law_is_found_beside_a_clipped_motion_and_not_beside_a_clipped_force(stiffening: Recording) -> None:
    told = reconcile_driven(SPEC, [with_row(stiffening, MOTION, _clipped(0.95))], seed=1)
    assert told.verdict == "explained"
    assert "cubic" in told.sentence
    assert [f.kind for f in told.measurement_faults] == ["clipped"]
    pushed = reconcile_driven(SPEC, [with_row(stiffening, FORCE, _clipped(0.95))], seed=1)
    assert pushed.verdict == "measurement_fault"
    assert not any(c.named for c in pushed.causes)


@pytest.mark.slow
def test_a_force_that_was_really_off_for_a_while_is_no_fault() -> None:
    """The pause is in the made force itself, so the motion dies away in it."""
    one = recording(None, seed=5, n=9000, noise=0.0)
    force = one.samples[FORCE].copy()
    force[3000:3900] = 0.0
    t = np.arange(force.size) / RATE
    motion = lsim(([1 / MASS], [1.0, 2 * DAMPING * W, W * W]), force, t)[1]
    motion += 0.005 * motion.std() * np.random.default_rng(1).normal(size=motion.size)
    report = reconcile_driven(SPEC, [replace(one, samples=np.vstack([force, motion]))], seed=1)
    assert report.measurement_faults == ()


def seen(one: Recording) -> Look:
    return look(driven_of(one, SPEC))


@pytest.mark.slow
def test_of_one_oscillator_nothing_is_said_and_of_another_a_remark(linear: Recording, sound: Recording) -> None:
    here, there = seen(linear), seen(sound)
    assert scaled(here, there) is None
    assert exchanged(here) is None
    assert against_file(here, driven_site(OWN)) is None
    assert remarks([here], driven_site(OWN)) == ()
    assert "2 kg at 40 Hz" in remarks([here], driven_site(SPEC))[0]
    heavier = replace(here, model=replace(here.model, stiffness=1.3 * here.model.stiffness, gain=1e3))
    assert scaled(heavier, there) is None, "a machine that changed has another frequency"


def test_errors_do_not_count_where_a_channel_was_away() -> None:
    made = recording(None, seed=1, n=900, noise=0.0)
    spoiled = with_row(made, MOTION, lambda x: x.__setitem__(slice(500, 560), 0.0))
    read = mended(spoiled, "test 1")
    assert [f.kind for f in read.findings] == ["dropouts"]
    data = with_bad(driven_of(read.recording, SPEC), read)
    run = ready(data, 0.2)
    error = errors(Model(stiffness=W * W, damping=2 * DAMPING * W, gain=1 / MASS), run)
    assert np.max(np.abs(error)) < 0.02 * np.std(run.compared)
    assert share_kept(run) == pytest.approx(1 - 60 / run.compared.size)
    forced = with_bad(
        driven_of(made, SPEC), mended(with_row(made, FORCE, lambda x: x.__setitem__(600, np.nan)), "test 1")
    )
    kept = ready(forced, 0.2).kept
    assert kept is not None
    assert kept.size - kept.sum() == ready(forced, 0.2).skip + 1, "what the force did is felt for the memory"


def test_a_baseline_of_other_quantities_is_refused(linear: Recording) -> None:
    moving = Channel(name="a", quantity="acceleration", unit="m/s^2", location="mass", axis="y")
    other = replace(linear, channels=(linear.channels[0], moving), label="rest.json")
    with pytest.raises(SpecError, match=r"rest\.json.*measures something else than recording"):
        reconcile_driven(SPEC, [linear], [other])
