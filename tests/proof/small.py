"""Concealed cases small enough for the test command: one speed, three sensors, few candidates, fixed seeds.

All are on one hidden machine: what only depends on it and its baseline is paid for once. The effect
strikes teeth; one that strikes a race is hidden in a rotor (`test_rotor_case`), an outer race's pit and an effect of
lines alone are reconciled in `tests/reconcile/machine`, on machines of the engine's own simulator.
"""

from __future__ import annotations

from pathlib import Path

from app.cli.parameters import read_parameters
from app.cli.recordings import Given, read_recording
from proof import case as made
from proof.machine import document
from proof.plan import Case, Group, Hiding
from reconcile.atlas.candidates import Candidate
from signals.recording import Recording
from sim.core.spec import MachineSpec

SPEED_HZ = 30.0
SENSORS = ("bearing1.y", "bearing2.y", "bearing3.y")
SEED = 91_405_217
"""Neither the development's nor the sealed split's."""
NOMINATED = tuple(
    Candidate(term=term, site=site)
    for term, sites in (
        ("outer_spall", ("bearing1", "bearing2", "bearing3")),
        ("inner_spall", ("bearing1", "bearing3")),
        ("fit_clearance_series", ("bearing1",)),
        ("pedestal_looseness", ("bearing1",)),
        ("tooth_crack", ("pinion",)),
        ("missing_tooth", ("pinion",)),
        ("unbalance", ("pinion", "gear")),
        ("eccentricity", ("pinion",)),
    )
    for site in sites
)
"""What is hidden, the same at other places (bearings 1 and 2 share their frequencies, sensors decide), and others that
come at the same frequencies or change the same bearing. A pitted flank of the pinion is not among them: beside it a
broken tooth is told as a set of the two, as in the product where all effects are asked."""


def small_case(number: int, machine: int, group: Group, *hidden: Hiding, fault: str | None = None) -> Case:
    """A case at the one speed, with three sensors and a baseline, at 20 dB, on one of the hidden machines."""
    return Case(
        name=f"t{number:03d}",
        index=machine,
        seed=SEED,
        group=group,
        effects=hidden,
        level=3 if hidden else -1,
        sensors=SENSORS,
        snr_db=20.0,
        speeds_hz=(SPEED_HZ,),
        baseline=True,
        fault=fault,
    )


def hiding(law: str, site: str, value: float) -> Hiding:
    """One hidden effect in its usual form."""
    return Hiding(law=law, site=site, value=value, variant=0)


CASES = {
    "nothing": small_case(0, 1, "null"),
    "broken_tooth": small_case(3, 1, "single", hiding("broken_tooth", "pinion", 1.0)),
    "dropouts": small_case(5, 1, "sensor", fault="dropouts"),
}


def nominal_machine(folder: Path) -> MachineSpec:
    """The machine as the engine is told it, read as a user's file is."""
    path = folder / "machine.json"
    path.write_text(made.canonical(document(made.told(CASES["nothing"]))), encoding="utf-8")
    return read_parameters(path).machine


def read_case(folder: Path) -> tuple[MachineSpec, list[Recording], list[Recording]]:
    """Machine, tests and baselines of a written case."""
    machine = read_parameters(folder / "machine.json").machine
    tests, baselines = (
        [read_recording(path, Given()) for path in sorted(folder.glob(f"{kind}_*.npz"))]
        for kind in ("test", "baseline")
    )
    return machine, tests, baselines
