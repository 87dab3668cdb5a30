"""What the paper leaves unstated, changed one at a time."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

from sim.core.spec import LoadSpec, MachineSpec, TermSpec, TorqueLoad


@dataclass(frozen=True, kw_only=True)
class Change:
    """One changed parameter and the words for it."""

    label: str
    apply: Callable[[MachineSpec], MachineSpec]


def _mesh(label: str, **update: float | bool | str) -> Change:
    def apply(spec: MachineSpec) -> MachineSpec:
        return spec.model_copy(update={"meshes": [m.model_copy(update=update) for m in spec.meshes]})

    return Change(label=label, apply=apply)


def _error(label: str, **update: float) -> Change:
    def apply(spec: MachineSpec) -> MachineSpec:
        meshes = [
            m.model_copy(update={"transmission_error": m.transmission_error.model_copy(update=update)})
            for m in spec.meshes
        ]
        return spec.model_copy(update={"meshes": meshes})

    return Change(label=label, apply=apply)


def _bearing(label: str, **update: float) -> Change:
    def apply(spec: MachineSpec) -> MachineSpec:
        return spec.model_copy(update={"bearings": [b.model_copy(update=update) for b in spec.bearings]})

    return Change(label=label, apply=apply)


def _masses(label: str, factor: float) -> Change:
    def apply(spec: MachineSpec) -> MachineSpec:
        bearings = [
            b.model_copy(update={"inner_mass_kg": b.inner_mass_kg * factor, "outer_mass_kg": b.outer_mass_kg * factor})
            for b in spec.bearings
        ]
        resonators = [r.model_copy(update={"mass_kg": r.mass_kg * factor}) for r in spec.resonators]
        return spec.model_copy(update={"bearings": bearings, "resonators": resonators})

    return Change(label=label, apply=apply)


def _damping(label: str, value: float) -> Change:
    """Damping of shaft, support and resonator connections alike."""

    def apply(spec: MachineSpec) -> MachineSpec:
        bearings = [
            b.model_copy(
                update={
                    "shaft_damping_ns_per_m": value,
                    "support": b.support.model_copy(update={"damping_x_ns_per_m": value, "damping_y_ns_per_m": value}),
                }
            )
            for b in spec.bearings
        ]
        resonators = [r.model_copy(update={"damping_ns_per_m": value}) for r in spec.resonators]
        return spec.model_copy(update={"bearings": bearings, "resonators": resonators})

    return Change(label=label, apply=apply)


def _clearance(label: str, **update: float) -> Change:
    def changed(term: TermSpec) -> TermSpec:
        if not term.term.startswith("fit_clearance"):
            return term
        return term.model_copy(update={"parameters": {**term.parameters, **update}})

    def apply(spec: MachineSpec) -> MachineSpec:
        return spec.model_copy(update={"terms": [changed(t) for t in spec.terms]})

    return Change(label=label, apply=apply)


def _runout(label: str, radius_m: float) -> Change:
    def apply(spec: MachineSpec) -> MachineSpec:
        kept = [t for t in spec.terms if t.term != "eccentricity"]
        new = [TermSpec(term="eccentricity", site="pinion", parameters={"radius": radius_m})] if radius_m > 0 else []
        return spec.model_copy(update={"terms": kept + new})

    return Change(label=label, apply=apply)


def _torque(label: str, torque_nm: float) -> Change:
    def changed(load: LoadSpec) -> LoadSpec:
        return load.model_copy(update={"torque_nm": torque_nm}) if isinstance(load, TorqueLoad) else load

    def apply(spec: MachineSpec) -> MachineSpec:
        return spec.model_copy(update={"loads": [changed(x) for x in spec.loads]})

    return Change(label=label, apply=apply)


def _gravity(label: str) -> Change:
    return Change(label=label, apply=lambda spec: spec.model_copy(update={"gravity_m_per_s2": 9.80665}))


CHANGES: Mapping[str, Change] = {
    "masses/4": _masses("ring and resonator masses / 4", 0.25),
    "masses*4": _masses("ring and resonator masses x 4", 4.0),
    "balls 1e9": _bearing("ball stiffness 1e9 N/m^1.5", contact_stiffness_n_per_m15=1e9),
    "balls 1e10": _bearing("ball stiffness 1e10 N/m^1.5", contact_stiffness_n_per_m15=1e10),
    "c_o 0": _bearing("internal clearance 0", radial_clearance_m=0.0),
    "c_o 10": _bearing("internal clearance 10 um", radial_clearance_m=1e-5),
    "damping 1.8e5": _damping("structural damping 1.8e5 N s/m", 1.8e5),
    "damping 1.8e4": _damping("structural damping 1.8e4 N s/m", 1.8e4),
    "damping 1.8e3": _damping("structural damping 1.8e3 N s/m", 1.8e3),
    "damping 450": _damping("structural damping 450 N s/m", 450.0),
    "runout 0": _runout("no run-out", 0.0),
    "runout 50": _runout("run-out radius 50 um", 5e-5),
    "te 0": _error("transmission error amplitude 0", amplitude_m=0.0),
    "te 5": _error("transmission error amplitude 5 um", amplitude_m=5e-6),
    "te 40": _error("transmission error amplitude 40 um", amplitude_m=4e-5),
    "phase 90": _error("transmission error phase 90 deg", phase_rad=1.5707963),
    "phase 180": _error("transmission error phase 180 deg", phase_rad=3.1415927),
    "phase 270": _error("transmission error phase 270 deg", phase_rad=4.7123890),
    "c_t 0.15": _mesh("mesh damping ratio 0.15", damping_ratio=0.15),
    "tilt": _mesh("offset angle acts on the stiffness", offset_angle=True),
    "own shaft": _mesh("centre distance from the pinion's shaft alone", follow_gear_shaft=False),
    "rotated": _mesh("mesh force turned into x and y", line_of_action="rotated"),
    "c_N 2e5": _clearance("collision damping 2e5 N s/m", damping=2e5),
    "c_N 2e2": _clearance("collision damping 200 N s/m", damping=2e2),
    "mu 0": _clearance("no friction at the wall", friction=0.0),
    "torque 5": _torque("torque 5 N m", 5.0),
    "gravity": _gravity("weight acts"),
}
