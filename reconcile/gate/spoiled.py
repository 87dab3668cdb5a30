"""Channels that a fault of the measurement spoiled are left out where others remain."""

from __future__ import annotations

from dataclasses import replace

from reconcile.gate.findings import Gate, Kind
from reconcile.verdict import SensorFault

SPOILING: frozenset[Kind] = frozenset(
    (
        *("not_finite", "silence", "stuck", "dropouts", "repeated", "noise", "copied"),
        *("clipped", "spikes", "mains_hum", "alias", "gain_change"),
    )
)
"""What mending leaves traces of that the features see: gaps filled, lines cut out, tops cut off; of many spikes the
smaller stay. A swap is undone exactly; what looks like a loose sensor may be the machine, so that channel stays, with
its transfer undone."""


GONE: frozenset[Kind] = frozenset(("not_finite", "silence", "stuck", "dropouts", "repeated", "noise", "copied"))
"""Of these the signal was not there: what is computed from it is no machine's."""


def without_spoiled(gate: Gate, kinds: frozenset[Kind] = SPOILING) -> Gate:
    """The gate's recordings without the channels of such findings; all of them where none would be left."""
    spoiled = {f.channel for f in gate.findings if f.fault and f.kind in kinds and f.channel}
    kept = [name for name in gate.tests[0].names if name not in spoiled]
    if not spoiled or not kept:
        return gate
    return replace(
        gate,
        tests=tuple(r.select(channels=kept) for r in gate.tests),
        baselines=tuple(r.select(channels=kept) for r in gate.baselines),
    )


MOST_TOLD = 6
HEARD: frozenset[Kind] = frozenset(("loose_sensor", "gain_change"))
"""What a machine's own fault may look like on one channel."""


LOOKS = {
    "loose_sensor": "a sensor that looks loose{on}, or damage near it",
    "gain_change": "another gain{on}, or what the machine does there",
}
"""What may be meant by each kind that is `HEARD`."""


def fault_sentence(fault: SensorFault, *, heard: bool = True) -> str:
    """What is wrong with the measurement, for the answer; from its first words on what may be the machine's own where
    the channels were `heard` beside it (not where they drive the model)."""
    on = f" on {fault.channel}" if fault.channel else ""
    if heard and fault.kind in LOOKS:
        what = LOOKS[fault.kind].format(on=on)
        return f"The mismatch may be in the measurement: {what} ({fault.detail})."
    return f"The mismatch is in the measurement: {fault.kind.replace('_', ' ')}{on} ({fault.detail})."


FILLED = ("not_finite", "spikes")
REMARKS = ("speed_mismatch", "too_short", "copied", "breaks")


def doubts(gate: Gate) -> tuple[str, ...]:
    """What is wrong with the measurement, as limits of an answer that is about the machine; samples that were
    filled too, though they are no fault."""
    told = []
    heard = gate.tests[0].names if gate.tests else ()
    for found in (f for f in gate.findings if f.fault or f.kind in FILLED):
        where = " of ".join(part for part in (found.channel, found.recording) if part)
        maybe = " (or what the machine does there)" if found.kind in HEARD else ""
        gone = "; the channel was left out" if found.channel and found.channel not in heard else ""
        told.append(f"{where}: {found.kind.replace('_', ' ')}, {found.detail}{maybe}{gone}")
    more = (f"and {len(told) - MOST_TOLD} more findings of the sensor gate",) if len(told) > MOST_TOLD else ()
    return (*told[:MOST_TOLD], *more)


def remarks(gate: Gate) -> tuple[str, ...]:
    """What the gate found of speed and length, which is no fault of a sensor: limits of any answer."""
    told = [f"{f.recording}: {f.detail}" for f in gate.findings if f.kind in REMARKS and not f.fault]
    more = (f"and {len(told) - MOST_TOLD} more of the kind",) if len(told) > MOST_TOLD else ()
    return (*told[:MOST_TOLD], *more)
