"""Seeds on the command line, within the bound that they have over HTTP: a run can be repeated through either door."""

from __future__ import annotations

import argparse

from jobs.request import MOST_SEED

_SHOWN = 40


def seed(text: str) -> int:
    """A seed: a whole number from 0 to 2^53 - 1, beyond which JSON numbers lose digits. For argparse."""
    if text.isascii() and text.isdecimal() and len(text) <= _SHOWN and int(text) <= MOST_SEED:
        return int(text)
    given = text if len(text) <= _SHOWN else f"{text[:_SHOWN]}..."
    raise argparse.ArgumentTypeError(f"is no seed (given {given!r}); allowed: a whole number from 0 to {MOST_SEED}")
