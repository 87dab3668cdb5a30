"""Flexible shafts: Timoshenko's beam in closed form, gyroscopic whirl, an overhung load, refusals."""

from __future__ import annotations

import math
from importlib.util import find_spec

import numpy as np
import pytest

from sim.assembly.assemble import assemble
from sim.assembly.flexible import flexible_shaft
from sim.assembly.modes import whirl_frequencies_hz
from sim.core.errors import SpecError
from sim.core.spec import BodySpec, ForceLoad, MachineSpec, OperatingSpec, ShaftSegment, ShaftSpec
from sim.parts.shaft import section, shaft_nodes
from sim.presets import preset
from tests.sim.assembly import whirl_by_ross


def whirl_hz(machine, spin_rad_per_s, *, held=(), springs=()):
    """Whirl frequencies of a machine's one shaft, ascending, Hz; DOFs `held`, springs (node, N/m) to ground in x, y."""
    beam = flexible_shaft(machine, machine.shafts[0], spin_rad_per_s)
    place = {name: i for i, name in enumerate(name for name in beam.masses if name not in held)}
    n = len(place)
    k, g = np.zeros((n, n)), np.zeros((n, n))
    grounded = [(((f"{node}.{axis}", 1.0),), value, 0.0) for node, value in springs for axis in "xy"]
    for named, stiffness, _ in [*beam.springs, *grounded]:
        row = np.zeros(n)
        for name, weight in named:
            if name in place:
                row[place[name]] += weight
        k += stiffness * np.outer(row, row)
    for one, other, moment in beam.gyros:
        g[place[one], place[other]] += moment
        g[place[other], place[one]] -= moment
    carried = {f"{b.name}.{axis}": b.mass_kg for b in machine.bodies for axis in "xy"}  # the machine adds these itself
    mass = np.array([beam.masses[name] + carried.get(name, 0.0) for name in place])[:, None]
    found = np.linalg.eigvals(np.block([[np.zeros((n, n)), np.eye(n)], [-k / mass, -g / mass]])).imag
    return np.sort(found[found > 1.0]) / (2 * np.pi)


def pinned_whirl_hz(length_m, diameter_m, count, spin_rad_per_s):
    """A uniform shaft of `count` elements held in x and y at both ends."""
    segment = ShaftSegment(length_m=length_m, diameter_m=diameter_m)
    shaft = ShaftSpec(name="s", segments=[segment], longest_element_m=length_m / count)
    machine = MachineSpec(name="beam", shafts=[shaft], operating=OperatingSpec(shaft="s", speed_hz=1.0))
    return whirl_hz(machine, spin_rad_per_s, held={f"s.node{i}.{axis}" for i in (1, count + 1) for axis in "xy"})


def exact_whirl_hz(length_m, diameter_m, mode, spin_rad_per_s):
    """w = W sin(kz) e^(i omega t), slope = B cos(kz) e^(i omega t) in Timoshenko's equations of a turning shaft:

    (kGA k^2 - rho A omega^2) W = kGA k B,  (E I k^2 + kGA - rho I omega^2 + 2 rho I spin omega) B = kGA k W.
    """
    s = section(ShaftSegment(length_m=length_m, diameter_m=diameter_m))
    k = mode * math.pi / length_m
    lateral = [-s.mass_kg_per_m, 0.0, s.shear_n * k**2]
    tilting = [-s.rotary_kg_m, 2 * s.rotary_kg_m * spin_rad_per_s, s.bending_nm2 * k**2 + s.shear_n]
    roots = np.roots(np.polysub(np.polymul(lateral, tilting), [(s.shear_n * k) ** 2]))
    return np.sort(np.abs(roots.real))[:2] / (2 * np.pi)


@pytest.mark.parametrize(("length", "diameter"), [(1.0, 0.05), (0.3, 0.03)])
@pytest.mark.parametrize("spin", [0.0, 3000.0])
def test_whirl_of_a_pinned_shaft_is_timoshenkos(length, diameter, spin):
    exact = np.sort(np.concatenate([exact_whirl_hz(length, diameter, n, spin) for n in (1, 2, 3)]))
    found = {count: pinned_whirl_hz(length, diameter, count, spin)[:6] for count in (8, 16, 32)}
    assert found[8][:2] == pytest.approx(exact[:2], rel=2e-4)
    assert found[8] == pytest.approx(exact, rel=1e-2)
    assert found[32] == pytest.approx(exact, rel=6e-4)
    errors = [np.abs(found[count] - exact).max() for count in (16, 32)]
    assert errors[0] / errors[1] > 3.5, "lumped masses converge with the square of the element length"
    if spin > 0.0:
        assert np.all(np.diff(exact) > 0.0) and exact[1] - exact[0] > 1.0


def disc_on_cantilever(spin_hz):
    """A disc at the end of a light shaft whose start is held in two stiff bearings (by springs of the body)."""
    machine = preset("rotor")
    shaft = ShaftSpec(
        name="input",
        segments=[ShaftSegment(length_m=0.3, diameter_m=0.03)],
        seats={"bearing1": 0.0, "bearing2": 0.2, "disc": 0.3},
        end_position_m=0.0,
    )
    bearings = [b.model_copy(update={"inner_mass_kg": 0.05}) for b in machine.bearings]
    disc = BodySpec(
        name="disc", mass_kg=5.0, shaft="input", axes="xy", inertia_kg_m2=0.0144, diametral_inertia_kg_m2=0.0072
    )
    return machine.model_copy(
        update={
            "shafts": [shaft],
            "bodies": [disc],
            "bearings": bearings,
            "operating": OperatingSpec(shaft="input", speed_hz=spin_hz),
        }
    )


