"""From the specification: what is derived is said, problems carry the specification's path."""

from __future__ import annotations

import pytest

from sim.core.errors import SpecError
from sim.core.spec.gears import GearSpec, MeshSpec, MeshTable
from sim.parts.gear.from_spec import gear_from_spec, pair_from_spec, user_table
from sim.parts.gear.geometry import derived_mass_kg

PINION = GearSpec(name="sun", shaft="a", teeth=23, module_m=2e-3, face_width_m=0.024, mass_kg=0.96)
WHEEL = GearSpec(name="wheel", shaft="b", teeth=81, module_m=2e-3, face_width_m=0.024, bore_radius_m=0.02)
MESH = MeshSpec(name="mesh1", pinion="sun", gear="wheel")


def test_given_and_derived_are_told_apart() -> None:
    """Bore, mass, inertia of each gear."""
    sun, wheel = gear_from_spec(PINION), gear_from_spec(WHEEL)
    assert sun.geometry.bore_radius_m == pytest.approx(6.9e-3)
    assert sun.derived["sun.bore_radius_m"].startswith("derived: 0.0069")
    assert sun.derived["sun.mass_kg"] == "given: 0.96 kg"
    assert wheel.derived["wheel.mass_kg"].startswith("derived")
    assert wheel.mass_kg == derived_mass_kg(wheel.geometry, 7850)
    # The derived inertia belongs to the mass in use.
    assert sun.inertia_kg_m2 == pytest.approx(0.5 * 0.96 * (0.023**2 + 0.0069**2))


def test_pair_with_its_distance() -> None:
    """Standard distance, contact ratio 1.71."""
    made = pair_from_spec(PINION, WHEEL, MESH)
    assert made.derived["mesh1.centre_distance_m"] == "derived (standard): 0.104 m"
    assert made.pair.contact().contact_ratio == pytest.approx(1.71, abs=0.005)
    assert made.warnings == ()


@pytest.mark.parametrize(
    ("pinion", "mesh", "field"),
    [
        (PINION.model_copy(update={"profile_shift_coefficient": 1.5}), MESH, "gears.sun.profile_shift_coefficient"),
        (PINION.model_copy(update={"bore_radius_m": 0.5}), MESH, "gears.sun.bore_radius_m"),
        (PINION.model_copy(update={"module_m": 3e-3}), MESH, "gears.wheel.module_m"),
        (PINION, MESH.model_copy(update={"centre_distance_m": 0.5}), "meshes.mesh1.centre_distance_m"),
        (PINION, MESH.model_copy(update={"centre_distance_m": 0.09}), "meshes.mesh1.centre_distance_m"),
        (PINION.model_copy(update={"teeth": 10}), MESH, "gears.wheel.teeth"),
    ],
)
def test_problems_carry_the_path(pinion: GearSpec, mesh: MeshSpec, field: str) -> None:
    """Pointed teeth, bore, module, distance, interference."""
    with pytest.raises(SpecError) as caught:
        pair_from_spec(pinion, WHEEL, mesh)
    assert field in {p.field for p in caught.value.problems}


def test_warnings_name_the_gear() -> None:
    """A pinion of 16 teeth is undercut."""
    wheel = WHEEL.model_copy(update={"teeth": 20, "bore_radius_m": None})
    made = pair_from_spec(PINION.model_copy(update={"teeth": 16}), wheel, MESH)
    assert any(w.startswith("sun: ") and "undercut" in w for w in made.warnings)


def test_user_table() -> None:
    """None without one; checked with one."""
    assert user_table(MESH) is None

    def with_rows(rows: list[list[float]], errors: list[float]) -> MeshSpec:
        table = MeshTable(centre_distance_error_m=errors, stiffness_n_per_m=rows)
        return MESH.model_copy(update={"table": table})

    table = user_table(with_rows([[1e8, 2e8]], [0.0]))
    assert table is not None
    assert table.stiffness_n_per_m.shape == (1, 2)
    with pytest.raises(SpecError, match="equal lengths"):
        user_table(with_rows([[1e8, 2e8], [1e8, 2e8, 3e8]], [0.0, 1e-4]))
    with pytest.raises(SpecError, match=r"meshes\.mesh1\.table\.centre_distance_error_m"):
        user_table(with_rows([[1e8, 2e8], [1e8, 2e8]], [1e-4, 0.0]))
