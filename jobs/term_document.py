"""An effect as a document: what it is, where it acts, what it predicts, and what it was checked against."""

from __future__ import annotations

from dataclasses import asdict

from jobs.demonstration import demonstration, predicted
from sim.core.terms import Term


def term_document(term: Term) -> dict[str, object]:
    """Everything that a term declares, and its lines on the machine that demonstrates it. Plain JSON values."""
    shown = demonstration(term)
    return {
        "key": term.key,
        "title": term.title,
        "sentence": term.sentence,
        "sites": list(term.sites),
        "severity": term.severity,
        "zero_is_healthy": term.zero_is_healthy,
        "passive": term.passive,
        "order": term.order,
        "excludes": list(term.excludes),
        "references": list(term.references),
        "parameters": [asdict(param) for param in term.params],
        "predicted_lines": [
            {
                "label": line.label,
                "orders": {base: n if isinstance(n, int) else float(n) for base, n in line.orders if n},
                "family": line.family,
                "component": line.component,
                "frequency_hz": hz,
            }
            for line, hz in predicted(term, shown)
        ],
        "validation": [asdict(check) for check in term.validation],
        "demo": {
            "machine": term.demo.machine,
            "site": shown.site,
            "elsewhere": list(term.demo.elsewhere),
            "values": dict(shown.values),
            "note": term.demo.note,
        },
        "page": f"docs/physics/{term.key}.md",
    }
