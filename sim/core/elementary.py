"""Sine, exponential, logarithm and what follows from them, without branches: one source for a number and for lanes.

Coefficients: Taylor series where they are short enough (exponential), else the minimax polynomials of Cephes
(S. Moshier, Methods and Programs for Mathematical Functions, 1989: sin.c, log.c). Errors are below 4e-16 relative
(sine: absolute) over the ranges the kernels use; the tests measure them.
"""

from __future__ import annotations

import math

from sim.core.choose import exponent, larger, mantissa, nearest, power_of_two, select, size, smaller
from sim.core.compiled import inline

TURN = 2.0 * math.pi
LN2_HIGH, LN2_LOW = 6.93145751953125e-1, 1.42860682030941723212e-6
LOG2_E = 1.4426950408889634


@inline
def _sine_core(t):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
    """sin t for |t| <= pi / 4."""
    q = t * t
    p = 1.58962301576546568060e-10 * q - 2.50507477628578072866e-8
    p = p * q + 2.75573136213857245213e-6
    p = p * q - 1.98412698295895385996e-4
    p = p * q + 8.33333333332211858878e-3
    p = p * q - 1.66666666666666307295e-1
    return t + t * q * p


@inline
def _cosine_core(t):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN202
    """cos t for |t| <= pi / 4."""
    q = t * t
    p = -1.13585365213876817300e-11 * q + 2.08757008419747316778e-9
    p = p * q - 2.75573141792967388112e-7
    p = p * q + 2.48015872888517045348e-5
    p = p * q - 1.38888888888730564116e-3
    p = p * q + 4.16666666666665929218e-2
    return 1.0 - 0.5 * q + q * q * p


@inline
def sine_cosine(angle):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """(sin, cos) of an angle in rad; the angle's own rounding is the largest error."""
    turns = angle * (1.0 / TURN)
    turns = turns - nearest(turns)
    quarter = nearest(4.0 * turns)
    t = (turns - 0.25 * quarter) * TURN
    s = _sine_core(t)
    c = _cosine_core(t)
    swap = (quarter == 1.0) | (quarter == -1.0)
    first = select(swap, c, s)
    second = select(swap, s, c)
    back = (quarter == 2.0) | (quarter == -2.0)
    first = select((quarter == -1.0) | back, -first, first)
    second = select((quarter == 1.0) | back, -second, second)
    return first, second


@inline
def exponential(x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """e^x, clamped to -708 <= x <= 709."""
    x = smaller(larger(x, -708.0), 709.0)
    n = nearest(x * LOG2_E)
    r = (x - n * LN2_HIGH) - n * LN2_LOW
    p = 1.0 / 6227020800.0 * r + 1.0 / 479001600.0
    p = p * r + 1.0 / 39916800.0
    p = p * r + 1.0 / 3628800.0
    p = p * r + 1.0 / 362880.0
    p = p * r + 1.0 / 40320.0
    p = p * r + 1.0 / 5040.0
    p = p * r + 1.0 / 720.0
    p = p * r + 1.0 / 120.0
    p = p * r + 1.0 / 24.0
    p = p * r + 1.0 / 6.0
    p = p * r + 0.5
    p = p * r + 1.0
    return (p * r + 1.0) * power_of_two(n)


@inline
def logarithm(x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Natural logarithm of a normal positive number."""
    m = mantissa(x)
    e = exponent(x)
    high = m > 1.4142135623730951
    m = select(high, 0.5 * m, m)
    e = select(high, e + 1.0, e)
    t = m - 1.0
    q = t * t
    p = 1.01875663804580931796e-4 * t + 4.97494994976747001425e-1
    p = p * t + 4.70579119878881725854
    p = p * t + 1.44989225341610930846e1
    p = p * t + 1.79368678507819816313e1
    p = p * t + 7.70838733755885391666
    d = t + 1.12873587189167450590e1
    d = d * t + 4.52279145837532221105e1
    d = d * t + 8.29875266912776603211e1
    d = d * t + 7.11544750618563894466e1
    d = d * t + 2.31251620126765340583e1
    y = t * (q * p / d)
    y = y - e * 2.121944400546905827679e-4 - 0.5 * q
    return (t + y) + e * 0.693359375


@inline
def ninth_root_power(x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """x^(10/9) of a positive number: the load law of a line contact."""
    return x * exponential(logarithm(x) * (1.0 / 9.0))


@inline
def hyperbolic_tangent(x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """tanh x, absolute error below 3e-16."""
    t = exponential(-2.0 * size(x))
    y = (1.0 - t) / (1.0 + t)
    return select(x < 0.0, -y, y)


@inline
def arctangent(x):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Angle of a slope, rad; Cephes atan.c without its low-order correction, absolute error below 4e-16."""
    a = size(x)
    steep = a > 2.414213562373095
    middle = (a > 0.66) & ~steep
    t = select(steep, -1.0 / larger(a, 1e-300), select(middle, (a - 1.0) / (a + 1.0), a))
    base = select(steep, 1.5707963267948966, select(middle, 0.7853981633974483, 0.0))
    q = t * t
    p = -8.750608600031904122785e-1 * q - 1.615753718733365076637e1
    p = p * q - 7.500855792314704667340e1
    p = p * q - 1.228866684490136173410e2
    p = p * q - 6.485021904942025371773e1
    d = q + 2.485846490142306297962e1
    d = d * q + 1.650270098316988542046e2
    d = d * q + 4.328810604912902668951e2
    d = d * q + 4.853903996359136964868e2
    d = d * q + 1.945506571482613964425e2
    y = base + (t * (q * p / d) + t)
    return select(x < 0.0, -y, y)
