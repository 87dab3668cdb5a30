"""Simulate the small atlases of the small cases again and write them with their stamps: part of `make tests-atlas`."""

from __future__ import annotations

import tempfile
from pathlib import Path

from tests.proof import rotor
from tests.proof.prebuilt import wanted
from tests.proof.small import nominal_machine
from tests.reconcile.prebuilt import make


def main() -> None:
    """About a minute on one core."""
    with tempfile.TemporaryDirectory() as folder:
        for now in (wanted(nominal_machine(Path(folder))), *rotor.wanted()):
            print(make(now))


if __name__ == "__main__":
    main()
