"""`python -m proof generate --split dev --out DIR`: make concealed cases."""

from __future__ import annotations

import argparse
from pathlib import Path

from tqdm import tqdm

from proof.case import make
from proof.plan import plan


def main() -> None:
    """Run a command."""
    parser = argparse.ArgumentParser(prog="proof", description=__doc__)
    commands = parser.add_subparsers(dest="command", required=True)
    g = commands.add_parser("generate", help="make the cases of a split")
    g.add_argument("--split", choices=("dev", "sealed"), required=True)
    g.add_argument("--out", type=Path, required=True)
    g.add_argument("--truth", type=Path, required=True)
    g.add_argument("--cases", default="")
    given = parser.parse_args()
    wanted = set(filter(None, given.cases.split(",")))
    for case in tqdm([c for c in plan(given.split) if not wanted or c.name in wanted]):
        make(case, given.out, given.truth)


if __name__ == "__main__":
    main()
