"""Which cases are asked for: those of a split, or some by their names, which tell their split too."""

from __future__ import annotations

from proof.others import SPLITS, cases_of
from proof.plan import Case, Split


def names_in(cases: str) -> list[str]:
    """The names of a comma-separated list; none of a number, which is of the first so many."""
    return [] if cases.isdigit() else [name.strip() for name in cases.split(",") if name.strip()]


def split_for(given: Split | None, cases: str) -> Split:
    """The split that is given, or else the one that all the named cases are of; SystemExit where that is none."""
    if given is not None:
        return given
    names = names_in(cases)
    if not names:
        raise SystemExit("--split: name one, or name cases by --cases: their names tell it")
    found = {name: split_with(name) for name in names}
    unknown = sorted(name for name, split in found.items() if split is None)
    if unknown:
        raise SystemExit(f"--cases: no such case in any split: {', '.join(unknown)}")
    splits = sorted({split for split in found.values() if split is not None})
    if len(splits) > 1:
        raise SystemExit(f"--cases: these are of several splits, run one at a time: {', '.join(splits)}")
    return splits[0]


def split_with(name: str) -> Split | None:
    """The split that a case of this name is in: no two splits have one in common."""
    return next((split for split in SPLITS if any(case.name == name for case in cases_of(split))), None)


def chosen(split: Split, cases: str) -> list[Case]:
    """The cases of a split that are asked for: by name, the first so many, or all; SystemExit for other names."""
    every = list(cases_of(split))
    if cases.isdigit():
        return every[: int(cases)]
    wanted = names_in(cases)
    unknown = sorted(set(wanted) - {case.name for case in every})
    if unknown:
        raise SystemExit(f"--cases: no such case in split {split}: {', '.join(unknown)}")
    return [case for case in every if not wanted or case.name in wanted]
