"""From a parameter file to a composed machine, with a record of everything that was not given."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

from sim.core.errors import Problem, SpecError
from sim.core.response import FloatArray
from sim.core.spec import MachineSpec, MeshTable, TermSpec
from sim.presets.gearbox import GearboxNumbers, gearbox
from sim.presets.reference.bearings import Entry, entries, merged
from sim.presets.reference.derive import (
    check_a0,
    derived_table,
    given_table,
    kinematic_values,
    mesh_damping,
)
from sim.presets.reference.names import KEYS, checked


@dataclass(frozen=True, kw_only=True)
class ReferenceMachine:
    """The machine, what was derived or assumed by name, and warnings."""

    machine: MachineSpec
    derived: Mapping[str, str]
    warnings: tuple[str, ...]
    tolerance: object = None
    """The file's stated uncertainty of its parameters, as written; the machine does not depend on it."""


def machine_from_reference(
    p: Mapping[str, object], table: FloatArray | None = None, errors: FloatArray | None = None
) -> MachineSpec:
    """Compose the machine a reference file describes."""
    return reference_machine(p, table=table, errors=errors).machine


def reference_machine(
    parameters: Mapping[str, object],
    *,
    table: FloatArray | None = None,
    errors: FloatArray | None = None,
    bearings: object = None,
    tolerance: object = None,
    name: str = "reference",
) -> ReferenceMachine:
    """Compose the machine of `parameters` (names in `KEYS`), a mesh table (rows, columns) N/m over `errors` (rows,) m
    and optional `bearings`; SpecError names what is unknown, missing or contradictory.
    """
    _check_tolerance(tolerance)
    given = checked(parameters)
    notes: dict[str, str] = {}
    warnings: list[str] = []
    values = given | kinematic_values(given, notes, warnings)
    check_a0(given)
    rolling = _rolling(given, entries(bearings), warnings)
    source = derived_table(given) if table is None or errors is None else given_table(table, errors)
    notes["mesh_table"] = source.said
    warnings += [source.warning] if source.warning else []
    values |= _defaults(given, notes)
    if "ct" not in given:
        values["ct"] = mesh_damping(values, source.table, (values["Rb_pin"], values["Rb_ge"]))
        notes["ct"] = f"derived: {values['ct']:.9g} N s/m (2 zeta_m sqrt(k m_eq), zeta_m = {values['zeta_m']:g})"
    _check_ball_stiffness(given, rolling, notes)
    notes |= (
        {"tolerance": f"kept: {tolerance} (uncertainty of the parameters; the machine is nominal)"} if tolerance else {}
    )
    machine = _compose(values, source.table, rolling, _terms(values, warnings), name)
    return ReferenceMachine(machine=machine, derived=notes, warnings=tuple(warnings), tolerance=tolerance)


def _check_tolerance(tolerance: object) -> None:
    numbers = list(tolerance.values()) if isinstance(tolerance, Mapping) else [tolerance]
    unknown = [str(name) for name in tolerance if name not in KEYS] if isinstance(tolerance, Mapping) else []
    if unknown:
        message = "is not a parameter"
        raise SpecError([Problem(field=f"tolerance.{n}", message=message, allowed=", ".join(KEYS)) for n in unknown])
    for number in numbers:
        good = (
            isinstance(number, int | float) and not isinstance(number, bool) and math.isfinite(number) and number >= 0
        )
        if number is not None and not good:
            message = "must be a share, or one share a parameter"
            raise SpecError(Problem(field="tolerance", message=message, given=str(number), allowed=">= 0"))


def _defaults(given: Mapping[str, float], notes: dict[str, str]) -> dict[str, float]:
    """Values of what may be left out; those that matter to this machine are reported."""
    found = {}
    wall = ("cN", "mu", "L2")
    quiet = {"L", *([] if given.get("delta", 0.0) > 0 else wall), *(["zeta_m"] if "ct" in given else [])}
    for key in KEYS.values():
        if key.absence == "default" and key.name not in given:
            found[key.name] = key.default
            if key.name not in quiet and (key.default != 0 or key.name in ("c0", "e0", "em", "delta")):
                notes[key.name] = (
                    f"not given: {key.default:g} {key.unit if key.unit != '1' else ''}".rstrip() + " is taken"
                )
    return found


