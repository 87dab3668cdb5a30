"""The answer as files: `report.json` and one page that stands on its own (`report.html`)."""

from reconcile.report.page import page
from reconcile.report.strict import document, strict_json
from reconcile.report.write import write_report

__all__ = ["document", "page", "strict_json", "write_report"]
