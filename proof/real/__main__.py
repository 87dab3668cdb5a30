"""`python -m proof.real`: the engine on real recordings with the label withheld, as tables of report against truth.

The engine is called by its command line on copies whose names tell nothing, with what a drawing says of the machine:
bearing sizes and teeth, no model; for the systems whose input was measured, a mass on a spring. Choices in the engine
were tuned on the rig `hit_sm_mfs`; what was changed after the other rigs had been seen once is listed on the page.
"""

from __future__ import annotations

import argparse
import sys
from collections.abc import Mapping
from pathlib import Path
from typing import Any

from proof.real import driven, page, tables
from proof.real.call import Answer, Source, reconciled
from proof.real.describe import index
from proof.real.rigs import KNOWN, PAIRS, stem
from proof.run import Engine

ROOT = Path(__file__).resolve().parents[2]
RECORDINGS = ROOT.parent / "shared" / "recordings"
TIMEOUT_S = 300.0
"""Of one comparison; the slowest takes a fifteenth of it."""


def main(argv: list[str] | None = None) -> int:
    """Run all comparisons and print the tables; 0 also where the recordings are absent, with the reason."""
    parser = argparse.ArgumentParser(prog="proof.real", description=__doc__)
    parser.add_argument("--docs", type=Path, default=None, help="also write the tables to this page")
    given = parser.parse_args(argv)
    if not (RECORDINGS / "index.json").is_file():
        sys.stdout.write(f"skipped: there are no recordings at {RECORDINGS}\n")
        return 0
    entries = {stem(e): e for e in index(RECORDINGS)["recordings"]}
    engine = Engine(timeout_s=TIMEOUT_S)
    rows = [_row(engine, entries[before], entries[after]) for before, after in PAIRS]
    systems = [(s, _told(s.name, driven.answered(engine, RECORDINGS, entries, s))) for s in driven.SYSTEMS]
    text = page.page(rows, systems, TIMEOUT_S)
    sys.stdout.write(text)
    if given.docs is not None:
        given.docs.write_text(text, encoding="utf-8")
    return 0


def _row(engine: Engine, baseline: Mapping[str, Any], test: Mapping[str, Any]) -> tables.Row:
    machine = KNOWN[test["dataset"]].document()
    answer = reconciled(engine, RECORDINGS, machine, [Source(entry=test)], [Source(entry=baseline)])
    return tables.Row(baseline=baseline, test=test, answer=_told(stem(test), answer))


def _told(name: str, answer: Answer) -> Answer:
    """The answer, with a line of progress."""
    word = answer.report["verdict"] if answer.report is not None else "refused"
    sys.stderr.write(f"{name}: {word} ({answer.wall_s:.0f} s)\n")
    sys.stderr.flush()
    return answer


if __name__ == "__main__":
    sys.exit(main())
