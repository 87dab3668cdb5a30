"""`python -m app.keys NAME`: make an API key; only its digest goes to the server.

A key is 256 random bits, so a plain SHA-256 cannot be searched; slow password hashing would add nothing.
"""

from __future__ import annotations

import hashlib
import secrets
import sys


def digest_of(key: str) -> str:
    """What the server keeps of a key."""
    return hashlib.sha256(key.encode()).hexdigest()


def main(arguments: list[str]) -> int:
    """Entry point."""
    if len(arguments) != 1 or not arguments[0].replace("-", "").replace("_", "").isalnum():
        sys.stderr.write("usage: python -m app.keys NAME (letters, digits, - and _)\n")
        return 2
    key = f"sb_{secrets.token_urlsafe(32)}"
    sys.stdout.write(f"key (give it to {arguments[0]}, it is not shown again): {key}\n")
    sys.stdout.write(f"SIDEBAND_API_KEYS entry: {arguments[0]}:{digest_of(key)}\n")
    return 0


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
