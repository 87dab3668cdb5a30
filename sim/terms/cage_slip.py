"""Cage slip: balls and cage lag behind pure rolling by a share."""

from __future__ import annotations

from dataclasses import dataclass, replace

from sim.core.laws import Laws
from sim.core.params import Param
from sim.core.terms import Demo, SiteContext, Term, Validation, Values


@dataclass(frozen=True, kw_only=True)
class CageSlip(Term):
    """See the module."""

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Slow the cage of this bearing."""
        law = laws.balls[site.site]
        return replace(laws, balls={**laws.balls, site.site: replace(law, cage_slip=values["share"])})


TERM = CageSlip(
    key="cage_slip",
    title="Cage slip",
    sentence="The cage turns slower than pure rolling, so all its frequencies fall by the same share.",
    sites=("bearing",),
    params=(
        Param(
            name="share",
            unit="1",
            default=0.01,
            low=0.0,
            high=0.5,
            sentence="Share of the cage speed that is lost.",
            sought=(0.025, 0.3),
        ),
    ),
    references=("Randall & Antoni 2011, Mech. Syst. Signal Process. 25(2), 485-520 (slip of 1 to 2 %)",),
    severity="share",
    order=20,
    demo=Demo(values={"share": 0.05}),
    validation=(
        Validation(
            kind="closed form",
            source="Ball pass of a bearing that rolls, Randall & Antoni 2011, eq. (1), less the share",
            deviation=6e-3,
            test="tests/sim/terms/test_cage_slip.py::test_the_load_passes_at_the_slipped_frequency",
        ),
    ),
)
