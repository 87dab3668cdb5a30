"""A sampled input on one coordinate: a force, or the motion of a spring's far end, interpolated between its samples.

s(t) = sum of weights(fraction) * samples around t. The weights come from a table over the fraction of a step: held,
linear, or a sinc under a Kaiser window (Oppenheim & Schafer, Discrete-Time Signal Processing, 2nd ed., ch. 7),
each row scaled to sum 1 so that a constant stays one. A row lookup is linear in the fraction.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from sim.core.choose import floor, larger, pick, smaller, uniform
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.errors import Problem, SpecError
from sim.core.kernels import kernel
from sim.core.response import FloatArray
from sim.core.spec import BodySpec, GearSpec, MachineSpec, MeasuredLoad

CELLS = 256
"""Rows of the table over a step: linear lookup is within 2e-5 of the weights."""
HALF_TAPS = 12
WINDOW_BETA = 7.0
"""Kaiser window of 24 taps: content up to 0.35 of the sampling rate is kept within 0.1 %."""

Kind = Literal["hold", "linear", "band_limited"]


def _window(x: FloatArray) -> FloatArray:
    inside = np.clip(1.0 - (x / HALF_TAPS) ** 2, 0.0, None)
    return np.asarray(np.i0(WINDOW_BETA * np.sqrt(inside)) / np.i0(WINDOW_BETA))


def weights(kind: Kind) -> FloatArray:
    """Weights by fraction of a step, shape (CELLS + 1, taps): taps - 1 steps around, the middle two enclose t."""
    fraction = np.linspace(0.0, 1.0, CELLS + 1)[:, None]
    if kind == "hold":
        return np.hstack([np.ones_like(fraction), np.zeros_like(fraction)])
    if kind == "linear":
        return np.hstack([1.0 - fraction, fraction])
    distance = fraction - np.arange(1 - HALF_TAPS, HALF_TAPS + 1)[None, :]
    table = np.sinc(distance) * _window(distance)
    return np.asarray(table / table.sum(axis=1, keepdims=True))


def slopes(table: FloatArray) -> FloatArray:
    """Derivative of the weights by the fraction, same shape, by central differences."""
    return np.asarray(np.gradient(table, 1.0 / CELLS, axis=0))


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Force that the input adds at the nodes, N: the gains on s and s'."""
    taps = uniform(par[0])
    cells = par[1]
    last = par[2] - 1.0
    size = (cells + 1.0) * taps
    for i in range(uniform(step[2])):
        at = larger(smaller((step[0] + step[3 + i] * step[1]) * par[3], last), 0.0)
        first = floor(at)
        fine = (at - first) * cells
        cell = smaller(floor(fine), cells - 1.0)
        share = fine - cell
        row = 6.0 + cell * taps
        value = 0.0 * u[0]
        slope = value
        for k in range(taps):
            place = larger(smaller(first + (k + 1.0 - 0.5 * taps), last), 0.0)
            sample = pick(par, 6.0 + 2.0 * size + place)
            low = pick(par, row + k)
            value = value + (low + share * (pick(par, row + taps + k) - low)) * sample
            low = pick(par, row + size + k)
            slope = slope + (low + share * (pick(par, row + size + taps + k) - low)) * sample
        ctx[i] = par[4] * value + par[5] * slope


def force(mode, u, ud, ctx, par, f, out):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Minus the force (elements resist)."""
    f[0] = -ctx[0]
    if mode == 1:
        out[0] = 0.0
        out[1] = 0.0
    if mode == 2:
        out[0] = 0.0
        out[1] = 0.0
        out[2] = ctx[0] * ud[0]
        out[3] = ctx[0]


KERNEL = kernel(prepare, force, same=(0, 1, 2))


def sampled_element(load: MeasuredLoad, name: str, machine: MachineSpec) -> Element:
    """The element of a measured load; its output is the force on the body, N."""
    table = weights(load.interpolation)
    gain, rate_gain = load.factor, 0.0
    if load.quantity == "displacement":
        stiffness, damping = _mount(load, machine)
        gain, rate_gain = load.factor * stiffness, load.factor * damping / load.step_s
    head = (float(table.shape[1]), float(CELLS), float(len(load.values)), 1.0 / load.step_s, gain, rate_gain)
    return Element(
        name=name,
        site=load.body,
        kernel=KERNEL,
        coordinates=(Coordinate(name=name, unit="m", weights=((f"{load.body}.{load.axis}", 1.0),)),),
        forces=1,
        parameters=flat(*head, table, slopes(table), np.array(load.values)),
        context=1,
        shafts=("", ""),
        outputs=(Output(name="force", quantity="force", unit="N", axis=load.axis),),
        rates=False,
    )


def _mount(load: MeasuredLoad, machine: MachineSpec) -> tuple[float, float]:
    """Spring and damper to ground, N/m and N s/m, through which a motion enters."""
    parts: list[GearSpec | BodySpec] = [*machine.gears, *machine.bodies]
    part = next(p for p in parts if p.name == load.body)
    upright = load.axis == "y"
    stiffness = part.stiffness_y_n_per_m if upright else part.stiffness_x_n_per_m
    if stiffness == 0.0:
        message = "a measured displacement enters through the body's own spring to ground, which it does not have"
        field = f"bodies.{load.body}.stiffness_{load.axis}_n_per_m"
        raise SpecError(Problem(field=field, message=message, given=stiffness, allowed="above 0", unit="N/m"))
    return stiffness, part.damping_y_ns_per_m if upright else part.damping_x_ns_per_m
