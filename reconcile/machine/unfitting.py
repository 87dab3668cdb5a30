"""What is said where machine file, stated speed and recordings do not belong together."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reconcile.gate.findings import Gate
from reconcile.gate.spoiled import doubts
from reconcile.machine.stages import gate_stage
from reconcile.machine.teeth_elsewhere import ALIKE, Elsewhere, teeth_of
from reconcile.machine.turned import points_text
from reconcile.observe.observation import PointData
from reconcile.verdict import NextExperiment, Report, SensorFault, Where
from sim.core.spec import MachineSpec

LISTED = 3
OTHER = "another machine makes these lines, and this one's are not heard"


def told_of(found: Elsewhere, machine: MachineSpec, *, several: bool = False) -> str:
    """Which lines show it, and what would explain it; `several`: operating points show it
    alike, so these lines follow the stated speed, as no other machine's do."""
    part = "teeth" if found.mesh else "a shaft"
    places = ", ".join(f"{k * found.hz:.4g}" for k in found.harmonics[:LISTED])
    own = f"where the file's teeth would be at {found.own * found.stated_hz:.4g} Hz" if found.mesh else "none near it"
    lines = f"lines as of {part} stand at {places} Hz (the first at {found.order:.3g} times the speed)"
    return f"at {found.stated_hz:g} Hz {lines}, {own}; {_why(found, machine, several)}"


def _why(found: Elsewhere, machine: MachineSpec, several: bool) -> str:
    speed = f"the shaft turned at {found.factor * found.stated_hz:.3g} Hz, not at {found.stated_hz:g} Hz"
    teeth = teeth_of(found, machine)
    gear = [f"{teeth[0]} has {teeth[2]} teeth, not {teeth[1]}"] if teeth else []
    gear = gear or (["the file's teeth are not this machine's"] if found.sure else [])
    ways = [*gear, *([] if found.sure else [speed])]
    ways += [] if several else [OTHER]
    return f"either {', or '.join(ways)}" if len(ways) > 1 else ways[0]


def by_label(found: Elsewhere, machine: MachineSpec) -> bool:
    """Whether no other number of teeth on the operating shaft explains the lines, and nothing confirms the speed."""
    return teeth_of(found, machine) is None and not found.sure


def told_of_all(found: Sequence[Elsewhere], machine: MachineSpec) -> str:
    """That of the first operating point, and of the others where they say another thing."""
    first, *others = found
    alike = [one for one in others if abs(one.factor / first.factor - 1.0) <= ALIKE]
    likewise = f"; likewise at {' and '.join(f'{one.stated_hz:g}' for one in alike)} Hz" if alike else ""
    apart = "".join(f"; {told_of(one, machine)}" for one in others if one not in alike)
    return f"{told_of(first, machine, several=bool(alike))}{likewise}{apart}"


def misfit_report(
    found: Sequence[Elsewhere], machine: MachineSpec, data: Sequence[PointData], gate: Gate, told: Mapping[str, object]
) -> Report:
    """The report where no point's lines stand where file and label say; `told` is its provenance."""
    detail = told_of_all(found, machine)
    alike = len(found) > 1 and all(abs(one.factor / found[0].factor - 1.0) <= ALIKE for one in found)
    label = alike and all(by_label(one, machine) for one in found)
    return Report(
        verdict="measurement_fault" if label else "not_decidable",
        sentence=f"Recordings, machine file and stated speed do not belong together: {detail}. Nothing else is "
        "looked for: all that the model predicts hangs on these lines.",
        level="machine",
        where=Where(limits=doubts(gate)),
        fault=SensorFault(kind="speed_mismatch", channel="", detail=detail) if label else None,
        undecidable=("whether anything is missing: the machine file's lines are not there",),
        next_experiment=NextExperiment(sentence=_advice(found, machine)),
        stages=(gate_stage(gate), {"name": "observe", "speeds": [points_text(d) for d in data]}),
        provenance=told,
    )


def _advice(found: Sequence[Elsewhere], machine: MachineSpec) -> str:
    if any(one.sure for one in found):
        return "Check the numbers of teeth in the machine file, and the pulses a revolution of a tacho."
    if any(teeth_of(one, machine) is not None for one in found):
        return "Check the numbers of teeth in the machine file and the stated speeds, or record with a tacho."
    return "Check the speed that the descriptions state, or record with a tacho."
