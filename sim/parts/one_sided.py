"""Elastic law of one coordinate that a linear spring of the machine lacks: cubic, dead zone, one-sided loss.

f(x) = cubic x^3 - held clamp(x, -gap, gap) - lifted max(x - start, 0). Beside a spring k x of the machine, held = k
makes a dead zone of +- gap, lifted = share k a spring that is softer on one side. The energies of the two reductions
are negative: together with the machine's spring they are what is stored.
"""

from __future__ import annotations

from sim.core.choose import larger, select, size, smaller
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.kernels import kernel


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Nothing turns."""
    ctx[0] = 0.0


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Resistance, N or N m; tangent and energy in closed form."""
    x = u[0]
    inside = smaller(larger(x, -par[2]), par[2])
    beyond = larger(x - par[4], 0.0)
    f[0] = par[0] * x * x * x - par[1] * inside - par[3] * beyond
    if mode == 1:
        out[0] = 3.0 * par[0] * x * x - select(size(x) < par[2], par[1], 0.0) - select(beyond > 0.0, par[3], 0.0)
        out[1] = 0.0
    if mode == 2:
        gap = par[2] * larger(size(x) - par[2], 0.0)
        held = par[1] * (0.5 * inside * inside + gap)
        out[0] = 0.25 * par[0] * x * x * x * x - held - 0.5 * par[3] * beyond * beyond
        out[1] = 0.0
        out[2] = 0.0
        out[3] = f[0]


KERNEL = kernel(prepare, force)


def one_sided_element(
    *,
    name: str,
    site: str,
    coordinate: Coordinate,
    output: Output,
    cubic: float = 0.0,
    held: float = 0.0,
    gap: float = 0.0,
    lifted: float = 0.0,
    start: float = 0.0,
) -> Element:
    """The element; stiffness in N/m (N m/rad), `cubic` in N/m^3 (N m/rad^3), `gap` and `start` in m (rad)."""
    return Element(
        name=name,
        site=site,
        kernel=KERNEL,
        coordinates=(coordinate,),
        forces=1,
        parameters=flat(cubic, held, gap, lifted, start),
        context=1,
        shafts=("", ""),
        outputs=(output,),
        rates=False,
    )
