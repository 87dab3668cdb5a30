"""Views of single lines: which speaks for an effect, and in which it is judged what the effect leaves."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.machine.limits import limits
from reconcile.machine.setting import Found

FAMILIES, MESH, SIDES, TWICE, MESH_PHASES, SIDES_PHASES = (SimpleNamespace(name=n) for n in "fmstMS")
NAMES = ("a@x", "b@x", "c@x", "d@x", "e@x", "f@x")


def found(**parts: object) -> Found:
    screen = SimpleNamespace(names=NAMES, by=range(len(NAMES)))
    phases = (MESH_PHASES, SIDES_PHASES)
    given = {"fitted": FAMILIES, "fine": MESH, "sides": SIDES, "twice": TWICE, "phases": phases, **parts}
    return Found(known=None, screen=screen, **given)  # type: ignore[arg-type]


def test_views_stand_in_the_order_of_the_screen() -> None:
    assert found().views == (FAMILIES, MESH, SIDES, TWICE, MESH_PHASES, SIDES_PHASES)
    assert found(phases=()).views == (FAMILIES, MESH, SIDES, TWICE)
    assert found(twice=None, phases=()).views == (FAMILIES, MESH, SIDES), "a machine without teeth"
    assert found(fine=None, sides=None, twice=None, phases=()).views == (FAMILIES,)
    assert [found().view(name) for name in NAMES] == list(found().views)


@pytest.mark.parametrize(("name", "view"), list(zip(NAMES, (MESH, MESH, SIDES, TWICE, MESH, SIDES), strict=True)))
def test_an_effect_is_fitted_in_levels_whatever_speaks_for_it(name: str, view: object) -> None:
    assert found().lines(name) is view


def test_what_an_effect_leaves_is_judged_without_phases() -> None:
    assert found().levels_like(MESH_PHASES) is MESH  # type: ignore[arg-type]
    assert found().levels_like(SIDES_PHASES) is SIDES  # type: ignore[arg-type]
    assert found().levels_like(SIDES) is SIDES  # type: ignore[arg-type]


def setting(
    delays: tuple[object, ...] = (), channels: int = 3, points: int = 2, mirrored: tuple[int, ...] = ()
) -> SimpleNamespace:
    """`mirrored`: channels of the first point."""
    names = tuple(f"bearing{k}.y" for k in range(1, channels + 1))
    data = tuple(
        SimpleNamespace(mirrored=() if k else mirrored, point=SimpleNamespace(speed_hz=30.0 + k, torque_ratio=1.0))
        for k in range(points)
    )
    return SimpleNamespace(channels=names, data=data, changes=SimpleNamespace(with_baseline=True, delays=delays))


def test_limits_name_the_channels_whose_clocks_differ_most() -> None:
    assert limits(setting()) == ()  # type: ignore[arg-type]
    apart = (SimpleNamespace(channel=0, seconds=1e-3), SimpleNamespace(channel=2, seconds=-0.0123))
    (told,) = limits(setting(apart))  # type: ignore[arg-type]
    assert told.startswith("bearing3.y and bearing1.y are 12.3 ms further apart")
    assert len(limits(setting(channels=1, points=1))) == 2  # type: ignore[arg-type]


def test_limits_name_what_was_read_the_other_way_round() -> None:
    (told,) = limits(setting(mirrored=(1, 2)))  # type: ignore[arg-type]
    assert told.startswith("bearing2.y at 30 Hz, bearing3.y at 30 Hz: moves across the load half a turn of phase apart")
