"""Run-out of a gear: its base circle turns about a point beside its centre.

The base circle's centre stands off the axis by the vector r (cos, sin)(sense * phi + phase). Its component on the line
of action enters the transmission error, the one on the centre line the centre distance (`sim/parts/mesh_kernels.py`),
so mesh lines get sidebands at the gear's shaft speed. The seed has no such term and therefore cannot produce
f_m +- f_r1 (docs/physics/deviations.md).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.terms import SiteContext, Term, Validation, Values


@dataclass(frozen=True, kw_only=True)
class Eccentricity(Term):
    """See the module."""

    def centre_play_m(self, values: Values) -> float:
        """The radius of the run-out."""
        return values["radius"]

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:
        """Set the run-out of the gear in every mesh it takes part in."""
        meshes = dict(laws.meshes)
        for name, law in laws.meshes.items():
            if law.pinion == site.site:
                meshes[name] = replace(law, runout_pinion_m=values["radius"], runout_pinion_phase_rad=values["phase"])
            elif law.gear == site.site:
                meshes[name] = replace(law, runout_gear_m=values["radius"], runout_gear_phase_rad=values["phase"])
        return replace(laws, meshes=meshes)

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Shaft line and first sidebands of the mesh harmonics."""
        if values["radius"] == 0.0 or not site.shaft_base:
            return ()
        found = [Line(orders=((site.shaft_base, 1),), component=site.site, mechanism=self.key, family="shaft")]
        for i, mesh in enumerate(site.machine.meshes, 1):
            if site.site in (mesh.pinion, mesh.gear):
                base = "f_m" if i == 1 else f"f_m{i}"
                for k in range(1, 8):
                    for side in (-1, 1):
                        orders = ((base, k), (site.shaft_base, side))
                        found.append(Line(orders=orders, component=site.site, mechanism=self.key, family="mesh"))
        return tuple(found)


TERM = Eccentricity(
    key="eccentricity",
    title="Gear run-out",
    sentence="The gear's teeth stand on a circle that is not centred on its shaft.",
    sites=("gear",),
    params=(
        Param(
            name="radius",
            unit="m",
            default=1e-5,
            low=0.0,
            high=5e-4,
            sentence="Distance of the base circle's centre from the axis of rotation.",
            sought=(2e-6, 1.5e-4),
            scale="log",
        ),
        Param(
            name="phase", unit="rad", default=0.0, low=-6.2832, high=6.2832, sentence="Angle of the offset at t = 0."
        ),
    ),
    references=("Randall, Vibration-based Condition Monitoring, 2nd ed. 2021, ch. 2 (gear modulation)",),
    severity="radius",
    order=20,
    validation=(
        Validation(
            kind="closed form",
            source="vectors from both axes to both base circle centres, projected on the line of action",
            deviation=1e-12,
            test="tests/sim/parts/test_mesh_kernels.py::test_run_out_is_projected_on_the_line_of_action",
        ),
        Validation(
            kind="closed form",
            source="line of the shaft speed in spectrum or envelope at 20, 30 and 45 Hz, within half a bin",
            deviation=0.03,
            test="tests/sim/terms/test_tooth_faults.py::test_the_line_found_is_the_predicted_one",
        ),
    ),
)
