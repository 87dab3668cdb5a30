"""Whether the rows that were made keep machines and transfer paths in one split each, and the sentence that says so."""

from __future__ import annotations

from collections.abc import Collection, Iterable, Sequence

from sideband_datasets.folder.shards import Receipt
from sideband_datasets.plan.plan import Plan
from sideband_datasets.plan.walk import Known, known_of

MOST_NAMED = 5


def in_two(pairs: Iterable[tuple[str, str]]) -> list[str]:
    """Of (split, what) those `what` that occur with more than one split, each once, sorted."""
    first: dict[str, str] = {}
    return sorted({what for split, what in pairs if first.setdefault(what, split) != split})


def apart(plan: Plan, receipts: Sequence[Receipt]) -> str:
    """What the made rows show, for the card: of machines by name and by what they are built of, of paths by channel."""
    bare: set[str] = set()
    known: dict[str, Known] = {}
    there = {name for receipt in receipts for name in receipt.machines}
    for number in range(len(plan.machines)):
        if plan.machine_id(number) in there:
            machine = plan.machines[number]
            known[machine.machine_id] = known_of(machine)
            bare |= {c["name"] for c in (machine.chain or {}).get("channels", ()) if not c.get("path")}
    made = [(receipt.split, known[name]) for receipt in receipts for name in receipt.machines]
    contents = in_two((split, machine.content) for split, machine in made)
    paths = in_two((split, path) for split, machine in made for path in machine.channel_paths.values())
    leaks = [
        *in_two((split, machine.machine_id) for split, machine in made),
        *sorted({machine.machine_id for _, machine in made if machine.content in contents}),
        *sorted(f"{m.machine_id}.{c}" for _, m in made for c, path in m.channel_paths.items() if path in paths),
        *in_two((receipt.split, path) for receipt in receipts for path in receipt.paths),
    ]
    if leaks:
        named = ", ".join(dict.fromkeys(leaks[:MOST_NAMED]))
        return (
            f"**Machines or transfer paths occur in more than one split**: {named}{' ...' * (len(leaks) > MOST_NAMED)}."
        )
    machines = [machine for _, machine in made]
    counted = (
        f"{len({m.machine_id for m in machines})} machines and {len({p for r in receipts for p in r.paths})} paths"
    )
    return (
        f"No machine and no transfer path occurs in two splits: checked on the rows made, of {counted}. Machines that "
        f"differ only in name, speed or load count as one.{_bare(plan, bare)}"
    )


def _bare(plan: Plan, found: Collection[str]) -> str:
    """A sentence on the channels `found` without a transfer path, if there are any."""
    if not plan.recipe.measurement:
        return " Signals are the machine's own outputs: the path is the machine's own."
    if not found:
        return ""
    return f" Without a transfer path in the chain, the path being the machine's own: {', '.join(sorted(found))}."
