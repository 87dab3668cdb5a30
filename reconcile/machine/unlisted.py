"""What stays open, and what to do, where no known effect is adequate."""

from __future__ import annotations

from reconcile.verdict import NextExperiment

UNLISTED = (
    "which law it is, and whether one effect or several",
    "how large it is",
)
"""What stays open where no known effect is adequate."""


def beyond_the_known(site: str, *, tried: bool) -> NextExperiment:
    """What to do where no known effect is adequate: those that were tried are no answer to be told apart."""
    where = f" near {site}" if site else ""
    laws = "" if tried else "Ask again with the full budget, which tries force laws. "
    return NextExperiment(
        sentence=f"{laws}Look at the parts{where}, and record with a sensor more there: the fewer places it may act "
        "at, the more of its law can be told."
    )