def test_bearing_reactions_of_an_overhung_load_follow_the_lever():
    """Moments about either bearing: R2 = F (a + L)/L, R1 = -F a/L with the load a = 0.1 m beyond L = 0.2 m."""
    machine = disc_on_cantilever(30.0)
    loaded = machine.model_copy(
        update={"gravity_m_per_s2": 0.0, "loads": [ForceLoad(body="disc", axis="y", constant_n=-1000.0)]}
    )
    system = assemble(loaded)
    k = system.stiffness.copy()
    pairs = [
        (system.index(f"bearing{i}.inner.{a}"), system.index(f"bearing{i}.outer.{a}")) for i in (1, 2) for a in "xy"
    ]
    for i, j in pairs:  # balls as springs: reactions are statically determinate, whatever their stiffness
        k[i, i] += 1e8
        k[j, j] += 1e8
        k[i, j] -= 1e8
        k[j, i] -= 1e8
    q = np.linalg.lstsq(k, system.load, rcond=1e-14)[0]
    support = machine.bearings[0].support.stiffness_y_n_per_m
    reactions = [-support * q[system.index(f"bearing{i}.outer.y")] for i in (1, 2)]
    assert reactions == pytest.approx([-500.0, 1500.0], rel=1e-9)


def test_a_turning_overhung_disc_splits_its_whirl_and_a_still_one_does_not():
    still = whirl_frequencies_hz(assemble(disc_on_cantilever(0.1)))
    fast = whirl_frequencies_hz(assemble(disc_on_cantilever(200.0)))
    off = disc_on_cantilever(200.0)
    silent = off.model_copy(update={"shafts": [off.shafts[0].model_copy(update={"gyroscopic": False})]})
    assert fast.size == still.size
    assert whirl_frequencies_hz(assemble(silent))[:4] == pytest.approx(still[:4], rel=1e-3)
    assert fast[1] / fast[0] > 1.05 * still[1] / still[0]


def changed(**update):
    machine = disc_on_cantilever(30.0)
    return machine.model_copy(update={"shafts": [machine.shafts[0].model_copy(update=update)]})


@pytest.mark.parametrize(
    ("machine", "field"),
    [
        (changed(seats={"bearing1": 0.0, "disc": 0.3}), "shafts.input.seats.bearing2"),
        (changed(seats={"bearing1": 0.0, "bearing2": 0.2, "disc": 0.31}), "shafts.input.seats.disc"),
        (changed(seats={"bearing1": 0.0, "bearing2": 0.2, "disc": 0.3, "x": 0.1}), "shafts.input.seats.x"),
        (changed(segments=[]), "shafts.input.seats"),
        (
            changed(segments=[ShaftSegment(length_m=0.3, diameter_m=0.03, bore_m=0.03)]),
            "shafts.input.segments.0.bore_m",
        ),
    ],
)
def test_impossible_shafts_are_refused_with_the_field(machine, field):
    with pytest.raises(SpecError) as refused:
        assemble(machine)
    assert field in [p.field for p in refused.value.problems]


def test_a_shaft_on_one_bearing_can_tip_and_is_refused():
    machine = disc_on_cantilever(30.0)
    one = machine.model_copy(
        update={
            "bearings": machine.bearings[:1],
            "shafts": [machine.shafts[0].model_copy(update={"seats": {"bearing1": 0.0, "disc": 0.3}})],
        }
    )
    with pytest.raises(SpecError, match="nothing holds"):
        assemble(one)


BY_ROSS = {
    ("overhung", 0.0): [133.266, 133.266, 582.643, 582.643, 1013.349, 1013.349],
    ("overhung", 200.0): [116.55, 148.442, 478.007, 700.647, 977.914, 1089.864],
    ("stepped", 0.0): [215.132, 215.132, 793.999, 793.999, 2339.872, 2339.872],
    ("stepped", 200.0): [215.062, 215.201, 689.844, 910.409, 2336.772, 2342.969],
}
"""Hz, from `whirl_by_ross.py` with ross-rotordynamics 2.3.0."""


@pytest.mark.slow
@pytest.mark.parametrize(("name", "speed_hz"), list(BY_ROSS))
def test_whirl_of_rotors_with_discs_is_that_of_a_rotordynamics_library(name, speed_hz):
    """ross has consistent masses and six DOFs a node; 64 lumped elements here lie within 5e-4 of it."""
    rotor = whirl_by_ross.ROTORS[name]
    place, mass, diametral, polar = rotor.disc
    length = sum(s[0] for s in rotor.segments)
    shaft = ShaftSpec(
        name="s",
        segments=[ShaftSegment(length_m=a, diameter_m=b, bore_m=c) for a, b, c in rotor.segments],
        seats={"disc": place, "one": rotor.springs_at_m[0], "two": rotor.springs_at_m[1]},
        longest_element_m=length / 64,
    )
    disc = BodySpec(
        name="disc", mass_kg=mass, shaft="s", inertia_kg_m2=polar, diametral_inertia_kg_m2=diametral, axes="xy"
    )
    machine = MachineSpec(name="rotor", shafts=[shaft], bodies=[disc], operating=OperatingSpec(shaft="s", speed_hz=1.0))
    places = shaft_nodes(shaft)
    springs = [(f"s.node{places.nearest(z) + 1}", rotor.spring_n_per_m) for z in rotor.springs_at_m]
    found = whirl_hz(machine, 2 * math.pi * speed_hz, springs=springs)
    expected = whirl_by_ross.whirl_hz(rotor, speed_hz) if find_spec("ross") else BY_ROSS[name, speed_hz]
    assert found[: len(expected)] == pytest.approx(expected, rel=5e-4)
