"""Channels that a fault of the measurement spoiled are left out where others remain."""

from __future__ import annotations

from dataclasses import replace

from reconcile.gate.findings import Gate, Kind

SPOILING: frozenset[Kind] = frozenset(
    ("not_finite", "silence", "stuck", "dropouts", "clipped", "mains_hum", "alias", "gain_change")
)
"""What mending leaves traces of that the features see: gaps filled, lines cut out, tops cut off. A swap is undone
exactly; what looks like a loose sensor may be the machine, so that channel stays, with its transfer undone."""


GONE: frozenset[Kind] = frozenset(("not_finite", "silence", "stuck", "dropouts"))
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
