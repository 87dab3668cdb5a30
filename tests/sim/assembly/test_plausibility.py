"""Warnings about numbers that were hardly meant: each says the numbers, sound machines have none."""

from __future__ import annotations

import json
from pathlib import Path

import pytest

from sim.assembly.assemble import assemble
from sim.core.spec import BallGeometry, TermSpec
from sim.presets import names, preset
from sim.presets.reference import machine_from_reference
from tests.strategies.systems import with_terms

REFERENCE = Path(__file__).resolve().parents[3].parent / "shared" / "reference"
PAPER, ROTOR = preset("paper"), preset("rotor")


def with_part(machine, part, index=0, **update):
    items = list(getattr(machine, part))
    items[index] = items[index].model_copy(update=update)
    return machine.model_copy(update={part: items})


def at_speed(machine, speed_hz):
    return machine.model_copy(update={"operating": machine.operating.model_copy(update={"speed_hz": speed_hz})})


def geometry(ball_m, pitch_m, balls=7):
    return BallGeometry(balls=balls, ball_diameter_m=ball_m, pitch_diameter_m=pitch_m)


@pytest.mark.parametrize("name", names())
def test_presets_are_plausible(name):
    assert assemble(preset(name)).warnings == ()


@pytest.mark.slow
def test_reference_machines_are_plausible():
    files = sorted(REFERENCE.glob("*.json"))
    if not files:
        pytest.skip("no reference machines beside the project")
    for file in files:
        assert assemble(machine_from_reference(json.loads(file.read_text()))).warnings == (), file.name


@pytest.mark.parametrize(
    ("machine", "part", "said"),
    [
        # the misprint of the paper's Table 1
        (
            with_part(PAPER, "gears", 1, inertia_kg_m2=8.362e-4),
            "gear",
            ["0.0008362", "1/11.3", "0.009448", "r = 0.081"],
        ),
        (with_part(PAPER, "gears", 0, inertia_kg_m2=2e-3), "pinion", ["inertia 0.002", "7.88 times"]),
        (with_part(PAPER, "gears", 0, mass_kg=960.0, inertia_kg_m2=0.25), "pinion", ["mass 960", "0.3131 kg"]),
        (with_part(PAPER, "gears", 0, face_width_m=0.004), "pinion", ["face width 4 mm", "2 modules", "3 to 40"]),
        (with_part(PAPER, "gears", 0, face_width_m=0.1), "pinion", ["face width 100 mm", "50 modules"]),
        (at_speed(PAPER, 500.0), "pinion", ["72.26 m/s", "30000 r/min"]),
        (at_speed(PAPER, 600.0), "bearing1", ["600 Hz", "36000 r/min", "r/min given for Hz"]),
        (at_speed(ROTOR, 300.0), "bearing1", ["18000 r/min", "39.04 mm", "7.03e+05"]),
        (with_part(ROTOR, "bearings", radial_clearance_m=3e-5), "bearing1", ["2 x 30 um", "53 um", "C5"]),
        (with_part(PAPER, "bearings", geometry=geometry(0.05, 0.2)), "bearing1", ["50 mm", "pinion of 46 mm"]),
        (with_part(PAPER, "shafts", diameter_m=0.045), "input", ["45 mm", "root circle of pinion, 41 mm"]),
        (with_part(PAPER, "shafts", diameter_m=0.04, end_inertia_kg_m2=1e-5), "input", ["end inertia 1e-05", "bare"]),
        (with_part(ROTOR, "shafts", diameter_m=0.04), "bearing1", ["39.04 mm is smaller than shaft input, 40 mm"]),
        (with_part(PAPER, "loads", torque_nm=25000.0), "pinion", ["MPa", "N mm given for N m"]),
    ],
)
def test_what_is_hardly_meant(machine, part, said):
    found = [w for w in assemble(machine).warnings if w.startswith(f"{part}: ")]
    assert any(all(text in warning for text in said) for warning in found), assemble(machine).warnings


def test_a_large_module():
    gears = [
        g.model_copy(update={"module_m": 0.06, "face_width_m": 0.6, "inertia_kg_m2": None, "mass_kg": None})
        for g in PAPER.gears
    ]
    assert any("module 60 mm" in w for w in assemble(PAPER.model_copy(update={"gears": gears})).warnings)


@pytest.mark.parametrize("term", ["fit_clearance", "fit_clearance_series"])
def test_a_fit_wider_than_any_seat(term):
    machine = with_part(PAPER, "bearings", catalogue="6205", geometry=None)

    def cautions(gap):
        spec = TermSpec(term=term, site="bearing1", parameters={"gap": gap})
        return [w for w in assemble(with_terms(machine, spec)).warnings if "fit clearance" in w]

    assert cautions(1e-4) == []
    (said,) = cautions(2e-4)
    for text in ("bearing1: ", "200 um", "173 um", "H11/h11", "52 mm"):
        assert text in said


def test_a_fit_of_unknown_size_is_not_judged():
    spec = TermSpec(term="fit_clearance", site="bearing1", parameters={"gap": 4e-4})
    assert not [w for w in assemble(with_terms(PAPER, spec)).warnings if "loosest seat" in w]
