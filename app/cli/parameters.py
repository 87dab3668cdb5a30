"""Parameter files: the flat form of the reference solutions, or `{"parameters", "bearings", "tolerance"}`."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path

from app.cli.files import read_json
from app.cli.reference_case import MeshArrays, mesh_arrays, read_arrays
from sim.core.errors import Problem, SpecError
from sim.presets.reference import ReferenceMachine, reference_machine

SECTIONS = ("parameters", "bearings", "tolerance", "name", "notes")


def read_parameters(path: Path) -> ReferenceMachine:
    """The machine of a parameter file; the mesh table comes from the npz beside it, if there is one."""
    document = read_json(path)
    beside = path.with_suffix(".npz")
    mesh = mesh_arrays(read_arrays(beside)) if beside.is_file() else None
    return machine_of(document, mesh, name=path.stem)


def machine_of(document: Mapping[str, object], mesh: MeshArrays | None, *, name: str) -> ReferenceMachine:
    """The machine of either form."""
    sections = document if "parameters" in document else {"parameters": document}
    unknown = [key for key in sections if key not in SECTIONS]
    if unknown:
        allowed = ", ".join(SECTIONS)
        raise SpecError([Problem(field=k, message="is not a known section", given=k, allowed=allowed) for k in unknown])
    parameters = sections["parameters"]
    if not isinstance(parameters, Mapping):
        raise SpecError(Problem(field="parameters", message="is not an object", allowed="names and numbers"))
    return reference_machine(
        parameters,
        table=None if mesh is None else mesh.rows,
        errors=None if mesh is None else mesh.errors,
        bearings=sections.get("bearings"),
        tolerance=sections.get("tolerance"),
        name=str(sections.get("name", name))[:80],
    )
