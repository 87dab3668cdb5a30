"""The stack machine that runs a user's force law: values with their derivatives by displacement and velocity.

Parameters: count, 64 codes, 64 numbers, scale, table head (displacements, velocities, angles, first and inverse step of
displacement and of velocity), table. The stack lives in the context row: [phi, then value, d/dx, d/dv of eight places].
Codes are those of `sim.core.expression`.
"""

from __future__ import annotations

from sim.core.choose import floor, larger, pick, root, select, size, smaller, uniform
from sim.core.compiled import inline
from sim.core.elementary import exponential, hyperbolic_tangent, logarithm, sine_cosine
from sim.core.kernels import kernel

CONTEXT = 25


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Angle of the shaft at the nodes, rad."""
    s = uniform(step[2])
    for i in range(s):
        ctx[25 * i] = shafts[i + 1]


@inline
def guarded(b):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """The number, at least 1e-150 in size."""
    return select(size(b) < 1e-150, select(b < 0.0, -1e-150, 1e-150), b)


@inline
def whole_power(a, n):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """a^n and its slope for a whole number n."""
    least = 0.0 * a + 1.0
    count = n if n > 0 else -n
    for _ in range(count - 1):
        least = least * a
    full = least * a if count > 0 else least
    if n > 0:
        return full, n * least
    if n == 0:
        return least, 0.0 * a
    value = 1.0 / guarded(full)
    return value, n * value / guarded(a)


@inline
def unary(code, a, number):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Value and slope of a function of one number."""
    value = -a
    slope = 0.0 * a - 1.0
    if 20 <= code <= 21:
        s, c = sine_cosine(a)
        value = s if code == 20 else c
        slope = c if code == 20 else -s
    elif code == 22:
        value = size(a)
        slope = select(a < 0.0, -1.0, 0.0 * a + 1.0)
    elif code == 23:
        value = select(a > 0.0, 1.0, select(a < 0.0, -1.0, 0.0 * a))
        slope = 0.0 * a
    elif code == 24:
        value = root(larger(a, 0.0))
        slope = select(a > 1e-300, 0.5 / root(larger(a, 1e-300)), 0.0 * a)
    elif code == 25:
        value = exponential(a)
        slope = value
    elif code == 26:
        value = hyperbolic_tangent(a)
        slope = 1.0 - value * value
    elif code == 30:
        base = larger(a, 1e-300)
        value = select(a > 1e-300, exponential(number * logarithm(base)), 0.0 * a)
        slope = number * value / base
    elif code >= 92:
        value, slope = whole_power(a, code - 100)
    return value, slope


@inline
def along(t, count):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Cell, share and whether a position (in steps) lies within a table of `count` points."""
    last = count - 1.0
    held = smaller(larger(t, 0.0), last)
    cell = larger(smaller(floor(held), last - 1.0), 0.0)
    return cell, held - cell, (t >= 0.0) & (t <= last) & (last > 0.0 * t)


@inline
def table(x, v, phi, par):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Value and derivatives of the table by linear interpolation; the angle repeats, the rest is held at its ends."""
    nx = par[130]
    nv = par[131]
    na = par[132]
    i, p, in_x = along((x - par[133]) * par[134], nx)
    j, q, in_v = along((v - par[135]) * par[136], nv)
    turned = phi * (1.0 / 6.283185307179586) * na
    cell = floor(turned)
    r = turned - cell
    k = cell - na * floor(cell / na)
    after = select(k >= na - 1.0, 0.0, k + 1.0)
    step = select(nv > 1.0, 1.0, 0.0 * nv)
    low = 0.0 * x
    high = low
    low_v = low
    high_v = low
    for side in range(2):
        row = (i + side) * nv
        near = (row + j) * na + 137.0
        far = (row + j + step) * na + 137.0
        a = pick(par, near + k) * (1.0 - r) + pick(par, near + after) * r
        b = pick(par, far + k) * (1.0 - r) + pick(par, far + after) * r
        if side == 0:
            low = a + q * (b - a)
            low_v = b - a
        else:
            high = a + q * (b - a)
            high_v = b - a
    dx = select(in_x, (high - low) * par[134], 0.0)
    dv = select(in_v, (low_v + p * (high_v - low_v)) * par[136], 0.0)
    return low + p * (high - low), dx, dv


@inline
def joined(code, a, b, da, db):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Derivative of the sum, difference, product, quotient, larger or smaller of two numbers by their derivatives."""
    slope = select(a > b, db, da)
    if code == 10:
        slope = da + db
    elif code == 11:
        slope = da - db
    elif code == 12:
        slope = da * b + a * db
    elif code == 13:
        slope = (da - a / b * db) / b
    elif code == 15:
        slope = select(a < b, db, da)
    return slope


@inline
def binary(code, ctx, at):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Replace the two topmost places by what the code makes of them."""
    a = ctx[at]
    b = guarded(ctx[at + 3]) if code == 13 else ctx[at + 3]
    for k in range(2):
        ctx[at + 1 + k] = joined(code, a, b, ctx[at + 1 + k], ctx[at + 4 + k])
    value = smaller(a, b)
    if code == 10:
        value = a + b
    elif code == 11:
        value = a - b
    elif code == 12:
        value = a * b
    elif code == 13:
        value = a / b
    elif code == 15:
        value = larger(a, b)
    ctx[at] = value


@inline
def push(code, number, x, v, ctx, par, at):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """A number, a variable or the table on top of the stack."""
    value = number
    dx = 0.0 * x
    dv = dx
    if code == 1:
        value = x
        dx = dx + 1.0
    elif code == 2:
        value = v
        dv = dv + 1.0
    elif code == 3:
        value = ctx[0]
    elif code == 40:
        value, dx, dv = table(x, v, ctx[0], par)
    ctx[at] = value
    ctx[at + 1] = dx
    ctx[at + 2] = dv


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """The law's force as resistance; all its work counts as supplied from outside."""
    x = u[0]
    v = ud[0]
    top = 1
    for i in range(uniform(par[0])):
        code = uniform(par[1 + i])
        if code < 4 or code == 40:
            push(code, par[65 + i], x, v, ctx, par, top)
            top += 3
        elif code < 20 and code != 14:
            top -= 3
            binary(code, ctx, top - 3)
        else:
            value, slope = unary(code, ctx[top - 3], par[65 + i])
            ctx[top - 3] = value
            ctx[top - 2] = slope * ctx[top - 2]
            ctx[top - 1] = slope * ctx[top - 1]
    f[0] = par[129] * ctx[1]
    if mode == 1:
        out[0] = par[129] * ctx[2]
        out[1] = par[129] * ctx[3]
    if mode == 2:
        out[0] = 0.0
        out[1] = 0.0
        out[2] = -f[0] * v
        out[3] = f[0]


KERNEL = kernel(prepare, force, same=(*range(65), 130, 131, 132))
