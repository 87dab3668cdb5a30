"""Where to record next, where several bearings may have the defect."""

from __future__ import annotations

from collections.abc import Sequence

from reconcile.kinematics.observe import Observation
from reconcile.kinematics.sites import decided
from reconcile.verdict import NextExperiment, PlaceWeight

EACH = "one sensor on each of the bearings that share these lines"


def record_at(weights: Sequence[Sequence[PlaceWeight]], tests: Sequence[Observation]) -> NextExperiment:
    """A sensor on each of the bearings that are open, by what is known of where the channels stand."""
    sites = list(dict.fromkeys(w.site for several in weights if not decided(several) for w in several))
    heard = {c.location for test in tests for c in test.recording.channels}
    bare = [site for site in sites if site not in heard]
    if len(bare) == len(sites):
        told = f"Record with {EACH}, and say with each channel at which it stands (location)."
    elif bare:
        told = f"Record with {EACH}: none is said to stand at {', '.join(bare)}."
    else:
        told = (
            f"There is {EACH}, and these do not decide: inspect all of them, or record again while one is loaded "
            "otherwise."
        )
    return NextExperiment(sentence=told)
