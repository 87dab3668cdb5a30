"""Laws that are no more than a curve through a force of another form carry no name."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.channels import driven_of
from reconcile.driven.form import _outside, _told
from reconcile.driven.model import Model, ready
from reconcile.driven.nominate import free_power
from reconcile.force_law.library import (
    ABOVE,
    BELOW,
    CUBIC,
    CUBIC_DRAG,
    DRAG,
    FRICTION,
    HERTZ_ABOVE,
    ODD_SQUARE,
    QUADRATIC,
    ROOT,
    STOPS,
    Law,
)
from sim.presets import preset
from tests.reconcile.driven.linear import made

SPEC = preset("oscillator")
Z = np.linspace(-1e-3, 2e-3, 301)
V = np.linspace(-0.5, 0.5, 301)


@pytest.mark.parametrize(
    ("law", "z", "shown"),
    [
        (CUBIC, Z, True),
        (CUBIC, Z + 1.1e-3, False),
        (QUADRATIC, Z - 2.1e-3, False),
        (ROOT, Z + 1.1e-3, True),
        (replace(ABOVE, shape=1.9e-3), Z, True),
        (replace(ABOVE, shape=2.1e-3), Z, False),
        (replace(HERTZ_ABOVE, shape=-1.2e-3), Z, False),
        (replace(BELOW, shape=0.9e-3), Z, True),
        (replace(BELOW, shape=1.1e-3), Z, False),
        (replace(BELOW, shape=-1.9e-3), Z, True),
        (replace(STOPS, shape=0.9e-3), Z, True),
        (replace(STOPS, shape=1.5e-3), Z, False),
        (replace(FRICTION, shape=0.01), Z, True),
        (replace(FRICTION, shape=0.05), Z, False),
    ],
)
def test_a_law_that_the_motion_does_not_reach_is_not_shown(law: Law, z: np.ndarray, shown: bool) -> None:
    assert (not _outside(law, z, V)) == shown


def test_three_laws_of_a_kind_or_two_that_leave_more_than_noise_are_a_curve() -> None:
    three = [CUBIC, QUADRATIC, replace(STOPS, shape=5e-4)]
    assert _told("restoring", three, False, Z, V)
    assert not _told("restoring", three[:2], False, Z, V)
    assert _told("restoring", three[:2], True, Z, V)
    assert not _told("restoring", three[:1], True, Z, V)
    assert _told("damping", [DRAG, CUBIC_DRAG, replace(FRICTION, shape=0.01)], False, Z, V)


@pytest.mark.slow
def test_no_exponent_is_told_where_two_laws_share_the_force() -> None:
    data = driven_of(made(41, lambda x, _v, _t: 8e10 * x**3, n=3000, noise=0.001), SPEC)
    base = Model(stiffness=66e3, damping=21.0, gain=1 / 1.2)
    run = ready(data, 0.5)
    alone = base.with_laws((CUBIC,), (8e10 / 1.2,))
    assert free_power(base, alone, run, run) is not None
    assert free_power(base, base.with_laws((CUBIC, QUADRATIC), (8e10 / 1.2, 1.0)), run, run) is None
    assert free_power(base, base.with_laws((CUBIC, ODD_SQUARE), (8e10 / 1.2, 1.0)), run, run) is None


@pytest.mark.slow
@pytest.mark.parametrize(
    ("extra", "kind"),
    [
        (lambda x, _v, _t: 25.0 * math.tanh(x / 4e-4), "restoring"),
        (lambda _x, v, _t: 6.0 * (v / 0.05) / (1.0 + (v / 0.05) ** 2), "damping"),
    ],
)
def test_a_force_that_no_law_has_is_told_as_its_curve(extra, kind) -> None:  # type: ignore[no-untyped-def]
    report = reconcile_driven(SPEC, [made(62, extra, n=9000, noise=0.001)])
    assert report.verdict == "unknown_physics"
    assert f"A {kind} force of this form is missing at" in report.sentence
    assert "exponent" not in report.sentence
    assert not any(c.named for c in report.causes)
    assert report.force is not None and report.force.law is None and len(report.force.samples["force_n"]) > 10
    assert report.machine is not None, "the fitted laws, as a curve"
    assert report.held_out is not None and report.held_out.after < 0.02
