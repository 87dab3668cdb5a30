"""Reference solutions of an independent code, where they lie beside the project."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import pytest

from sim.core.response import FloatArray
from sim.core.spec import MachineSpec
from sim.presets.reference import machine_from_reference

FOLDER = Path(__file__).resolve().parents[2].parent / "shared" / "reference"
ORDER = (
    ["input.theta"]
    + [f"bearing1.{x}" for x in ("inner.x", "inner.y", "outer.x", "outer.y")]
    + ["resonator1.y", "pinion.theta", "pinion.x", "pinion.y"]
    + [f"bearing2.{x}" for x in ("inner.x", "inner.y", "outer.x", "outer.y")]
    + ["resonator2.y"]
    + [f"bearing3.{x}" for x in ("inner.x", "inner.y", "outer.x", "outer.y")]
    + ["resonator3.y", "gear.theta", "gear.x", "gear.y"]
    + [f"bearing4.{x}" for x in ("inner.x", "inner.y", "outer.x", "outer.y")]
    + ["resonator4.y", "output.theta"]
)
"""DOFs in the order of the files."""


@dataclass(frozen=True, kw_only=True)
class Case:
    """A reference: machine, displacements and accelerations (samples, 28) at 30 kHz from rest."""

    machine: MachineSpec
    q: FloatArray
    a: FloatArray

    def column(self, dof: str) -> int:
        """Column of a DOF."""
        return ORDER.index(dof)


def load(name: str) -> Case:
    """Read a reference; skips the test where the files are absent."""
    if not (FOLDER / f"{name}.npz").is_file():
        pytest.skip(f"reference solution {name} is not beside the project (../shared/reference)")
    with np.load(FOLDER / f"{name}.npz") as data:
        parameters = json.loads((FOLDER / f"{name}.json").read_text())
        machine = machine_from_reference(parameters, data["mesh_table"], data["centre_distance_error"])
        return Case(machine=machine, q=data["q"], a=data["a"])
