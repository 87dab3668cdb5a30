"""Write a report to a folder, each file whole or not at all."""

from __future__ import annotations

import os
import tempfile
from pathlib import Path

from reconcile.report.page import page
from reconcile.report.strict import strict_json
from reconcile.verdict import Report

REPORT, PAGE = "report.json", "report.html"


def _write(target: Path, text: str) -> None:
    """Through a file beside it: a reader never sees half of it, and an earlier one stays if writing fails."""
    handle, name = tempfile.mkstemp(dir=target.parent, prefix=f".{target.name}.")
    unfinished = Path(name)
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            file.write(text)
            file.flush()
            os.fsync(file.fileno())
        unfinished.chmod(0o644)
        unfinished.replace(target)
    except BaseException:
        unfinished.unlink(missing_ok=True)
        raise


def write_report(report: Report, folder: Path) -> tuple[Path, Path]:
    """Write `report.json` and `report.html` into `folder` (made when absent) and say where they are.

    Both texts are made before either is written.
    """
    texts = {REPORT: strict_json(report), PAGE: page(report)}
    folder.mkdir(parents=True, exist_ok=True)
    for name, text in texts.items():
        _write(folder / name, text)
    return folder / REPORT, folder / PAGE
