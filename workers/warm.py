"""Fill the kernel cache of this machine: `python -m workers.warm`. Quick when it is filled already.

With `--lanes` also by those kernels that simulate machines side by side, and by those of reconciliations, which the
first of such tasks compiles else.
"""

from __future__ import annotations

import argparse
import importlib
import sys
import time
from collections.abc import Sequence
from typing import TextIO

from numba.core import event

SAY_EVERY_S = 4.0


class Compilations(event.Listener):
    """Says now and then how many functions were compiled: a first start would be silent for half a minute."""

    def __init__(self, stream: TextIO) -> None:
        self.count = 0
        self._stream = stream
        self._said_at = time.perf_counter()

    def on_start(self, event: event.Event) -> None:  # noqa: ARG002 - numba's form
        """One function more."""
        self.count += 1
        now = time.perf_counter()
        if now - self._said_at >= SAY_EVERY_S:
            self._said_at = now
            self._stream.write(f"      {self.count} functions compiled\n")
            self._stream.flush()

    def on_end(self, event: event.Event) -> None:
        """Compiled."""


def main(arguments: Sequence[str] | None = None) -> int:
    """Compile or load every kernel of a machine with all contacts; says how long it took."""
    parser = argparse.ArgumentParser(prog="python -m workers.warm", description="Fill the kernel cache.")
    parser.add_argument(
        "--lanes", action="store_true", help="of machines simulated side by side, and of reconciliations, too"
    )
    given = parser.parse_args(arguments)
    begin = time.perf_counter()
    seen = Compilations(sys.stdout)
    with event.install_listener("numba:compile", seen):
        # Effects are compiled when they are imported, which is why the import waits for the listener.
        importlib.import_module("jobs.physics").PhysicsEngine().warm(lanes=given.lanes)
        if given.lanes:
            importlib.import_module("reconcile.compiled.warm").warm()
    how = f"{seen.count} functions compiled" if seen.count else "loaded from the cache"
    sys.stdout.write(f"      kernels ready in {time.perf_counter() - begin:.1f} s ({how})\n")
    return 0


if __name__ == "__main__":
    sys.exit(main())
