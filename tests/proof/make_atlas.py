"""Simulate the small atlas of the small cases again and write it with its stamp: part of `make tests-atlas`."""

from __future__ import annotations

import tempfile
from pathlib import Path

from tests.proof.prebuilt import wanted
from tests.proof.small import nominal_machine
from tests.reconcile.prebuilt import make


def main() -> None:
    """About a minute on one core."""
    with tempfile.TemporaryDirectory() as folder:
        print(make(wanted(nominal_machine(Path(folder)))))


if __name__ == "__main__":
    main()
