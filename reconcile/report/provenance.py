"""Versions, seed and cost at the end of the page."""

from __future__ import annotations

from reconcile.report.markup import Markup
from reconcile.report.sections import section, table
from reconcile.report.steps import short
from reconcile.report.strict import plain
from reconcile.verdict import Report

WORDS = {"core_s": "processor seconds", "cost": "cost", "draws": "simulated machines", "sent_as": "recordings"}


def provenance(report: Report) -> Markup:
    """Where the report comes from."""
    found = plain(report.provenance)
    rows = [(WORDS.get(k, k.replace("_", " ")), short(v)) for k, v in found.items()] if isinstance(found, dict) else []
    return section("Provenance", table(("", ""), rows))
