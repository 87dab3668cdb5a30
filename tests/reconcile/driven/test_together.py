"""Runs of eight masses side by side are those of one after the other, but for rounding."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from reconcile.driven.channels import Driven
from reconcile.driven.model import Model, Run, errors, errors_together, ready, simulated, simulated_together
from reconcile.force_law.library import CUBIC, FREE_POWER, FRICTION, GAPPED, STOPS, Law, library
from sim.core.response import Channel

SIZE = 1e-3
LAWS = (*{law.key: law for law in library(np.linspace(-SIZE, SIZE, 9), np.ones(9))}.values(), FREE_POWER)
SHAPES = {FREE_POWER.key: 2.4, FRICTION.key: 0.02} | dict.fromkeys(GAPPED, 0.4 * SIZE)
LINEAR = Model(stiffness=9e4, damping=20.0, gain=0.8, offset=3.0, output_offset=0.1 * SIZE)
QUANTITIES = (("displacement", "m"), ("velocity", "m/s"), ("acceleration", "m/s^2"))


def stretch(order: int, *, led: float = 0.0, n: int = 600) -> Run:
    rng = np.random.default_rng(order)
    force = Channel(name="f", quantity="force", unit="N", location="mass", axis="y")
    quantity, unit = QUANTITIES[order]
    data = Driven(
        step_s=1 / 2000.0,
        drive=60.0 * rng.normal(size=n),
        answer=SIZE * rng.normal(size=n) * 300.0**order,
        drive_channel=force,
        answer_channel=replace(force, name="x", quantity=quantity, unit=unit),
        prescribed=False,
    )
    return replace(ready(data, 0.05), led=led)


def scattered(laws: tuple[Law, ...], count: int, *, flies: int = -1) -> list[Model]:
    """Models around `LINEAR`; the one at `flies` is pushed away by its laws."""
    rng, found = np.random.default_rng(count), []
    for k in range(count):
        shaped = [replace(law, shape=SHAPES.get(law.key, 0.0) * (1.0 + 0.02 * rng.normal())) for law in laws]
        share = -50.0 if k == flies else 0.2
        force = share * LINEAR.stiffness * SIZE
        sizes = [force / np.max(np.abs(law.values(np.array([-SIZE, SIZE]), np.array([0.3, 0.3])))) for law in shaped]
        linear = LINEAR.of(LINEAR.vector() * (1.0 + 0.05 * rng.normal(size=5)))
        found.append(linear.with_laws(shaped, [float(s) for s in sizes]))
    return found


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize(
    "laws", [(), *((law,) for law in LAWS), (CUBIC, STOPS)], ids=lambda x: "_".join(a.key for a in x)
)
def test_eight_masses_side_by_side_move_as_each_of_them_alone(laws: tuple[Law, ...], order: int) -> None:
    for led, count in ((0.0, 11), (0.1, 8)):
        run, models = stretch(order, led=led), scattered(laws, count)
        alone = np.stack([simulated(m, run) for m in models])
        assert np.max(np.abs(alone)) < 1e6
        np.testing.assert_allclose(simulated_together(models, run), alone, rtol=0, atol=1e-10 * np.ptp(alone))


@pytest.mark.parametrize("order", [0, 1, 2])
@pytest.mark.parametrize("key", ["cubic", "quintic", "stops", "van_der_pol"])
def test_one_that_flies_off_stays_where_it_would_alone_and_the_others_go_on(key: str, order: int) -> None:
    law = next(law for law in LAWS if law.key == key)
    run, models = stretch(order), scattered((law,), 9, flies=3)
    alone, together = np.stack([simulated(m, run) for m in models]), simulated_together(models, run)
    gone = alone >= 1e12
    assert gone[3, -1] and not np.any(np.delete(gone, 3, axis=0))
    np.testing.assert_array_equal(together >= 1e12, gone)
    rest = [k for k in range(9) if k != 3]
    np.testing.assert_allclose(together[rest], alone[rest], rtol=0, atol=1e-10 * np.ptp(alone[rest]))
    np.testing.assert_allclose(errors_together(models, run), np.stack([errors(m, run) for m in models]), rtol=1e-9)


def test_errors_count_where_no_channel_was_spoiled() -> None:
    run = stretch(0)
    kept = np.where(np.arange(run.compared.size) % 7 == 0, 0.0, 1.0)
    run, models = replace(run, kept=kept), scattered((CUBIC,), 5)
    found = errors_together(models, run)
    assert np.all(found[:, kept == 0.0] == 0.0) and np.all(np.any(found[:, kept > 0.0] != 0.0, axis=1))
    np.testing.assert_allclose(found, np.stack([errors(m, run) for m in models]), rtol=0, atol=1e-10 * np.ptp(found))
