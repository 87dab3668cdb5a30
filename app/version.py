"""The version of the product."""

from __future__ import annotations

from importlib.metadata import PackageNotFoundError, version


def _installed() -> str:
    try:
        return version("sideband")
    except PackageNotFoundError:
        return "0.1.0"


VERSION = _installed()
