"""Rub: a gear or disc touches a ring around it, with a stiffness, a loss and friction at the speed of its surface.

For r = |(x, y)| > gap, d = r - gap and n = (x, y) / r:

P = max(0, k d (1 + chi d')),    force on the rotor = -P n - mu P tanh(v_t / v_0) t,    t = (-n_y, n_x)

with v_t = r' . t + sense R (omega + theta'); the friction also brakes the shaft with mu P R. The loss grows with the
penetration (Hunt & Crossley), so the force begins and ends at zero.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from sim.core.choose import larger, root, select, somewhere, uniform
from sim.core.compiled import inline
from sim.core.elementary import hyperbolic_tangent
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.errors import Problem, SpecError
from sim.core.kernels import kernel
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.spec import MachineSpec, TermSpec
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.rotor import at_speed, moves, outer_radius_m, plane, refusal, shaft_lines, turning_on

# parameters: turning coordinate (0, 1), stiffness, gap, loss chi, friction, v_0, radius, sense


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Speed of the surface by the shaft's rotation at the nodes, m/s."""
    s = uniform(step[2])
    for i in range(s):
        ctx[i] = par[7] * par[6] * shafts[s + 2 + i]


@inline
def rub_tangent(par, turning, state, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Derivatives of the forces by x, y (, theta) and their rates."""
    nx, ny, r, rate, slip, depth, pushes, load, share = state
    n = 2 + turning
    arm = par[7] * par[6]
    slope = par[4] * load * (1.0 - share * share) / par[5]
    for k in range(2 * n):
        place = k % n
        moved = k < n
        zero = 0.0 * nx
        cx = zero + 1.0 if place == 0 else zero
        cy = zero + 1.0 if place == 1 else zero
        dn = cx * nx + cy * ny
        dt = -cx * ny + cy * nx
        turn = dt / r if moved else zero
        dr = dn if moved else zero
        drate = slip * turn if moved else dn
        dslip = -rate * turn if moved else (dt if place < 2 else zero + arm)
        dload = par[1] * (1.0 + par[3] * rate) * dr + par[1] * depth * par[3] * drate
        friction = par[4] * load * share
        dfriction = par[4] * dload * share + slope * dslip
        at = n * n * (k // n) + place
        out[at] = select(pushes, dload * nx - load * ny * turn - dfriction * ny - friction * nx * turn, 0.0)
        out[at + n] = select(pushes, dload * ny + load * nx * turn + dfriction * nx - friction * ny * turn, 0.0)
        if turning == 1:
            out[at + 2 * n] = select(pushes, arm * dfriction, 0.0)


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Resistance of the ring to (x, y), N, and its braking torque, N m, where the body turns."""
    turning = uniform(par[0])
    n = 2 + turning
    x = u[0]
    y = u[1]
    for k in range(n):
        f[k] = 0.0
    if mode != 0:
        for k in range(2 * n * n):
            out[k] = 0.0
    r = root(x * x + y * y)
    inside = (r > par[2]) & (r > 0.0)
    if not somewhere(inside):
        return
    r = select(r > 0.0, r, 1.0)
    nx = x / r
    ny = y / r
    rate = ud[0] * nx + ud[1] * ny
    slip = -ud[0] * ny + ud[1] * nx
    surface = ctx[0]
    if turning == 1:
        surface = surface + par[7] * par[6] * ud[2]
    depth = select(inside, larger(r - par[2], 0.0), 0.0)
    elastic = par[1] * depth
    load = elastic * (1.0 + par[3] * rate)
    pushes = inside & (load > 0.0)
    load = select(pushes, load, 0.0)
    share = hyperbolic_tangent((slip + surface) / par[5])
    friction = par[4] * load * share
    f[0] = load * nx - friction * ny
    f[1] = load * ny + friction * nx
    if turning == 1:
        f[2] = par[7] * par[6] * friction
    if mode == 1:
        rub_tangent(par, turning, (nx, ny, r, rate, slip, depth, pushes, load, share), out)
    if mode == 2:
        out[0] = 0.5 * elastic * depth
        out[1] = (load - elastic) * rate + friction * (slip + surface)
        out[2] = friction * ctx[0]
        out[3] = select(inside, 1.0, 0.0)
        out[4] = load
        out[5] = friction


KERNEL = kernel(prepare, force, same=(0,))
HALF, THIRD = Fraction(1, 2), Fraction(1, 3)
"""A rotor that turns some two or three times as fast as it vibrates freely may touch every second or third turn only
(Ehrich 1988, J. Vib. Acoust. 110(1))."""
OUTPUTS = (
    Output(name="contact", quantity="state", unit="1"),
    Output(name="normal_force", quantity="force", unit="N"),
    Output(name="friction_force", quantity="force", unit="N"),
)


def _with_unbalance(machine: MachineSpec) -> MachineSpec:
    """Something that turns must bring the disc to the ring, at three times the speed of its natural vibration."""
    term = TermSpec(term="unbalance", site="disc", parameters={"moment": 5e-6})
    return at_speed(machine.model_copy(update={"terms": [*machine.terms, term]}), 800.0)


@dataclass(frozen=True, kw_only=True)
class Rub(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """One contact around the body."""
        if not moves(site.machine, site.site) or not site.shaft_base:
            raise refusal(site, self.key, "it does not turn and move in x and y", "a gear or body of a shaft")
        largest = outer_radius_m(site.machine, site.site)
        if values["radius"] > largest:
            message = f"{site.site} does not reach that far: its outer radius is {largest:.4g} m"
            allowed = f"0.001 to {largest:.4g}"
            raise SpecError(
                Problem(field=f"{self.key}.radius", message=message, given=values["radius"], allowed=allowed, unit="m")
            )
        name = f"{site.site}.rub"
        turning = site.site in turning_on(site.machine, site.shaft)
        coordinates: tuple[Coordinate, ...] = plane(site.site, name)
        if turning:
            weights = ((f"{site.site}.theta", 1.0),)
            coordinates = (*coordinates, Coordinate(name=f"{name}.theta", unit="rad", weights=weights))
        keys = ("stiffness", "gap", "loss", "friction", "friction_speed", "radius")
        return (
            Element(
                name=name,
                site=site.site,
                kernel=KERNEL,
                coordinates=coordinates,
                forces=len(coordinates),
                parameters=flat(float(turning), *(values[k] for k in keys), site.sense),
                context=1,
                shafts=(site.site, site.site),
                outputs=OUTPUTS,
                contact_output=0,
            ),
        )

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:
        """Multiples of the shaft's rotation, and of its half and third."""
        orders = (2, 3, 4, 5, HALF, 3 * HALF, THIRD, 2 * THIRD)
        return shaft_lines(site, self.key, orders) if values["stiffness"] > 0.0 else ()


TERM = Rub(
    key="rub",
    title="Rub",
    sentence="The rotor touches a seal or guard around it: it bounces on it and is braked by friction.",
    sites=("gear", "body"),
    params=(
        Param(
            name="stiffness",
            unit="N/m",
            default=1e7,
            low=0.0,
            high=1e8,
            sentence="Radial stiffness of the ring that is touched.",
            scale="log",
        ),
        Param(
            name="gap",
            unit="m",
            default=1e-5,
            low=0.0,
            high=5e-3,
            sentence="Radial distance from the centred rotor to the ring.",
            scale="log",
        ),
        Param(
            name="loss",
            unit="s/m",
            default=0.5,
            low=0.0,
            high=10.0,
            sentence="Growth of the force per speed of approach (Hunt & Crossley): 3/2 (1 - e) / v by restitution e.",
        ),
        Param(name="friction", unit="1", default=0.1, low=0.0, high=0.5, sentence="Coulomb friction on the ring."),
        Param(
            name="friction_speed",
            unit="m/s",
            default=1e-2,
            low=1e-4,
            high=1.0,
            sentence="Sliding speed at which the regularised friction has 76 % of its full value.",
            scale="log",
        ),
        Param(
            name="radius",
            unit="m",
            default=0.02,
            low=1e-3,
            high=1.0,
            sentence="Radius at which the rotor touches, for its surface speed and the braking torque.",
            scale="log",
        ),
    ),
    references=(
        (
            "Muszynska 1989, Rotor-to-stationary element rub-related vibration phenomena in rotating machinery: "
            "literature survey, Shock Vib. Dig. 21(3)"
        ),
        "Hunt & Crossley 1975, Coefficient of restitution interpreted as damping in vibroimpact, J. Appl. Mech. 42(2)",
        (
            "Ehrich 1988, High order subharmonic response of high speed rotors in bearing clearance, J. Vib. "
            "Acoust. 110(1)"
        ),
    ),
    severity="stiffness",
    order=30,
    damage=True,
    demo=Demo(
        machine="rotor",
        values={"gap": 4e-6, "stiffness": 5e7, "friction": 0.05},
        leading=1,
        prepare=_with_unbalance,
        note="At 800 Hz, three times its lowest natural frequencies, with an unbalance of 5e-6 kg m: every second turn "
        "touches.",
    ),
    validation=(
        Validation(
            kind="independent calculation",
            source="Jeffcott rotor in a ring, force law written separately, by SciPy's DOP853",
            deviation=1e-4,
            test="tests/sim/terms/test_rub.py::test_jeffcott_rotor_in_a_ring_equals_scipy",
        ),
    ),
)
