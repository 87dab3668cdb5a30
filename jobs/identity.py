"""A job is named by what it computes: the same request, seed and physics version share one id and one result."""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping

ID_CHARS = 32
"""128 bits of the digest: enough that two different requests never meet, short enough for an address."""


def canonical_json(document: object) -> str:
    """One text for one meaning: sorted keys, no spaces, shortest exact floats, no NaN or Infinity."""
    return json.dumps(document, sort_keys=True, separators=(",", ":"), ensure_ascii=True, allow_nan=False)


def digest(document: object) -> str:
    """SHA-256 of the canonical text, hexadecimal."""
    return hashlib.sha256(canonical_json(document).encode("ascii")).hexdigest()


def job_id(kind: str, request: Mapping[str, object], physics_version: str) -> str:
    """Id of a job. `request` is the resolved request: the whole machine, the numbers and the seed."""
    return digest({"kind": kind, "request": request, "physics_version": physics_version})[:ID_CHARS]
