"""Fill the kernel cache of this machine: `python -m workers.warm`. Quick when it is filled already."""

from __future__ import annotations

import sys
import time

from jobs.physics import PhysicsEngine


def main() -> int:
    """Compile or load every kernel of a machine with all contacts; says how long it took."""
    begin = time.perf_counter()
    PhysicsEngine().warm()
    sys.stdout.write(f"kernels ready in {time.perf_counter() - begin:.1f} s\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
