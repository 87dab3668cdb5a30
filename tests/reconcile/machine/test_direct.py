"""Impacts at a part's own frequency speak for the effects that strike there, and for nothing else."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics.families import Family, Ties
from reconcile.machine import direct
from reconcile.machine.direct import MODELLED, MOST, MOST_TURNS, Direct, direct_evidence, shared_lines
from reconcile.observe.observation import observe
from reconcile.observe.tooth_place import angle_window
from reconcile.observe.watch import bases_at, watch_list
from signals.recording import Operating, Recording
from sim.core.response import Channel
from sim.core.spec import MachineSpec
from sim.presets import preset
from sim.terms import REGISTRY

RATE_HZ, SPEED_HZ, SECONDS = 20480.0, 30.0, 1.4
TIME = np.arange(round(RATE_HZ * SECONDS)) / RATE_HZ
OPERATING = Operating(shaft="input", speed_hz=SPEED_HZ, torque_nm=25.0)
CHANNELS = tuple(
    Channel(name=p, quantity="acceleration", unit="m/s^2", location=p, axis="y") for p in ("bearing1", "bearing3")
)


@pytest.fixture(scope="module")
def machine() -> MachineSpec:
    return preset("paper-lightly-damped")


def sound(seed: int) -> np.ndarray:
    rng = np.random.default_rng(seed)
    mesh = sum(np.sin(2 * np.pi * 690.0 * k * TIME + k) / k for k in range(1, 6))
    return mesh + 0.2 * rng.normal(size=(2, TIME.size))


def struck(hz: float, *, loads_hz: float | None = None, slip: float = 0.0) -> np.ndarray:
    """Bursts of 3 kHz on the first channel; heavier once a turn of `loads_hz`."""
    phase = (hz * (1 + slip) * TIME) % 1.0
    after = phase / hz
    burst = np.exp(-after / 4e-4) * np.sin(2 * np.pi * 3000.0 * after)
    weight = 1.0 if loads_hz is None else 1.0 + 0.9 * np.cos(2 * np.pi * loads_hz * TIME)
    return np.array([[1.5], [0.2]]) * burst * weight


def recording(samples: np.ndarray) -> Recording:
    return Recording(
        sampling_rate_hz=RATE_HZ,
        channels=CHANNELS,
        samples=samples,
        operating=OPERATING,
    )


def found(machine: MachineSpec, now: np.ndarray, before: np.ndarray) -> Direct:
    data = observe(machine, watch_list(machine), [recording(now)], [recording(before)])
    return direct_evidence(machine, data, CHANNELS, seed=0)


@pytest.mark.slow
@pytest.mark.parametrize(("kind", "base", "loads"), [("outer", "f_o1", None), ("inner", "f_i1", 30.0)])
def test_a_struck_race_speaks_for_its_spall_at_the_bearings_that_share_the_frequency(
    machine: MachineSpec, kind: str, base: str, loads: float | None
) -> None:
    hz = bases_at(machine, SPEED_HZ)[base]
    direct = found(machine, sound(1) + struck(hz, loads_hz=loads, slip=0.007), sound(2))
    assert direct.p < 0.01
    assert any(line.startswith(f"bearing1.{kind} or bearing2.{kind}: ") for line in direct.told), direct.told
    drawn = direct.envelopes[0]
    assert (drawn.kind, drawn.sites) == (kind, ("bearing1", "bearing2")) and drawn.picture["channel"] == CHANNELS[
        0
    ].name
    assert {"test", "baseline", "lines", "band_hz"} <= set(drawn.picture), "of both recordings, with the part's lines"
    best = {name for name, value in direct.evidence.items() if value > 0.5 * max(direct.evidence.values())}
    assert best == {f"{kind}_spall@bearing1", f"{kind}_spall@bearing2"}
    assert max(direct.evidence.values()) <= MOST


@pytest.mark.slow
def test_every_pit_would_be_heard_against_a_baseline_and_one_that_was_there_already_is(machine: MachineSpec) -> None:
    hz = bases_at(machine, SPEED_HZ)["f_o1"]
    new = found(machine, sound(1) + struck(hz, slip=0.007), sound(2))
    old = found(machine, sound(1) + struck(hz, slip=0.007), sound(2) + struck(hz, slip=0.007))
    both = {"outer_spall@bearing1", "outer_spall@bearing2"}
    assert new.looked and old.looked and both <= new.present and both <= old.present
    assert not both & set(old.evidence), "no more than before"
    bare = observe(machine, watch_list(machine), [recording(sound(1))], ())
    quiet = direct_evidence(machine, bare, CHANNELS, seed=0, rise=lambda _: 0.0)
    assert not quiet.looked and not quiet.present


@pytest.mark.slow
def test_without_a_baseline_what_sound_machines_show_too_is_no_evidence(machine: MachineSpec) -> None:
    now = 0.3 * sound(1) + 3.0 * struck(bases_at(machine, SPEED_HZ)["f_i1"], loads_hz=SPEED_HZ, slip=0.007)
    data = observe(machine, watch_list(machine), [recording(now)], ())
    rises = {"bearing1.inner": MODELLED + 1.0}

    def told(least: float) -> Direct:
        return direct_evidence(machine, data, CHANNELS, seed=0, rise=lambda family: rises.get(family.key, 0.0) - least)

    assert told(0.0).p < 0.01 and "inner_spall@bearing1" in told(0.0).evidence
    usual = told(2.0)
    assert usual.p == 1.0 and not usual.evidence
    assert any("sound machines show as much" in line for line in usual.told)


@pytest.mark.slow
def test_at_one_operating_point_impacts_must_exceed_what_sound_machines_show(machine: MachineSpec) -> None:
    hit = struck(bases_at(machine, SPEED_HZ)["f_o1"], slip=0.006)
    data = observe(machine, watch_list(machine), [recording(sound(1) + hit)], [recording(sound(2))])

    def told(rise: float, points: int) -> Direct:
        return direct_evidence(machine, data * points, CHANNELS, seed=0, rise=lambda _: rise)

    assert told(MODELLED + 1.0, 1).p < 0.01
    usual = told(MODELLED - 1.0, 1)
    assert usual.p == 1.0 and not usual.evidence and any("sound machines" in line for line in usual.told)
    assert told(MODELLED - 1.0, 2).p < 0.01, "what comes back at another speed needs no model"


@pytest.mark.slow
def test_without_teeth_impacts_must_exceed_what_sound_machines_show_at_several_points_too() -> None:
    rotor = preset("rotor")
    hit = struck(bases_at(rotor, SPEED_HZ)["f_o1"], slip=0.006)
    data = observe(rotor, watch_list(rotor), [recording(sound(1) + hit)], [recording(sound(2))])

    def told(rise: float) -> Direct:
        return direct_evidence(rotor, data * 2, CHANNELS, seed=0, rise=lambda _: rise)

    assert told(4.7).p < 0.01, "the faintest pit of the concealed rotors"
    assert told(2.5).p == 1.0, "rattling bearings say so at the lines of others"


@pytest.mark.slow
def test_two_parts_that_strike_are_told_apart(machine: MachineSpec) -> None:
    hz = bases_at(machine, SPEED_HZ)
    outer, inner = struck(hz["f_o1"], slip=0.006), struck(hz["f_i3"], loads_hz=hz["f_r2"], slip=0.004)
    direct = found(machine, sound(1) + 1.2 * outer + inner[::-1], sound(2))
    parts = [set(part) for part in direct.struck]
    assert len(parts) == 2
    assert {"outer_spall@bearing1", "outer_spall@bearing2"} in parts
    assert {"inner_spall@bearing3", "inner_spall@bearing4"} in parts
    assert all(0.0 < value <= MOST for part in direct.struck for value in part.values())
    assert any("without the lines of" in line for line in direct.told)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("base", "loads", "seed"), [("f_o1", None, 0), ("f_i1", 30.0, 1), ("f_o3", None, 1), ("f_i3", 21.8, 0)]
)
def test_one_part_that_strikes_has_no_second(machine: MachineSpec, base: str, loads: float | None, seed: int) -> None:
    """Every race and every shaft once with slip and once without."""
    hit = struck(bases_at(machine, SPEED_HZ)[base], loads_hz=loads, slip=0.007 * seed)
    assert found(machine, sound(seed) + 2.0 * hit, sound(10 + seed)).struck == ()


@pytest.mark.slow
def test_a_tooth_that_strikes_speaks_for_the_teeth_of_its_gear(machine: MachineSpec) -> None:
    direct = found(machine, sound(1) + struck(SPEED_HZ), sound(2))
    teeth = {t.key for t in REGISTRY if t.strikes == "tooth"}
    assert teeth == {"tooth_crack", "tooth_spall", "missing_tooth"}
    for term in teeth:
        assert direct.evidence[f"{term}@pinion"] >= MOST_TURNS
        assert direct.evidence.get(f"{term}@gear", 0.0) < 2.0
    assert direct.places["pinion"].told and not direct.places["gear"].told
    window = angle_window(direct.places)
    assert window is not None and window.shaft == "input"


@pytest.mark.slow
def test_what_the_baseline_has_too_is_no_evidence(machine: MachineSpec) -> None:
    hz = bases_at(machine, SPEED_HZ)["f_o1"]
    direct = found(machine, sound(1) + struck(hz), sound(2) + struck(hz))
    assert max(direct.evidence.values(), default=0.0) < 2.0
    assert direct.p == 1.0


@pytest.mark.slow
def test_sound_machines_say_nothing(machine: MachineSpec) -> None:
    for seed in range(3):
        direct = found(machine, sound(10 + seed), sound(20 + seed))
        assert max(direct.evidence.values(), default=0.0) < 3.0
        assert direct.p == 1.0 and not direct.envelopes


def test_where_nothing_can_be_looked_for_the_reason_is_told(machine: MachineSpec) -> None:
    slow = [
        Recording(sampling_rate_hz=512.0, channels=CHANNELS, samples=sound(k)[:, ::40], operating=OPERATING)
        for k in (1, 2)
    ]
    data = observe(machine, watch_list(machine), slow[:1], slow[1:])
    direct = direct_evidence(machine, data, CHANNELS, seed=0)
    assert not direct.evidence and direct.p == 1.0 and "sampling rate" in direct.told[0]
    untied = machine.model_copy(update={"meshes": [], "loads": []})
    direct = direct_evidence(untied, data, CHANNELS, seed=0)
    assert not direct.evidence and "tied" in direct.told[0]


def test_what_would_strike_and_is_not_heard_beside_sure_impacts_is_unlikely() -> None:
    heard = {"outer_spall@bearing1": 17.0, "inner_spall@bearing1": 0.0, "ball_spall@bearing1": 6.0, "rub@gear": 0.0}
    told = direct.unheard({**heard, "tooth_crack@pinion": 1.0})
    assert told["outer_spall@bearing1"] == 17.0 and told["ball_spall@bearing1"] == 6.0
    assert told["inner_spall@bearing1"] == -direct.MOST
    assert told["tooth_crack@pinion"] == 1.0 and told["rub@gear"] == 0.0, "teeth are no balls"
    weak = {"outer_spall@bearing1": 7.0, "inner_spall@bearing1": 0.0}
    assert direct.unheard(weak) == weak


def test_what_is_not_heard_at_all_beside_what_is_heard_is_told() -> None:
    heard = {"outer_spall@b": direct.HEARD, "inner_spall@b": 0.0, "ball_spall@b": 1.5, "tooth_crack@g": 0.0}
    assert direct.silent_beside(heard, set()) == {"inner_spall@b"}
    assert direct.silent_beside(heard, {"inner_spall@b"}) == set(), "its lines lie within slip of others"
    assert direct.silent_beside({**heard, "outer_spall@b": direct.HEARD - 0.1}, set()) == set()


def family(kind: str, site: str, order: float) -> Family:
    return Family(kind=kind, site=site, order=order, spacing=1.0, sidebands=1, slip=0.025)  # type: ignore[arg-type]


def test_silence_says_nothing_where_slip_or_sound_machines_leave_it_open() -> None:
    families = (family("inner", "b", 5.32), family("ball", "b", 5.29), family("outer", "b", 3.7))
    tie = Ties(reference="s", shafts={"s": 1.0}, families=families, meshes=(), races={})
    heard = {"inner_spall@b": 9.0, "ball_spall@b": 3.9, "outer_spall@b": 0.0}
    spared = direct.unjudged(heard, tie, [])
    assert spared == {"ball_spall@b"}, "the balls' lines lie within slip of the inner race's"
    told = direct.unheard(heard, spared)
    assert told["ball_spall@b"] == 3.9 and told["outer_spall@b"] == -direct.MOST
    assert direct.unjudged(heard, tie, [families[2]]) == {"ball_spall@b", "outer_spall@b"}
    quiet = {**heard, "inner_spall@b": 5.0}
    assert direct.unjudged(quiet, tie, []) == set()
    assert direct.unjudged(quiet, tie, [], direct.HEARD) == {"ball_spall@b"}


@pytest.mark.parametrize(
    ("ball_order", "inner", "told"),
    [(5.29, 5.0, 9.0), (5.29, 1.0, 1.0), (4.0, 5.0, 5.0)],
)
def test_lines_that_slip_leaves_at_one_place_speak_for_both_parts(ball_order: float, inner: float, told: float) -> None:
    families = (family("inner", "b", 5.32), family("ball", "b", ball_order), family("outer", "b", 3.7))
    tie = Ties(reference="s", shafts={"s": 1.0}, families=families, meshes=(), races={})
    evidence = {"inner_spall@b": inner, "ball_spall@b": 9.0, "outer_spall@b": 0.0, "tooth_crack@g": 2.0}
    assert shared_lines(evidence, tie) == {**evidence, "inner_spall@b": told}


@pytest.mark.parametrize(("own", "turn", "told"), [(8.0, 2.0, 17.0), (5.0, 8.0, 7.8125), (0.0, 8.0, 0.0)])
def test_impacts_once_a_turn_speak_for_an_inner_race_by_no_more_than_it_modulates(
    own: float, turn: float, told: float
) -> None:
    """An unbalance that rattles strikes harder once a turn than any ball does."""
    inner = family("inner", "b", 5.32)
    turning = replace(family("turn", "s", 1.0), slip=0.0)
    tie = Ties(reference="s", shafts={"s": 1.0}, families=(inner, turning), meshes=(), races={})
    every = [SimpleNamespace(family=inner, z=own, risen=True), SimpleNamespace(family=turning, z=turn, risen=True)]
    assert direct._ball(every, tie, "inner", "b") == told  # type: ignore[arg-type]
