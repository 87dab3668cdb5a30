"""Copies of JSON documents, some ten times faster than `copy.deepcopy`."""

from __future__ import annotations

from typing import Any


def copied(value: Any) -> Any:  # noqa: ANN401 - a JSON document
    """A copy of a JSON document that shares no object or list with it."""
    if isinstance(value, dict):
        return {key: copied(item) if isinstance(item, dict | list) else item for key, item in value.items()}
    if isinstance(value, list):
        return [copied(item) if isinstance(item, dict | list) else item for item in value]
    return value
