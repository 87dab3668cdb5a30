"""Many machines in one call on one core: speed, error, gain over one at a time; the price of each effect."""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial

import numpy as np

from bench.cases import CHANNELS, DURATION_S, FINE, RATE_HZ, START_S, Case, cases
from bench.single import best, settings
from jobs.demonstration import demonstration
from sim.core.errors import SidebandError
from sim.core.response import FloatArray, Response
from sim.core.spec import MachineSpec
from sim.solve.api import simulate
from sim.solve.ensemble import Member, simulate_many
from sim.solve.settings import Settings
from sim.terms import REGISTRY

MEMBERS = 64
LONG_S = 2.0
SPREAD = 0.1
CHECKED = 4
"""Members whose error is measured: the machine of the file, and others against fine solutions of our own."""
TERM_S = 0.5


@dataclass(frozen=True, kw_only=True)
class EnsembleTiming:
    """`factor`: simulated seconds of all members per core-second; `speedup` over single runs of the same machine."""

    factor: float
    error: float
    speedup: float


def varied(machine: MachineSpec, rng: np.random.Generator) -> MachineSpec:
    """The machine with stiffness and damping of its supports and every clearance changed by up to 10 %."""

    def factor() -> float:
        return float(rng.uniform(1.0 - SPREAD, 1.0 + SPREAD))

    data = machine.model_dump()
    for bearing in data["bearings"]:
        for name in ("stiffness_x_n_per_m", "stiffness_y_n_per_m", "damping_x_ns_per_m", "damping_y_ns_per_m"):
            bearing["support"][name] *= factor()
    for term in data["terms"]:
        if "gap" in term["parameters"]:
            term["parameters"]["gap"] *= factor()
    return MachineSpec.model_validate(data)


def members(case: Case, count: int = MEMBERS) -> list[Member]:
    """The case's machine and varied copies of it, all different."""
    rng = np.random.default_rng(7)
    return [Member(machine=case.machine)] + [Member(machine=varied(case.machine, rng)) for _ in range(count - 1)]


def _signals(found: Response | SidebandError) -> FloatArray:
    if isinstance(found, SidebandError):
        raise found
    return found.signals


def _error(case: Case, found: list[Response | SidebandError], all_members: list[Member]) -> float:
    samples = round(DURATION_S * RATE_HZ)
    first = round(START_S * RATE_HZ)
    worst = case.error(_signals(found[0])[:, :samples])
    fine = Settings(anti_alias=False, estimate_error=False, steps_per_output=FINE, rtol=1e-8)
    for k in range(1, CHECKED):
        exact = simulate(
            all_members[k].machine, duration_s=DURATION_S, output_rate_hz=RATE_HZ, channels=CHANNELS, settings=fine
        ).signals[:, first:]
        gap = np.linalg.norm(_signals(found[k])[:, first:samples] - exact, axis=1)
        worst = max(worst, float(np.max(gap / np.linalg.norm(exact, axis=1))))
    return worst


def ensemble() -> EnsembleTiming:
    """The lightly damped machine with clearance: assembly and operators of every member counted."""
    case = cases()[-1]
    every = members(case)
    arguments = {"output_rate_hz": RATE_HZ, "channels": CHANNELS, "settings": settings(1)}
    run = partial(simulate_many, every, duration_s=LONG_S, **arguments)  # type: ignore[arg-type]
    simulate_many(every[:8], duration_s=0.01, **arguments)  # type: ignore[arg-type]
    error = _error(case, run(), every)
    cost = best(run, 2) / (LONG_S * len(every))
    alone = best(partial(simulate, case.machine, duration_s=LONG_S, **arguments), 3) / LONG_S  # type: ignore[arg-type]
    return EnsembleTiming(factor=1.0 / cost, error=error, speedup=alone / cost)


@dataclass(frozen=True, kw_only=True)
class Price:
    """Cost of a run with an effect over that without it, one machine at a time and in lanes."""

    key: str
    machine: str
    single: float
    lanes: float


def prices() -> list[Price]:
    """Price of every registered effect on its own demonstration machine."""
    found = []
    chosen = Settings(estimate_error=False)
    for term in REGISTRY:
        if not term.params:
            continue
        shown = demonstration(term)
        times = []
        for machine in (shown.without, shown.machine):
            one = partial(simulate, machine, duration_s=TERM_S, output_rate_hz=20_000.0, settings=chosen)
            many = partial(
                simulate_many,
                [Member(machine=machine)] * 8,
                duration_s=TERM_S,
                output_rate_hz=20_000.0,
                settings=chosen,
            )
            times.append((best(one, 2), best(many, 2)))
        (a, b), (c, d) = times
        found.append(Price(key=term.key, machine=term.demo.machine, single=c / a, lanes=d / b))
    return found
