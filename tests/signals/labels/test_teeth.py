"""Sidebands of a wheel whose teeth differ, and sums of two meshes on one shaft, in synthetic signals."""

import numpy as np
from gearbox import BASES, INPUT_HZ, KINEMATICS, PINION_TEETH, RATE, sines

from signals.labels import Kinematics, MeshKinematics, ShaftKinematics, kinematic_lines, label_peaks
from signals.labels.series import tooth_grids
from signals.spectra import amplitude_spectrum
from sim.core.lines import Line

TOP = RATE / 2


def told(mechanism: str, sides: tuple[int, ...]) -> list[Line]:
    return [
        Line(orders=(("f_m", k), ("f_r1", n)), component="pinion", mechanism=mechanism, family="mesh")
        for k in range(1, 5)
        for n in sides
    ]


CRACK, RUN_OUT = told("tooth_crack", (-3, -2, -1, 1, 2, 3)), told("eccentricity", (-1, 1))


def test_a_cracked_tooth_owns_every_multiple_of_its_shaft() -> None:
    grids = list(tooth_grids(KINEMATICS, BASES, CRACK, top_hz=TOP))
    places = np.unique(np.round(np.concatenate([g.frequency_hz for g in grids]) / INPUT_HZ).astype(int))
    # below 11 shaft orders stand the first multiples, a family of their own
    assert np.array_equal(places, np.arange(11, int(TOP / INPUT_HZ) + 1))
    assert all(g.mechanisms == ("tooth_crack",) for g in grids)


def test_run_out_varies_smoothly_and_has_the_first_sidebands_only() -> None:
    assert not list(tooth_grids(KINEMATICS, BASES, RUN_OUT, top_hz=TOP))


def test_far_sidebands_are_named_after_the_crack_and_not_without_it() -> None:
    far = {(3 * PINION_TEETH - n) * INPUT_HZ: 0.1 for n in (6, 7, 9, 10)}
    spectrum = amplitude_spectrum(sines({3 * BASES["f_m"]: 1.0, **far}, seconds=4.0, noise=1e-4))
    own = kinematic_lines(KINEMATICS, BASES, max_frequency_hz=TOP)
    found = label_peaks(spectrum, [*own, *CRACK], BASES, kinematics=KINEMATICS)
    for n in (6, 7, 9, 10):
        peak = found[f"3*f_m-{n}*f_r1"]
        assert (peak.status, peak.mechanism, peak.components) == ("present", "tooth_crack", ("pinion",))
    plain = label_peaks(spectrum, [*own, *RUN_OUT], BASES, kinematics=KINEMATICS)
    assert not [p for p in plain.peaks if p.label == "3*f_m-10*f_r1" and p.mechanism == "tooth_crack"]


def test_two_meshes_on_one_shaft_modulate_each_other() -> None:
    bases = {"f_r1": 25.0, "f_r2": 25.0 * 21 / 59, "f_r3": 25.0 * 21 / 59 * 19 / 67}
    bases |= {"f_m": 21 * 25.0, "f_m2": 19 * bases["f_r2"]}
    train = Kinematics(
        shafts=tuple(ShaftKinematics(base=f"f_r{i}", component=f"shaft{i}") for i in (1, 2, 3)),
        meshes=(
            MeshKinematics(base="f_m", pinion_shaft="f_r1", pinion_teeth=21, gear_shaft="f_r2", gear_teeth=59),
            MeshKinematics(
                base="f_m2",
                pinion_shaft="f_r2",
                pinion_teeth=19,
                gear_shaft="f_r3",
                gear_teeth=67,
                component="mesh2",
                pinion="pinion2",
                gear="gear2",
            ),
        ),
    )
    sums = {k * bases["f_m"] + n * bases["f_m2"]: 0.05 for k in (3, 4, 5) for n in (-1, 1)}
    spectrum = amplitude_spectrum(sines({5 * bases["f_m"]: 1.0, **sums}, seconds=4.0, noise=1e-4))
    lines = [
        Line(orders=((base, k),), component=mesh, mechanism="mesh_pairs", family="mesh")
        for base, mesh in (("f_m", "mesh1"), ("f_m2", "mesh2"))
        for k in range(1, 8)
    ]
    found = label_peaks(spectrum, lines, bases, kinematics=train)
    for k in (3, 4, 5):
        for sign in "+-":
            peak = found[f"{k}*f_m{sign}1*f_m2"]
            assert (peak.status, peak.mechanism) == ("present", "intermodulation")
    assert found.unexplained == 0
