"""A concealed rotor small enough for the test command: two speeds, three sensors, few candidates."""

from __future__ import annotations

import json
from pathlib import Path

from proof import case as made
from proof.plan import Case, Hiding
from proof.rotors.machine import ROTORS
from reconcile.atlas.candidates import Candidate
from sim.core.spec import MachineSpec
from tests.reconcile import prebuilt

HIDDEN = Hiding(law="inner_pit", site="bearing1", value=1.6e-3, variant=0)
ROTOR = ROTORS["alike"]
CASE = Case(
    name="t101",
    index=0,
    seed=58_230_917,
    group="single",
    effects=(HIDDEN,),
    level=2,
    sensors=("bearing1.y", "bearing2.y", "bearing1.x"),
    snr_db=20.0,
    speeds_hz=ROTOR.speeds_hz[::2],
    baseline=True,
    machine="alike",
)
NOMINATED = tuple(
    Candidate(term=term, site=site)
    for term, site in (
        ("inner_spall", "bearing1"),
        ("inner_spall", "bearing2"),
        ("outer_spall", "bearing1"),
        ("unbalance", "disc"),
    )
)


def wanted() -> list[prebuilt.Wanted]:
    """The atlases of both speeds, which stand beside the tests."""
    told = MachineSpec.model_validate(json.loads(made.canonical(ROTOR.document(ROTOR.parameters))))
    folder = Path(__file__).parent / "atlas"
    return [prebuilt.wanted(told, NOMINATED, CASE.sensors, hz, folder / f"rotor-{hz:g}hz.npz") for hz in CASE.speeds_hz]
