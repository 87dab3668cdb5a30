"""Changing single values of a machine by name: `signals.overrides`, under the name the doors know."""

from signals.overrides import apply_overrides, told_by_key

__all__ = ["apply_overrides", "told_by_key"]
