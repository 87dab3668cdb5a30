"""The envelope in which a struck part is heard, as the level `kinematics` draws it, for effects that are told."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from reconcile.kinematics.candidate import DEFECTS, Candidate
from reconcile.kinematics.families import Ties
from reconcile.kinematics.judge import same
from reconcile.kinematics.observe import Observation
from reconcile.kinematics.picture import envelope_picture
from reconcile.verdict import Cause
from sim.terms import REGISTRY

MOST_DRAWN = 3
"""Parts of which an envelope is drawn."""


@dataclass(frozen=True, kw_only=True)
class Drawn:
    """The `picture` of a part's lines; `kind` of the part, and the `sites` of bearings that have these lines."""

    kind: str
    sites: tuple[str, ...]
    picture: Mapping[str, object]

    def of(self, causes: Sequence[Cause]) -> dict[str, object] | None:
        """The picture by the bearing of the first of some causes that makes these lines; None where none does."""
        for cause in causes:
            term = REGISTRY.get(cause.term)
            if term is not None and term.strikes == self.kind and cause.site in self.sites:
                return {**self.picture, "family": f"{cause.site}.{self.kind}"}
        return None


def drawn(
    firm: Sequence[Candidate],
    every: Sequence[Candidate],
    tests: Sequence[Observation],
    baselines: Sequence[Observation],
    tie: Ties,
) -> tuple[Drawn, ...]:
    """Of the firmest parts of bearings that strike (`firm`), beside the lines of all others; `baselines`: of each test,
    or fewer."""
    found = []
    for one in [c for c in firm if c.family.kind in DEFECTS][:MOST_DRAWN]:
        rest = [c for c in every if c is not one]
        k = one.strongest
        own = baselines[k : k + 1] if len(baselines) == len(tests) else baselines
        picture = envelope_picture([one, *rest], (), tests, own)["envelope"]
        sites = tuple(f.site for f in tie.families if f.kind == one.family.kind and same(f, one.family))
        found.append(Drawn(kind=one.family.kind, sites=sites, picture=dict(picture)))  # type: ignore[call-overload]
    return tuple(found)


def envelopes_of(heard: Sequence[Drawn], causes: Sequence[Cause]) -> list[dict[str, object]]:
    """Those of parts that one of the causes strikes at, the firmest part first, by the bearing of a named cause."""
    ordered = sorted(causes, key=lambda cause: not cause.named)
    shown = [one.of(ordered) for one in heard]
    return [picture for picture in shown if picture is not None]
