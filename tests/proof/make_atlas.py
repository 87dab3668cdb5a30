"""`make proof-atlas`: simulate the small atlas again and write it with its stamp."""

from __future__ import annotations

import json
import tempfile
from pathlib import Path

from reconcile.atlas.bank import make_bank
from tests.proof.prebuilt import BANK, FOLDER, STAMP, slim, wanted
from tests.proof.small import nominal_machine


def main() -> None:
    """About a minute on one core."""
    with tempfile.TemporaryDirectory() as folder:
        now = wanted(nominal_machine(Path(folder)))
    bank = make_bank(now.plan, now.point, now.channels)
    FOLDER.mkdir(exist_ok=True)
    BANK.write_bytes(slim(bank, now.stored).to_bytes())
    STAMP.write_text(json.dumps(now.stamp(), indent=1) + "\n", encoding="utf-8")
    alive = int(bank.alive.sum())
    print(f"{BANK}: {alive} of {len(now.plan.draws)} machines, {BANK.stat().st_size / 1e3:.0f} kB")


if __name__ == "__main__":
    main()
