"""Without a baseline a family's modulation is measured against that of simulated sound machines."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics.families import Family
from reconcile.machine import alone
from reconcile.machine.alone import rise_over_sound
from reconcile.observe.features import Layout
from reconcile.observe.watch import bases_at, watch_list
from sim.presets import preset

SPEED_HZ, POINTS, CHANNELS = 30.0, 3, 2


def rise(monkeypatch: pytest.MonkeyPatch, base: str, heights: list[float]) -> tuple[float, float, float]:
    """What the outer races of the input and the output shaft and an order of nobody show, where the lines of `base`
    are modulated by so many deviations in one band of one channel at each point."""
    machine = preset("paper-lightly-damped")
    watched = watch_list(machine)
    layout = Layout(
        lines=len(watched.lines), bands=4, shapes=3, modulations=len(watched.modulations), shafts=len(watched.gears)
    )
    monkeypatch.setattr(alone, "layout_of", lambda _: layout)
    observed = np.zeros((POINTS, CHANNELS, layout.size))
    deep = observed[..., layout.slices()["depth"]].reshape(POINTS, CHANNELS, layout.shapes, layout.modulations)
    for k, line in enumerate(watched.modulations):
        if dict(line.orders) == {base: 1}:
            deep[:, 1, 2, k] = heights
    observed[..., layout.slices()["depth"]] = deep.reshape(POINTS, CHANNELS, -1)
    rng = np.random.default_rng(1)
    flat = observed.size
    made = SimpleNamespace(
        observed=2.0 * observed.ravel(), measured=np.full(flat, np.sqrt(2.0)), null=rng.normal(0, 1, (4000, flat))
    )
    data = (
        SimpleNamespace(point=SimpleNamespace(speed_hz=SPEED_HZ), test=SimpleNamespace(line=np.zeros((CHANNELS, 9)))),
    ) * 3
    found = rise_over_sound(made, data, SimpleNamespace(machine=machine))  # type: ignore[arg-type]
    bases = bases_at(machine, SPEED_HZ)

    def family(order: float) -> float:
        return found(Family(kind="outer", site="x", order=order, spacing=0.0, sidebands=0, slip=0.02))

    return family(bases["f_o1"] / SPEED_HZ), family(bases["f_o3"] / SPEED_HZ), family(3.333)


@pytest.mark.slow
def test_the_middle_of_the_points_counts_and_only_the_familys_own_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    own, other, unknown = rise(monkeypatch, "f_o1", [0.0, 7.0, 20.0])
    assert own == pytest.approx(7.0, rel=0.05)
    assert other == 0.0 and unknown == float("inf")


@pytest.mark.slow
def test_one_point_of_three_is_not_enough(monkeypatch: pytest.MonkeyPatch) -> None:
    assert rise(monkeypatch, "f_o3", [0.0, 0.0, 30.0])[1] == 0.0
