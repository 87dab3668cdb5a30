"""The resistance as a specification: a body moved through a stiff spring, and a light slider behind the play."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from reconcile.driven.channels import FloatArray
from reconcile.driven.machine import Site, registered
from reconcile.driven.prescribed.fitting import Resisting
from reconcile.driven.prescribed.resistance import CUBIC, DRAG, DRY, STOPS, Motion, paths
from reconcile.force_law.library import FRICTION
from sim.core.spec import BodySpec, CustomLaw, ForceLoad, MachineSpec, MeasuredLoad, TermSpec

DRIVER = 2e3
"""Stiffness of the spring that moves the body, over the largest stiffness that resists it."""
SLIDER_HZ = 250.0
"""Natural frequency of the slider on its spring: far above the motion, so that its inertia does not count."""
SLIDER_DAMPING = 0.15
DRY_SPEED_SHARE = 0.02
"""Speed at which a slider's friction is developed, as a share of the fastest motion's."""
LEAST_PATH = 1e-3
"""Friction of a path over that of all, below which it is left out."""
HOLD = 1e-6
"""Spring that keeps the slider's place known, over its own."""
STEP_SHARE = 0.4
"""Longest step, over the time in which friction stops the slider."""
SLIDER = "slider"


@dataclass(frozen=True, kw_only=True)
class Built:
    """The machine, the channels whose sum is the force, and the longest step that the friction allows, s."""

    machine: MachineSpec
    channels: tuple[str, ...]
    longest_step_s: float


def _number(value: float) -> str:
    return f"{value:.9g}" if value >= 0 else f"({value:.9g})"


def _direct(found: Resisting) -> str:
    """What acts between the body and the ground without memory."""
    v = found.values
    text = f"{_number(v['stiffness'])}*x+{_number(v['damping'])}*v+{_number(v['offset'])}"
    extra = {
        DRY.key: f"+{_number(v.get('friction', 0.0))}*max(min(v/{v.get('speed', 1.0):.9g},1),-1)",
        STOPS.key: (
            f"+{_number(v.get('contact', 0.0))}"
            f"*(max(x-{_number(v.get('gap_up', 0.0))},0)+min(x+{_number(v.get('gap_down', 0.0))},0))"
        ),
        DRAG.key: f"+{_number(v.get('drag', 0.0))}*v*abs(v)",
        CUBIC.key: f"+{_number(v.get('cubic', 0.0))}*x^3",
    }
    return text + extra.get(found.structure.key, "")


def _path(v: Mapping[str, float], damping: float) -> str:
    """Play and spring between the body and the slider."""
    half = 0.5 * v.get("backlash", 0.0)
    elastic = _number(v["elastic"])
    text = f"{elastic}*(max(x-{half:.9g},0)+min(x+{half:.9g},0))+{damping:.9g}*v"
    return text + f"+{_number(v.get('slack', 0.0))}*max(min(x,{half:.9g}),-{half:.9g})" if half > 0 else text


@dataclass(frozen=True, kw_only=True)
class _Slider:
    """A light body, what rubs on it (a registered effect or a formula), a constant force N, and the longest step s."""

    body: BodySpec
    term: TermSpec | None
    formula: str
    constant_n: float
    longest_step_s: float


def _slider(v: Mapping[str, float], name: str, axis: str, fastest: float) -> _Slider:
    """Dry friction as the registered effect (solved within the step) where it is there and allows this force."""
    mass = max(v["elastic"] / (2 * math.pi * SLIDER_HZ) ** 2, 1e-6)
    spring = {f"stiffness_{axis}_n_per_m": HOLD * v["elastic"]}
    speed = DRY_SPEED_SHARE * fastest
    body = BodySpec.model_validate({"name": name, "mass_kg": mass, "axes": axis, **spring})
    term = registered(replace(FRICTION, shape=speed), v["friction"], Site(body=body, axis=axis))
    stopping = mass * speed / max(v["friction"], 1e-12)
    return _Slider(
        body=body,
        term=term,
        formula=f"{v['friction']:.9g}*max(min(v/{speed:.9g},1),-1)",
        constant_n=-v["friction"] * v.get("asymmetry", 0.0),
        longest_step_s=STEP_SHARE * stopping if term is None else math.inf,
    )


def built(site: Site, spec: MachineSpec, found: Resisting, motion: Motion, displacement: FloatArray) -> Built:
    """Machine whose body follows `displacement` (n,) m, and what to add up for the force."""
    fastest = float(np.max(np.abs(motion.velocity)))
    axis, name = site.axis, site.body.name
    acting = paths(found.values)
    acting = [p for p in acting if p["friction"] > LEAST_PATH * sum(q["friction"] for q in acting)]
    stiff = DRIVER * max(sum(p["elastic"] for p in acting), abs(found.values["stiffness"]), 1.0)
    mount = {f"stiffness_{axis}_n_per_m": stiff, f"damping_{axis}_ns_per_m": math.sqrt(stiff * site.body.mass_kg)}
    bodies = [BodySpec.model_validate({"name": name, "mass_kg": site.body.mass_kg, "axes": axis, **mount})]
    laws = [CustomLaw(name="direct", dof=site.dof, expression=_direct(found))]
    terms = [_own(name, 1)]
    loads: list[MeasuredLoad | ForceLoad] = []
    longest = math.inf
    for k, path in enumerate(acting):
        number = "" if len(acting) == 1 else f"_{k + 1}"
        slider = _slider(path, SLIDER + number, axis, fastest)
        longest = min(longest, slider.longest_step_s)
        damping = 2 * SLIDER_DAMPING * math.sqrt(path["elastic"] * slider.body.mass_kg)
        other = f"{slider.body.name}.{axis}"
        bodies.append(slider.body)
        laws.append(CustomLaw(name=f"path{number}", dof=site.dof, against=other, expression=_path(path, damping)))
        terms.append(_own(name, len(laws)))
        if slider.term is None:
            laws.append(CustomLaw(name=f"friction{number}", dof=other, expression=slider.formula))
        terms.append(slider.term or _own(slider.body.name, len(laws)))
        loads.append(
            ForceLoad.model_validate({"body": slider.body.name, "axis": axis, "constant_n": slider.constant_n})
        )
    load = MeasuredLoad.model_validate(
        {
            "body": name, "axis": axis, "quantity": "displacement", "step_s": motion.step_s,
            "values": tuple(float(x) for x in displacement),
        }
    )  # fmt: skip
    machine = MachineSpec(
        name=spec.name, notes=spec.notes, bodies=bodies, loads=[load, *loads], custom_laws=laws, terms=terms
    )
    channels = tuple(f"{name}.custom.{law.name}.force" for law in laws if not law.name.startswith("friction"))
    return Built(machine=machine, channels=channels, longest_step_s=STEP_SHARE * longest)


def _own(site: str, number: int) -> TermSpec:
    return TermSpec(term="custom_force", site=site, parameters={"law": float(number)})
