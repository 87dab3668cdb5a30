"""Simulate the small atlases of whole reconciliations again and write them with their stamps: in `make tests-atlas`."""

from __future__ import annotations

from tests.reconcile.machine import test_joint_fit as joint
from tests.reconcile.machine import test_reconcile_machine as spall
from tests.reconcile.prebuilt import make


def main() -> None:
    """A minute on one core."""
    for now in (spall.wanted(), *joint.wanted()):
        print(make(now))


if __name__ == "__main__":
    main()
