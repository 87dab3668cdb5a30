"""Contact ratio and stiffness of a gear mesh by the potential-energy method, and what its least known inputs change.

Example: sideband mesh --preset paper --json
"""

from __future__ import annotations

import argparse

import numpy as np

from app.cli.choice import add_machine_options, chosen_machine
from app.cli.files import json_text
from sim.assembly.references import check_references
from sim.core.errors import Problem, SpecError, UnknownName
from sim.core.spec import MachineSpec, MeshSpec
from sim.parts.gear import mesh_summary
from sim.parts.gear.from_spec import pair_from_spec, user_table

DEFAULT_PRESET = "paper"
TABLE_PHASES = 4000
"""Phases at which a given table is averaged: well beyond the columns tables have."""
EXPLANATIONS = {
    "bore_0.5r_over_0.3r": "mean stiffness with a bore of 0.5 of the pitch radius over that with 0.3",
    "true_root_over_clamped_at_base": "mean stiffness with the tooth clamped on its root circle over that clamped on "
    "the base circle",
}
UNITS = {"centre_distance_m": "m", "working_angle_rad": "rad", "d_mean_d_centre_distance": "N/m per m"}


def configure(parser: argparse.ArgumentParser) -> None:
    """Declare the arguments."""
    add_machine_options(parser, default=DEFAULT_PRESET)
    parser.add_argument("--mesh", metavar="NAME", help="which mesh (default: the first)")
    parser.add_argument("--json", action="store_true", help="print JSON")


def run(arguments: argparse.Namespace) -> int:
    """Run the command."""
    machine = chosen_machine(arguments)
    document = mesh_document(machine, arguments.mesh)
    print(json_text(document), end="") if arguments.json else print(_text(document))
    return 0


def mesh_document(machine: MachineSpec, name: str | None) -> dict[str, object]:
    """Summary of a mesh of the machine, its gears' geometry taken from the specification."""
    check_references(machine)
    mesh = _mesh(machine, name)
    gears = {g.name: g for g in machine.gears}
    found = pair_from_spec(gears[mesh.pinion], gears[mesh.gear], mesh, mesh.root_model)
    document: dict[str, object] = {"machine": machine.name, "mesh": mesh.name, **mesh_summary(found.pair)}
    document["derived"] = dict(found.derived)
    document["warnings"] = list(found.warnings)
    document["explanations"] = EXPLANATIONS
    table = user_table(mesh)
    if table is not None:
        mean = float(table.total_n_per_m(np.arange(TABLE_PHASES) / TABLE_PHASES).mean())
        document["table_mean_n_per_m"] = mean
        document["notes"] = ["this machine runs on a table of its own; the other figures are calculated from its gears"]
    return document


def _mesh(machine: MachineSpec, name: str | None) -> MeshSpec:
    if not machine.meshes:
        raise SpecError(Problem(field="meshes", message=f"{machine.name} has no mesh"))
    for mesh in machine.meshes:
        if name is None or mesh.name == name:
            return mesh
    raise UnknownName("mesh", str(name), [m.name for m in machine.meshes])


def _text(document: dict[str, object]) -> str:
    lines = [f"{document['machine']}, {document['mesh']}:"]
    for key, value in document.items():
        if isinstance(value, int | float):
            unit = UNITS.get(key, "N/m" if key.endswith("n_per_m") else "")
            text = EXPLANATIONS.get(key, "")
            lines.append(f"  {key:<32} {value:.6g} {unit}{f'  ({text})' if text else ''}".rstrip())
    lines += [f"  root model: {document['root_model']}"]
    for key in ("notes", "warnings"):
        found = document.get(key)
        lines += [f"  {key.removesuffix('s')}: {item}" for item in found] if isinstance(found, list) else []
    return "\n".join(lines)
