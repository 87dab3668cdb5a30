"""Compiled helpers of a mesh of tooth pairs at one instant: what is reported, where `pair_kernels` feeds the solver.

Pairs come and go in jumps. For outputs that are filtered afterwards a pair's load is drawn with the band-limited step
of `band_limit` about either end of its path, so that the sampled load holds nothing that folds; energies and the
reported stiffness stay exact.
"""

from __future__ import annotations

from sim.core.choose import floor, larger, select, smaller, somewhere, uniform
from sim.core.compiled import inline
from sim.parts.band_limit import step_share
from sim.parts.mesh_kernels import row_position
from sim.parts.pair_kernels import pair_cut, pair_gap, pair_value, row_value, tilt_position


@inline
def turned_meanwhile(step, shafts, par):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Mesh cycles in the time over which jumps of reported loads are band-limited; 0 where they are not."""
    s = uniform(step[2])
    return par[5] * shafts[2 * s + 1] / 6.283185307179586 * step[3 + 2 * s + s * s]


@inline
def observed_pair(par, ctx, width, error, tilt, slot):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """(stiffness, gap, cut, 1 on the path, share of the load reported) of a pair at the instant of a context row.

    `slot`: 0 the pair that entered last, 3 the one three before it, 4 the one that enters next; `width` as
    `turned_meanwhile`. Beyond the path the pair keeps the stiffness of its end.
    """
    row = row_position(par, error)
    ratio = row_value(par, par[26], row)
    whole = floor(ctx[2])
    pair = whole + (1.0 if slot == 4 else -1.0 * slot)
    along = ctx[2] - pair
    left = ratio - along
    place = smaller(larger(along / ratio, 0.0), 1.0)
    inside = select((along >= 0.0) & (along / ratio < 1.0), 1.0, 0.0)
    share = inside
    near = (width > 0.0) & (smaller(larger(along, -along), larger(left, -left)) < 5.0 * width)
    if somewhere(near):
        span = larger(width, 1e-12)
        drawn = step_share(par, par[34], along / span) * step_share(par, par[34], left / span)
        share = select(near, drawn, inside)
    k = 0.0 * ratio
    if somewhere((inside > 0.0) | near):
        k = pair_value(par, row, tilt_position(par, tilt), place, pair)
    return k, pair_gap(par, pair), pair_cut(par, place, pair), inside, share


@inline
def pair_now(mode, par, ctx, width, error, tilt, slot):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """What `observed_pair` gives in mode 2; else the node values of a context row, with their whole load."""
    at = 8 + 3 * slot
    if mode == 2:
        return observed_pair(par, ctx, width, error, tilt, slot)
    whole = 1.0 + 0.0 * error
    return ctx[at], ctx[at + 1], ctx[at + 2], whole, whole


@inline
def pairs_now(mode):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201
    """Pairs to look at: the four of a step, in mode 2 also the one that comes next."""
    return 5 if mode == 2 else 4
