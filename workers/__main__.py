"""`python -m workers`: see `workers.command`, which is loaded here."""

from __future__ import annotations

import importlib
import sys

from sim.loading import loading

if __name__ == "__main__":
    with loading():
        command = importlib.import_module("workers.command")
    sys.exit(command.main(sys.argv[1:]))
