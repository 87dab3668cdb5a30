"""`python -m paper`: recompute the paper's figures and trends and write docs/paper.md."""

from __future__ import annotations

import argparse
import sys
import time
from pathlib import Path

from tqdm import tqdm

from paper.page import write_page
from paper.run import results
from paper.study import main_cases, sensitivity_cases

ROOT = Path(__file__).resolve().parent.parent


def main() -> None:
    """Run the study."""
    parser = argparse.ArgumentParser(prog="paper", description=__doc__)
    parser.add_argument("--fresh", action="store_true", help="simulate everything again, whatever is cached")
    parser.add_argument("--processes", type=int, default=2, help="worker processes (default 2)")
    parser.add_argument("--cache", type=Path, default=ROOT / ".cache" / "paper")
    parser.add_argument("--docs", type=Path, default=ROOT / "docs")
    given = parser.parse_args()
    began = time.monotonic()
    cases = (*main_cases(), *sensitivity_cases())
    with tqdm(total=1.0, desc="simulating", bar_format="{l_bar}{bar}| {elapsed}<{remaining}") as bar:

        def progress(done: int, total: int) -> None:
            bar.update(done / total - bar.n)

        found = results(cases, folder=given.cache, fresh=given.fresh, processes=given.processes, progress=progress)
    page = write_page(given.docs, found)
    sys.stdout.write(f"{len(found)} runs, {time.monotonic() - began:.0f} s: {page}\n")


if __name__ == "__main__":
    main()
