"""`python -m app.keys NAME [options]`: make an API key; only its digest goes to the server.

A key is 256 random bits, so a plain SHA-256 cannot be searched; slow password hashing would add nothing.
"""

from __future__ import annotations

import argparse
import hashlib
import json
import secrets
import sys
import time
from collections.abc import Sequence
from datetime import UTC, datetime, timedelta

from pydantic import ValidationError

from app.guards.scopes import SCOPES
from app.key_file import VARIABLE, KeyEntry
from jobs.validation import problems_of

MAX_DAYS = 3660.0


def digest_of(key: str) -> str:
    """What the server keeps of a key."""
    return hashlib.sha256(key.encode()).hexdigest()


def main(arguments: Sequence[str], *, now: float | None = None) -> int:
    """Entry point. `now`: seconds since the epoch, UTC."""
    parser = argparse.ArgumentParser(prog="python -m app.keys", description="Make an API key.", allow_abbrev=False)
    parser.add_argument("name", help="whose key it is: letters, digits, `-`, `_` and `.`")
    parser.add_argument("--scopes", help=f"what it is for, with commas: {','.join(SCOPES)} (default: all)")
    parser.add_argument("--days", type=_days, help="how long it holds (default: for ever)")
    parser.add_argument("--requests-per-minute", type=int, metavar="N", help="calls, in each API process")
    parser.add_argument("--core-seconds-per-day", type=float, metavar="N", help="estimated work accepted in 24 hours")
    given = parser.parse_args(arguments)
    key = f"sb_{secrets.token_urlsafe(32)}"
    try:
        entry = _entry(given, digest_of(key), time.time() if now is None else now)
    except ValidationError as error:
        sys.stderr.writelines(f"{problem}\n" for problem in problems_of(error))
        return 2
    shown = entry.model_dump(mode="json", exclude_defaults=True)
    sys.stdout.write(f"key (give it to {entry.name}, it is not shown again): {key}\n")
    sys.stdout.write(f"{VARIABLE} entry: {json.dumps(shown)}\n")
    if set(shown) == {"name", "sha256"}:
        sys.stdout.write(f"SIDEBAND_API_KEYS entry: {entry.name}:{entry.sha256}\n")
    return 0


def _days(text: str) -> float:
    days = float(text)
    if not 0.0 < days <= MAX_DAYS:
        raise argparse.ArgumentTypeError(f"must be more than 0 and at most {MAX_DAYS:g}, not {text}")
    return days


def _entry(given: argparse.Namespace, digest: str, now: float) -> KeyEntry:
    """Raises pydantic's ValidationError."""
    fields: dict[str, object] = {"name": given.name, "sha256": digest}
    if given.scopes is not None:
        fields["scopes"] = [scope.strip() for scope in given.scopes.split(",")]
    if given.days is not None:
        end = datetime.fromtimestamp(now, UTC) + timedelta(days=given.days)
        fields["not_after"] = end.replace(microsecond=0)
    fields["requests_per_minute"] = given.requests_per_minute
    fields["core_seconds_per_day"] = given.core_seconds_per_day
    return KeyEntry.model_validate(fields)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
