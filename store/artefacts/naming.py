"""What an artefact may be called: the same in every store."""

from __future__ import annotations

import re

_KEY = re.compile(r"[a-z0-9]+(/[A-Za-z0-9][A-Za-z0-9._-]*)+")


def checked(key: str) -> str:
    """The key; raises ValueError when it could name something outside the store."""
    if not _KEY.fullmatch(key) or ".." in key:
        raise ValueError(f"not an artefact key: {key!r}")
    return key
