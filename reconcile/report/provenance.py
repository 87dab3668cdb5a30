"""Versions, seed and cost at the end of the page."""

from __future__ import annotations

from reconcile.report.markup import Markup
from reconcile.report.sections import section, table
from reconcile.report.steps import short
from reconcile.report.strict import Plain, plain
from reconcile.verdict import Report

WORDS = {
    "core_s": "processor seconds",
    "until_atlas_core_s": "of them until the atlas was there",
    "draws": "simulated machines of the kind, at each operating point",
    "sent_as": "recordings",
}


def provenance(report: Report) -> Markup:
    """Where the report comes from."""
    found = plain(report.provenance)
    told = {k: v for k, v in found.items() if v is not None and v != ""} if isinstance(found, dict) else {}
    rows = [(_word(k), short(_named(v))) for k, v in told.items()]
    return section("Provenance", table(("", ""), rows))


def _word(key: str) -> str:
    return WORDS.get(key, key.replace("_", " "))


def _named(value: Plain) -> Plain:
    """What stands within, by the same words."""
    return {_word(k): v for k, v in value.items()} if isinstance(value, dict) else value
