"""The dataset card: what was simulated and from which ranges, what is not modelled, licence, citation, checksums."""

from __future__ import annotations

import json
from collections.abc import Iterator, Sequence

from sideband_datasets.folder.added import added, range_text
from sideband_datasets.folder.apart import apart
from sideband_datasets.folder.held import HEAD, held
from sideband_datasets.folder.layout import DATA
from sideband_datasets.folder.manifest import doubted_rows, rows_by_class, versions
from sideband_datasets.folder.shards import Receipt
from sideband_datasets.formats import FORMATS
from sideband_datasets.plan.axes import term_parameters
from sideband_datasets.plan.plan import Plan
from sideband_datasets.recipe.model import Recipe
from sideband_datasets.recipe.read import identity
from sideband_datasets.row import COLUMNS
from sim.terms import REGISTRY

NOT_MODELLED = """\
* The data are simulated. A classifier that was not tested on recordings of real machines has not been tested.
* Bearings are radial ball bearings; gears are spur or helical on parallel shafts. There are no roller bearings and no
  planetary gears.
* Growth of damage, thermal growth, and lubrication beyond damping and friction are left out. A recording shows one
  state of one fault.
* Housings are a stiffness, a damping and a mass each; what lies between housing and sensor is the transfer path of the
  measurement chain, a few modes drawn for each machine.
* Other machines nearby, process noise and changes of temperature are absent unless the measurement chain adds them.
* Errors that are random in a machine (pitch errors) belong to the machine: they are the same in all its recordings."""

BARE = """\
* The recipe has no `background`: machines sound of nothing but themselves, so that a fault raises the level (RMS) far
  more than it does on most measured machines, and a classifier may learn little else. Recipes `bearings-fast` and
  `bearings-slow` have one."""
COULD_NOT = ("could not be made", "could not be made or do not show their fault")
"""Without and with a choice of recordings."""


def _ranges(recipe: Recipe) -> Iterator[tuple[str, str]]:
    for family in recipe.machines:
        yield from ((f"{family.name}: `{key}`, a machine", range_text(value)) for key, value in family.vary.items())
    for name, value in (("speed, Hz", recipe.speeds_hz), ("torque, N m", recipe.torques_nm)):
        if value is not None:
            yield name, range_text(value)
    yield from ((f"`{key}`, a recording", range_text(value)) for key, value in recipe.conditions.items())
    for fault in recipe.faults:
        for wanted in fault.terms:
            term = REGISTRY.get(wanted.term)
            assert term is not None
            places = ", ".join(wanted.sites) or "any place where it may act"
            for name, value in term_parameters(wanted, term).items():
                unit = next(p.unit for p in term.params if p.name == name)
                told = "" if unit == "1" else f", {unit}"
                yield f"class {fault.name}: {term.title.lower()} ({places}), {name}{told}", range_text(value)
    for chain in recipe.measurement:
        yield from ((f"{chain.name}: `{key}`, a machine", range_text(value)) for key, value in chain.vary.items())
        yield from ((f"{chain.name}: `{key}`, a recording", range_text(value)) for key, value in chain.each.items())


def _front_matter(plan: Plan, kind: str, rows: int) -> str:
    size = next((f"{low}<n<{high}" for low, high, most in SIZES if rows < most), "n>1M")
    configured = [f"  - split: {split}\n    path: {DATA}/{split}-*{FORMATS[kind].suffix}" for split in plan.splits]
    configs = "configs:\n- config_name: default\n  data_files:\n" + "\n".join(configured) + "\n"
    return (
        f"---\nlicense: {json.dumps(plan.recipe.licence.lower())}\npretty_name: {json.dumps(plan.recipe.name)}\n"
        f"size_categories:\n- {size}\ntask_categories:\n- other\n"
        "tags:\n- vibration\n- condition-monitoring\n- simulated\n"
        f"{configs if kind == 'parquet' else ''}---\n"
    )


SIZES = (("0", "1K", 1000), ("1K", "10K", 10_000), ("10K", "100K", 100_000), ("100K", "1M", 1_000_000))


def _doubted(receipts: Sequence[Receipt]) -> str:
    found = ", ".join(f"{count} of {name}" for name, count in doubted_rows(receipts).items())
    told = "The simulation doubts its own numbers in some rows (column `warnings`, which is not to be trained on)"
    return f"{told}: {found}." if found else ""


def _table(head: tuple[str, ...], body: Iterator[tuple[str, ...]]) -> str:
    lines = [head, tuple("---" for _ in head), *body]
    return "\n".join("| " + " | ".join(cell.replace("|", "\\|") for cell in line) + " |" for line in lines)


def card(plan: Plan, receipts: Sequence[Receipt], kind: str) -> str:
    """The card as Markdown with front matter."""
    recipe = plan.recipe
    rows = sum(receipt.rows for receipt in receipts)
    failed = sum(len(receipt.failures) for receipt in receipts)
    counts = rows_by_class(plan, receipts)
    splits = (
        (split, str(int((plan.split_of == k).sum())), str(sum(r.rows for r in receipts if r.split == split)))
        for k, split in enumerate(plan.splits)
    )
    author = recipe.author or "the maker of this dataset"
    made = ", ".join(f"{name} {version}" for name, version in versions().items())
    what = (
        f"{rows} rows of simulated vibration in {kind}: windows of {recipe.count} recordings of {len(plan.machines)} "
        f"machines, made with Sideband. {FORMATS[kind].sentence}"
    )
    cite = (
        f"## Licence and citation\n\n{recipe.licence}. Cite as: {author}, *{recipe.name}* (simulated with Sideband, "
        f"recipe {identity(recipe)[:16]}). Made with {made}."
    )
    parts = [
        _front_matter(plan, kind, rows),
        f"# {recipe.name}\n\n{recipe.notes}".rstrip(),
        what,
        f"{failed} recordings {COULD_NOT[recipe.shown_db is not None]}; `failures.jsonl` lists them with reasons.",
        _doubted(receipts),
        "## Classes\n\n" + _table(("class", "rows"), ((name, str(count)) for name, count in counts.items())),
        f"## Splits\n\n{apart(plan, receipts)}\n\n" + _table(("split", "machines", "rows"), splits),
        "".join(f"* {told}\n" for told in plan.warnings).rstrip(),
        "## What all machines have\n\n" + _table(HEAD, held(recipe)),
        f"## What was varied\n\nSampled by a plan of kind {recipe.plan}, seed {recipe.seed}. SI units.\n\n"
        + _table(("what", "range"), _ranges(recipe)),
        added(recipe),
        "## What is not modelled\n\n" + NOT_MODELLED + (f"\n{BARE}" if recipe.background is None else ""),
        "## Columns\n\n" + _table(("column", "unit", "meaning"), ((c.name, c.unit, c.sentence) for c in COLUMNS)),
        cite,
        "## Checksums (SHA-256)\n\n" + _table(("file", "sha256"), ((f"{DATA}/{r.name}", r.sha256) for r in receipts)),
    ]
    return "\n\n".join(part for part in parts if part) + "\n"
