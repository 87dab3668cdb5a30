"""`python -m workers`: see `workers.command`."""

from __future__ import annotations

import sys

from workers import command

if __name__ == "__main__":
    sys.exit(command.main(sys.argv[1:]))
