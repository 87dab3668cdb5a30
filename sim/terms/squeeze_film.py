"""Squeeze-film damper between a bearing's outer ring and its housing: short bearing, cavitated (pi) film.

With displacement u, velocity v and film h = c - u.n over the angle of the normal n, Reynolds' equation of the short
bearing gives the pressure mu L^3 (v.n) / h^3 a unit of angle where the film is squeezed, v.n > 0, and none elsewhere:
F = mu R L^3 integral of (v.n) n / h^3 over that half circle. Its angle is measured from v, so Gauss-Legendre nodes
see a smooth integrand; the centred film's damping C0 = pi/2 mu R (L/c)^3 stands for mu R L^3.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from sim.core.choose import larger, root, select, uniform
from sim.core.compiled import inline
from sim.core.elements import Element, Output, flat
from sim.core.kernels import kernel
from sim.core.laws import Laws
from sim.core.params import Param
from sim.core.response import FloatArray
from sim.core.terms import SiteContext, Term, Validation, Values
from sim.parts.wall import ring_wall_coordinates

CONTEXT, NODES = 1, 24
LEAST_FILM = 0.05
"""Thinnest film over the clearance: below, roughness and side leakage bound the pressure; the ring striking its bore
is another effect."""


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Mark the context as used; the film follows no shaft."""
    ctx[0] = 0.0


@inline
def film_tangent(u, par, n, motion, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Derivatives by displacement, (v.n) n n^T 3 / h^4, and by velocity, n n^T / h^3; symmetric both."""
    speed, dx, dy = motion
    kxx = 0.0 * u[0]
    kxy = kxx
    kyy = kxx
    cxx = kxx
    cxy = kxx
    cyy = kxx
    for k in range(n):
        nx = dx * par[4 + k] - dy * par[4 + n + k]
        ny = dy * par[4 + k] + dx * par[4 + n + k]
        gap = par[1] - u[0] * nx - u[1] * ny
        h = larger(gap, par[2])
        d = par[0] * par[4 + 2 * n + k] / (h * h * h)
        s = select(gap > par[2], 3.0 * d * speed * par[4 + k] / h, 0.0)
        kxx += s * nx * nx
        kxy += s * nx * ny
        kyy += s * ny * ny
        cxx += d * nx * nx
        cxy += d * nx * ny
        cyy += d * ny * ny
    out[0] = kxx
    out[1] = kxy
    out[2] = kxy
    out[3] = kyy
    out[4] = cxx
    out[5] = cxy
    out[6] = cxy
    out[7] = cyy


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Resistance of the film, N, with tangent (mode 1) or outputs (mode 2)."""
    n = uniform(par[3])
    speed = root(ud[0] * ud[0] + ud[1] * ud[1])
    moving = speed > 0.0
    share = 1.0 / select(moving, speed, 1.0)
    dx = select(moving, ud[0] * share, 1.0)
    dy = select(moving, ud[1] * share, 0.0)
    fx = 0.0 * u[0]
    fy = fx
    for k in range(n):
        nx = dx * par[4 + k] - dy * par[4 + n + k]
        ny = dy * par[4 + k] + dx * par[4 + n + k]
        h = larger(par[1] - u[0] * nx - u[1] * ny, par[2])
        p = par[4 + k] * par[4 + 2 * n + k] / (h * h * h)
        fx += p * nx
        fy += p * ny
    f[0] = par[0] * speed * fx
    f[1] = par[0] * speed * fy
    if mode == 1:
        film_tangent(u, par, n, (speed, dx, dy), out)
    if mode == 2:
        out[0] = 0.0
        out[1] = f[0] * ud[0] + f[1] * ud[1]
        out[2] = 0.0
        out[3] = f[0]
        out[4] = f[1]
        out[5] = root(u[0] * u[0] + u[1] * u[1]) / par[1]


KERNEL = kernel(prepare, force, same=(3,))
OUTPUTS = (
    Output(name="force_x", quantity="force", unit="N", axis="x"),
    Output(name="force_y", quantity="force", unit="N", axis="y"),
    Output(name="eccentricity_ratio", quantity="state", unit="1"),
)


def film_parameters(values: Values) -> FloatArray:
    """mu R L^3, c, thinnest film, number of nodes, then cosine, sine and weight of each node."""
    c = values["film"]
    nodes, weights = np.polynomial.legendre.leggauss(NODES)
    angle = 0.5 * np.pi * nodes
    scale = 2.0 / np.pi * values["damping"] * c**3
    return flat(scale, c, LEAST_FILM * c, float(NODES), np.cos(angle), np.sin(angle), 0.5 * np.pi * weights)


@dataclass(frozen=True, kw_only=True)
class SqueezeFilm(Term):
    """See the module."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """The film, beside the support of the ring, which centres it."""
        return (
            Element(
                name=f"{site.site}.film",
                site=site.site,
                kernel=KERNEL,
                coordinates=ring_wall_coordinates(site.site, against=None),
                forces=2,
                parameters=film_parameters(values),
                context=CONTEXT,
                shafts=(site.shaft, site.shaft),
                outputs=OUTPUTS,
                stiff=True,
                linear_stiffness=np.zeros((2, 2)),
            ),
        )


TERM = SqueezeFilm(
    key="squeeze_film",
    title="Squeeze-film damper",
    sentence="An oil film around the outer ring damps its motion, the more the closer it comes to the bore.",
    sites=("bearing",),
    params=(
        Param(
            name="damping",
            unit="N*s/m",
            default=5e3,
            low=0.0,
            high=1e6,
            sentence="Damping of the centred film, pi/2 mu R (L/c)^3.",
            scale="log",
        ),
        Param(name="film", unit="m", default=1e-4, low=1e-5, high=1e-3, sentence="Radial clearance c.", scale="log"),
    ),
    references=(
        "Vance, Rotordynamics of Turbomachinery, 1988 (squeeze-film dampers, circular orbit)",
        "Childs, Turbomachinery Rotordynamics, 1993 (squeeze-film dampers)",
    ),
    severity="damping",
    passive=True,
    order=30,
    excludes=("fit_clearance", "fit_clearance_series"),
    validation=(
        Validation(
            kind="closed form",
            source="Short pi film on a circular orbit: C_tt = C0 / (1 - e^2)^1.5, C_rt = C0 (4 / pi) e / (1 - e^2)^2",
            deviation=1e-6,
            test="tests/sim/terms/test_squeeze_film.py::test_circular_orbits_give_the_closed_forms",
        ),
        Validation(
            kind="independent calculation",
            source="Pressure integrated over the whole circle by SciPy's adaptive quadrature",
            deviation=1e-6,
            test="tests/sim/terms/test_squeeze_film.py::test_any_motion_gives_the_integral_of_the_pressure",
        ),
    ),
)
