"""The ties read from a machine's specification hold for the frequencies the physics gives."""

import pytest

from signals.labels import kinematic_lines, merge_lines
from signals.labels.identity import base_vectors
from signals.labels.machine import machine_kinematics
from sim.assembly.kinematics import kinematics
from sim.presets import preset


@pytest.mark.parametrize("name", ["paper", "paper-demo"])
def test_every_tie_holds_numerically(name: str) -> None:
    machine = preset(name)
    bases = kinematics(machine).bases_hz
    vectors = base_vectors(machine_kinematics(machine, bases))
    assert set(vectors) == set(bases)
    # solve for each symbol from one base that is a plain multiple of it, then predict all others
    symbols: dict[str, float] = {}
    for base, vector in vectors.items():
        if len(vector) == 1:
            ((symbol, share),) = vector.items()
            symbols.setdefault(symbol, bases[base] / float(share))
    for base, vector in vectors.items():
        assert bases[base] == pytest.approx(sum(float(share) * symbols[s] for s, share in vector.items()), rel=1e-9)


def test_the_papers_bearings_and_gears_are_recognised() -> None:
    machine = preset("paper")
    bases = kinematics(machine).bases_hz
    found = machine_kinematics(machine, bases)
    assert bases["f_o1"] == pytest.approx(77.21, abs=0.01)
    assert [b.balls for b in found.bearings] == [7, 7, 7, 7]
    assert (found.meshes[0].pinion_teeth, found.meshes[0].gear_teeth) == (23, 81)
    lines = kinematic_lines(found, bases, max_frequency_hz=5000.0)
    merged = {c.label: c for c in merge_lines(lines, bases, found)}
    assert merged["3*f_o1"].components == (machine.bearings[0].name, machine.bearings[1].name)
    assert "1*f_m-1*f_r1" in merged and "22*f_r1" not in merged
