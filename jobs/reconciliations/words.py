"""Names that the parts of a reconciliation's way share."""

from __future__ import annotations

RECONCILIATION = "reconciliation"
"""Kind of these jobs."""
REPORT = "report"
"""Name of the document that makes a stored result a reconciliation."""
MACHINE = "machine"
"""Name of the document with the revised machine, there when the answer has one."""
PAGE = "report.html"
