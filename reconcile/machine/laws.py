"""Force laws to try at the supports of a machine where no known effect is adequate, and the machines that have them."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace

import numpy as np

from reconcile.atlas.candidates import Candidate
from reconcile.atlas.plan import AtlasPlan, Draw
from sim.core.response import Response
from sim.core.spec import CustomLaw, MachineSpec, TermSpec
from sim.solve.api import simulate

OWN_LAW = "custom_force"
AXES = ("x", "y")
SHARES = (0.05, 0.15, 0.5, 1.5)
"""Force of a law over that of the support's spring, both root mean square in the healthy machine's motion."""
MACHINES = 1
"""Healthy machines a size is simulated on: formulas run one after the other, about two core-seconds each."""
MOTION_S = 0.4
RATE_HZ = 8192.0
STANDING = 1e-12
"""Motion, m, below which a support stands still and no law can act."""


@dataclass(frozen=True, kw_only=True)
class TrialLaw:
    """A law in the language of `custom_laws`; `{g}` is the dead zone. `rate`: it follows velocity."""

    key: str
    formula: str
    text: str
    unit: str
    """Of the coefficient."""
    rate: bool

    def values(self, x: np.ndarray, v: np.ndarray, gap: float) -> np.ndarray:
        """For a coefficient of 1, the same as the formula."""
        known = {
            "cubic": x**3,
            "dead_zone": np.maximum(x - gap, 0.0) + np.minimum(x + gap, 0.0),
            "viscous": v,
            "drag": np.abs(v) * v,
            "rate_free": np.sign(v) * np.abs(x),
        }
        return np.asarray(known[self.key])


LAWS = (
    TrialLaw(key="cubic", formula="x*x*x", text="z^3", unit="N/m^3", rate=False),
    TrialLaw(
        key="dead_zone", formula="(max(x-{g},0)+min(x+{g},0))", text="(|z| - {g})_+ sgn z", unit="N/m", rate=False
    ),
    TrialLaw(key="viscous", formula="v", text="dz/dt", unit="N s/m", rate=True),
    TrialLaw(key="drag", formula="abs(v)*v", text="|dz/dt| dz/dt", unit="N s^2/m^2", rate=True),
    TrialLaw(key="rate_free", formula="sign(v)*abs(x)", text="|z| sgn dz/dt", unit="N/m", rate=False),
)
"""Beside what the library has at supports: springs that grow, rates that differ, friction that follows the deflection
(hysteretic damping, N. O. Myklestad, J. Appl. Mech. 19 (1952) 284-286)."""


@dataclass(frozen=True, kw_only=True)
class Motion:
    """Of a support in the healthy machine: displacement, m, and velocity, m/s, (n,), both axes one after the other."""

    x: np.ndarray
    v: np.ndarray
    stiffness_n_per_m: float

    @property
    def gap_m(self) -> float:
        """Of the dead zone: the deviation of the displacement."""
        return float(np.std(self.x))

    def coefficient(self, law: TrialLaw, share: float) -> float:
        """That makes the law's force `share` of the spring's."""
        spring = self.stiffness_n_per_m * float(np.std(self.x))
        return share * spring / max(float(np.std(law.values(self.x, self.v, self.gap_m))), 1e-300)


def motions(machine: MachineSpec, sites: Sequence[str], seed: int) -> Mapping[str, Motion]:
    """How the supports move, both axes one after the other; those that stand still are left out."""
    channels = [f"{s}.outer.{axis}.{q}" for s in sites for axis in AXES for q in ("displacement", "velocity")]
    found: Response = simulate(machine, duration_s=MOTION_S, output_rate_hz=RATE_HZ, channels=channels, seed=seed)
    half = found.signals.shape[1] // 2
    rows = dict(zip(channels, found.signals[:, half:], strict=True))
    moving: dict[str, Motion] = {}
    for bearing in machine.bearings:
        if bearing.name not in sites or bearing.support is None:
            continue
        x, v = (
            np.concatenate([rows[f"{bearing.name}.outer.{axis}.{q}"] for axis in AXES])
            for q in ("displacement", "velocity")
        )
        if float(np.std(x)) > STANDING:
            stiffness = 0.5 * (bearing.support.stiffness_x_n_per_m + bearing.support.stiffness_y_n_per_m)
            moving[bearing.name] = Motion(x=x, v=v, stiffness_n_per_m=stiffness)
    return moving


def with_law(
    machine: MachineSpec, law: TrialLaw, site: str, motion: Motion, coefficient: float
) -> tuple[list[CustomLaw], list[TermSpec]]:
    """What a machine needs beside what it has, for the law on both axes of a support."""
    laws, terms = [], []
    formula = law.formula.format(g=f"{motion.gap_m:.6g}")
    for k, axis in enumerate(AXES, start=len(machine.custom_laws) + 1):
        expression = f"{coefficient:.6g}*{formula}"
        laws.append(CustomLaw(name=f"{law.key}_{axis}", dof=f"{site}.outer.{axis}", expression=expression))
        terms.append(TermSpec(term=OWN_LAW, site=site, parameters={"law": float(k)}))
    return laws, terms


def label(law: TrialLaw, site: str) -> str:
    """`drag@bearing4`."""
    return f"{law.key}@{site}"


def trial_plan(plan: AtlasPlan, moving: Mapping[str, Motion], law: TrialLaw, site: str) -> AtlasPlan:
    """Draws of one law at one support: all sizes on some of the plan's healthy machines.

    The laws of all sizes stand in the machine; each draw lets two of them act.
    """
    motion, laws, draws = moving[site], list(plan.machine.custom_laws), []
    base = plan.machine
    for j, share in enumerate(SHARES):
        machine = base.model_copy(update={"custom_laws": laws})
        own, terms = with_law(machine, law, site, motion, motion.coefficient(law, share))
        laws = [*laws, *(w.model_copy(update={"name": f"{w.name}{j}"}) for w in own)]
        for k in range(MACHINES):
            pair = (5 * j + 11 * k) % len(plan.offsets)
            draws.append(Draw(pair=pair, candidate=Candidate(term=OWN_LAW, site=site), term=terms[0], also=terms[1:]))
    return replace(plan, machine=base.model_copy(update={"custom_laws": laws}), draws=tuple(draws))
