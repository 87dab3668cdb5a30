"""The version of the product."""

from __future__ import annotations

from reconcile.origin import PACKAGE_VERSION

VERSION = PACKAGE_VERSION
