"""A sinusoidal or measured force on a body, as the loads of the specification list it (a shaker, a force channel)."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from sim.core.choose import uniform
from sim.core.elementary import sine_cosine
from sim.core.elements import Coordinate, Element, Output, flat
from sim.core.kernels import kernel
from sim.core.laws import Laws
from sim.core.spec import ForceLoad, MachineSpec, MeasuredLoad
from sim.core.terms import Demo, SiteContext, Term, Validation, Values
from sim.parts.sampled_load import sampled_element


def prepare(step, shafts, u, par, ctx):  # type: ignore[no-untyped-def]  # noqa: ANN001,ANN201,ARG001
    """Force at the nodes, N; the only element that follows time and not a shaft."""
    s = uniform(step[2])
    for i in range(s):
        sine, _ = sine_cosine(par[1] * (step[0] + step[3 + i] * step[1]) + par[2])
        ctx[i] = par[0] * sine


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


KERNEL = kernel(prepare, force)


@dataclass(frozen=True, kw_only=True)
class ForceLoads(Term):
    """See the module. Acts wherever the specification's loads say; it has no site of its own."""

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """One element a sinusoidal or measured load."""
        found = []
        for i, load in enumerate(site.machine.loads):
            name = f"load{i + 1}"
            if isinstance(load, MeasuredLoad):
                found.append(sampled_element(load, name, site.machine))
            if not isinstance(load, ForceLoad) or load.amplitude_n == 0.0:
                continue
            found.append(
                Element(
                    name=name,
                    site=load.body,
                    kernel=KERNEL,
                    coordinates=(Coordinate(name=name, unit="m", weights=((f"{load.body}.{load.axis}", 1.0),)),),
                    forces=1,
                    parameters=flat(load.amplitude_n, 2.0 * math.pi * load.frequency_hz, load.phase_rad),
                    context=1,
                    shafts=("", ""),
                    outputs=(Output(name="force", quantity="force", unit="N", axis=load.axis),),
                    rates=False,
                )
            )
        return found


def shaken(machine: MachineSpec) -> MachineSpec:
    """The machine pushed at a fifth of a natural frequency of 50 Hz or so."""
    load = ForceLoad(body=machine.bodies[0].name, axis="y", amplitude_n=10.0, frequency_hz=10.0)
    return machine.model_copy(update={"loads": [*machine.loads, load]})


TERM = ForceLoads(
    key="force_load",
    title="Sinusoidal force",
    sentence="A force of given amplitude and frequency pushes a body.",
    sites=(),
    params=(),
    references=("docs/conventions.md",),
    severity=None,
    order=10,
    demo=Demo(machine="oscillator", prepare=shaken, note="With a force of 10 N at 10 Hz."),
    validation=(
        Validation(
            kind="closed form",
            source="undamped oscillator under a sine from rest",
            deviation=1e-8,
            test="tests/sim/solve/test_closed_forms.py::test_sinusoidal_load_from_rest",
        ),
        Validation(
            kind="closed form",
            source="steady response to a sine that is known by three samples a period",
            deviation=1e-3,
            test="tests/sim/parts/test_sampled_load.py::test_three_samples_a_period_are_enough",
        ),
    ),
)
