"""Internal clearance of a bearing that differs from its specification: wear, fits, heat; negative is preload."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.bearing.clearances import largest_internal_clearance_m
from sim.parts.bearing.size import bearing_size
from sim.parts.wall import mesh_sidebands

HARMONICS = 6


@dataclass(frozen=True, kw_only=True)
class RadialClearance(Term):
    """See the module."""

    def centre_play_m(self, values: Values) -> float:
        """Clearance lets the shaft's centre move that far."""
        return max(values["change"], 0.0)

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Widen the gap of every ball."""
        law = laws.balls[site.site]
        law = replace(law, gap_m=law.gap_m + values["change"])
        return replace(laws, balls={**laws.balls, site.site: law})

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Multiples of the outer-race frequency and mesh sidebands: fewer balls carry, over a smaller angle."""
        if values["change"] == 0.0:
            return ()
        base = f"f_o{site.index}"
        own = tuple(
            Line(orders=((base, k),), component=site.site, mechanism=self.key, family="outer")
            for k in range(1, HARMONICS + 1)
        )
        return own + mesh_sidebands(site, self.key, harmonics=7, sides=2)

    def cautions(self, values: Values, site: SiteContext) -> Sequence[str]:
        """A clearance beyond the loosest class of bearings of that size."""
        bearing = next(b for b in site.machine.bearings if b.name == site.site)
        size = bearing_size(bearing)
        most = None if size is None else largest_internal_clearance_m(size.bore_m)
        total = 2.0 * (bearing.radial_clearance_m + values["change"])
        if most is None or values["change"] <= 0.0 or total <= most:
            return ()
        clearance = f"radial internal clearance with its change {1e6 * total:.4g} um"
        return (f"{site.site}: {clearance} is above {1e6 * most:g} um, the largest of class C5 (ISO 5753-1)",)


TERM = RadialClearance(
    key="radial_clearance",
    title="Internal clearance and preload",
    sentence="The balls have more play between the races than specified, or less: below zero they are preloaded.",
    sites=("bearing",),
    params=(
        Param(
            name="change",
            unit="m",
            default=1e-5,
            low=-2e-5,
            high=2e-4,
            sentence="Added to the gap of each centred ball (half of the diametral clearance); negative is preload.",
        ),
    ),
    references=(
        "Harris & Kotzalas, Rolling Bearing Analysis, 5th ed. 2006, ch. 7 (clearance and load distribution)",
        "Sunnersjo 1978, J. Sound Vib. 58(3), 363-373 (varying compliance and clearance)",
    ),
    severity="change",
    order=20,
    demo=Demo(values={"change": 2e-5}),
    validation=(
        Validation(
            kind="published table",
            source="Sjovall's load distribution integral J_r(0.5) = 0.2288 for point contact, Harris & Kotzalas, ch. 7",
            deviation=3e-3,
            test="tests/sim/terms/test_radial_clearance.py::test_the_largest_ball_load_is_that_of_sjovalls_integral",
        ),
    ),
)