def _rolling(
    given: Mapping[str, float], listed: tuple[Entry, ...] | None, warnings: list[str]
) -> tuple[Entry, Entry, Entry, Entry]:
    found = []
    for i in range(4):
        names = ("nb1", "g1") if i < 2 else ("nb2", "g2")
        entry = None if listed is None else listed[i]
        one, warning = merged(entry, given.get(names[0]), given.get(names[1]), names)
        found.append(one)
        if warning and warning not in warnings:
            warnings.append(warning)
    return found[0], found[1], found[2], found[3]


def _check_ball_stiffness(given: Mapping[str, float], rolling: tuple[Entry, ...], notes: dict[str, str]) -> None:
    if "kre" in given:
        return
    if not all(entry.has_diameters for entry in rolling):
        message = "is missing, and no ball diameters are given to derive it by Hertz contact"
        key = KEYS["kre"]
        raise SpecError(
            Problem(field="parameters.kre", message=message, unit=key.unit, allowed=f"{key.low:g} to {key.high:g}")
        )
    notes["kre"] = "derived: Hertz contact of ball and both races, each bearing from its diameters"


def _terms(v: Mapping[str, float], warnings: list[str]) -> tuple[TermSpec, ...]:
    """Effects of size zero are left out: they change nothing."""
    found = []
    if v["delta"] > 0:
        wall = {"gap": v["delta"], "damping": v["cN"], "friction": v["mu"], "length": v["L2"]}
        found.append(TermSpec(term="fit_clearance", site="bearing1", parameters=wall))
    single = (
        ("ecc_pinion", "eccentricity", "pinion", "radius"),
        ("ecc_gear", "eccentricity", "gear", "radius"),
        ("unbalance_pinion", "unbalance", "pinion", "moment"),
        ("unbalance_gear", "unbalance", "gear", "moment"),
        ("pitch_error_rms", "pitch_error", "pinion", "rms"),
    )
    for key, term, site, parameter in single:
        if v[key] > 0:
            found.append(TermSpec(term=term, site=site, parameters={parameter: v[key]}))
    if v["cage_slip"] > 0:
        found += [
            TermSpec(term="cage_slip", site=f"bearing{i}", parameters={"share": v["cage_slip"]}) for i in range(1, 5)
        ]
    if v["pitch_error_rms"] > 0:
        warnings.append("pitch_error_rms: the tooth deviations are drawn for the pinion, from the simulation's seed")
    return tuple(found)


def _compose(
    v: Mapping[str, float], table: MeshTable, rolling: tuple[Entry, ...], terms: tuple[TermSpec, ...], name: str
) -> MachineSpec:
    machine = gearbox(
        GearboxNumbers(
            name=name,
            input_inertia=v["If1"],
            pinion_inertia=v["Ip"],
            gear_inertia=v["Ig"],
            output_inertia=v["If2"],
            pinion_mass=v["mp_"],
            gear_mass=v["mg"],
            torsional_stiffness=v["kf"],
            torsional_damping=v["cf"],
            shaft_stiffness=v["ks"],
            shaft_damping=v["cs"],
            support_stiffness=v["kp"],
            support_damping=v["cp"],
            bore_damping=v["cN"],
            resonator_stiffness=v["kr"],
            resonator_damping=v["cr"],
            inner_mass=v["ms"],
            outer_mass=v["mo"],
            resonator_mass=v["mr"],
            ball_stiffness=v.get("kre"),
            ball_clearance=v["c0"],
            error_mean=v["e0"],
            error_amplitude=v["em"],
            error_phase=v["phi"],
            mesh_damping=v["ct"],
            mesh_damping_ratio=v["zeta_m"],
            speed_hz=v["fr1"],
            torque=v["T"],
            output_torque=v["Tout"],
            pinion_teeth=int(v["z1"]),
            gear_teeth=int(v["z2"]),
            module=v["m"],
            width=v["W"],
            pressure_angle_deg=v["al"],
            shaft_length=v["L"],
            gravity=v["gravity"],
            table=table,
            terms=terms,
        )
    )
    bearings = [b.model_copy(update=_rolling_fields(e)) for b, e in zip(machine.bearings, rolling, strict=True)]
    standard = 0.5 * v["m"] * (v["z1"] + v["z2"])
    moved = abs(v["a0"] - standard) > 1e-9 * standard
    mesh = machine.meshes[0].model_copy(update={"centre_distance_m": v["a0"] if moved else None})
    return machine.model_copy(update={"bearings": bearings, "meshes": [mesh]})


def _rolling_fields(entry: Entry) -> dict[str, object]:
    """A designation stays a designation as long as nothing of its geometry was overruled."""
    if entry.designation is not None and entry.has_diameters:
        return {"catalogue": entry.designation, "geometry": None}
    return {"geometry": entry.geometry}
