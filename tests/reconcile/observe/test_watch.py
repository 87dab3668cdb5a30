"""The watch list against closed forms of bearing kinematics."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.observe.slack import SLIP, WIDEST_HZ, slack
from reconcile.observe.watch import Watched, bases_at, watch_list
from sim.core.spec import MachineSpec
from sim.presets import preset

TEETH = (23, 81)


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


def expected(machine: MachineSpec, base: str, speed_hz: float) -> float:
    """Fixed outer ring, no contact angle: Randall & Antoni 2011, equations 1-4. `base`: `f_o3` and so on."""
    geometry = machine.bearings[int(base[-1]) - 1].geometry
    assert geometry is not None and geometry.diameter_ratio is not None
    balls, ratio = geometry.balls, geometry.diameter_ratio
    return (
        speed_hz
        * {
            "f_o": 0.5 * balls * (1 - ratio),
            "f_i": 0.5 * balls * (1 + ratio),
            "f_b": 0.5 / ratio * (1 - ratio**2),
            "f_c": 0.5 * (1 - ratio),
        }[base[:3]]
    )


@pytest.mark.parametrize("speed_hz", [11.0, 30.0])
def test_frequencies_are_the_closed_forms_at_any_speed(machine: MachineSpec, speed_hz: float) -> None:
    bases = bases_at(machine, speed_hz)
    output_hz = speed_hz * TEETH[0] / TEETH[1]
    assert bases["f_r1"] == pytest.approx(speed_hz)
    assert bases["f_r2"] == pytest.approx(output_hz)
    assert bases["f_m"] == pytest.approx(TEETH[0] * speed_hz)
    for name in ("f_o", "f_i", "f_b", "f_c"):
        assert bases[f"{name}1"] == pytest.approx(expected(machine, f"{name}1", speed_hz), rel=1e-9)
        assert bases[f"{name}3"] == pytest.approx(expected(machine, f"{name}3", output_hz), rel=1e-9)
    watched = watch_list(machine)
    found = dict(zip([w.label for w in watched.lines], watched.line_hz(bases), strict=True))
    assert found["0.5*f_r1"] == pytest.approx(0.5 * speed_hz)
    assert found["2*f_m-3*f_r2"] == pytest.approx(2 * TEETH[0] * speed_hz - 3 * output_hz)
    assert found["2*f_i1-1*f_r1"] == pytest.approx(2 * expected(machine, "f_i1", speed_hz) - speed_hz)
    assert found["4*f_b3+2*f_c3"] == pytest.approx(
        4 * expected(machine, "f_b3", output_hz) + 2 * expected(machine, "f_c3", output_hz)
    )


def test_the_list_is_the_same_at_every_speed(machine: MachineSpec) -> None:
    faster = machine.model_copy(
        update={"operating": machine.operating.model_copy(update={"speed_hz": 47.0})}  # type: ignore[union-attr]
    )
    assert [w.label for w in watch_list(machine).lines] == [w.label for w in watch_list(faster).lines]


def test_equal_bearings_of_a_shaft_are_watched_once(machine: MachineSpec) -> None:
    watched = watch_list(machine)
    rolling = {base for w in watched.lines for base in w.orders if base[:3] in ("f_o", "f_i", "f_b", "f_c")}
    assert {base[-1] for base in rolling} == {"1", "3"}
    hz = np.sort(watched.line_hz(bases_at(machine, 30.0)))
    assert np.diff(hz).min() > 1e-3 * 30.0 * 0.5
    unequal = machine.bearings[1].geometry.model_copy(update={"diameter_ratio": 0.25})  # type: ignore[union-attr]
    bearings = [
        machine.bearings[0],
        machine.bearings[1].model_copy(update={"geometry": unequal}),
        *machine.bearings[2:],
    ]
    more = watch_list(machine.model_copy(update={"bearings": bearings}))
    assert any("f_o2" in w.orders for w in more.lines)


def test_modulations_are_low_orders_of_shafts_and_bearings(machine: MachineSpec) -> None:
    watched = watch_list(machine)
    assert {w.family for w in watched.modulations} == {"shaft", "outer", "inner", "ball", "cage"}
    assert len({w.label for w in watched.modulations}) == len(watched.modulations)


def test_only_rolling_lines_get_a_window(machine: MachineSpec) -> None:
    watched = watch_list(machine)
    hz = watched.line_hz(bases_at(machine, 30.0))
    share = slack(watched.lines, hz)
    slips = watched.slips
    assert np.all(share[~slips] == 0.0)
    assert np.all(share[slips] > 0.0)
    assert np.all(share <= SLIP)
    assert np.all(share * hz <= WIDEST_HZ * (1 + 1e-12))
    low = Watched(label="1*f_o1", orders={"f_o1": 1.0}, family="outer", slips=True)
    np.testing.assert_allclose(slack([low, low], np.array([20.0, 1000.0])), [SLIP, WIDEST_HZ / 1000.0])


def test_a_machine_at_rest_has_nothing_to_watch(machine: MachineSpec) -> None:
    assert watch_list(machine.model_copy(update={"operating": None})).lines == ()


def test_lines_that_count_each_for_itself_are_the_teeths_or_else_the_shafts_and_the_passing_balls(
    machine: MachineSpec,
) -> None:
    geared, bare = watch_list(machine), watch_list(preset("rotor"))
    for watched, own, beside in (
        (geared, {"mesh"}, {"sideband"}),
        (bare, {"shaft", "outer"}, {"inner", "ball"}),
    ):
        assert {w.family for w, one in zip(watched.lines, watched.own, strict=True) if one} == own
        assert {w.family for w, one in zip(watched.lines, watched.beside, strict=True) if one} == beside
    assert not geared.beside[[i for i, w in enumerate(geared.lines) if not w.first_sideband]].any()
    twice = [w for w, one in zip(geared.lines, geared.twice, strict=True) if one]
    assert all(w.family == "sideband" and {abs(n) for b, n in w.orders.items() if b != "f_m"} == {2} for w in twice)
    assert {w.orders["f_m"] for w in twice} == {1, 2, 3} and not bare.twice.any()
    every = {w.label for w, one in zip(bare.lines, bare.own, strict=True) if one}
    assert {"1*f_r1", "6*f_r1", "1*f_o1", "8*f_o1"} <= every and "0.5*f_r1" not in every
