"""The contract of a physical effect: declared once, used by the simulator, the labels, the forms and the fits."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Literal

import numpy as np

from sim.core.elements import Element
from sim.core.errors import Problem, SpecError
from sim.core.laws import Laws
from sim.core.lines import Line
from sim.core.params import Param
from sim.core.spec import MachineSpec

SiteKind = Literal["bearing", "gear", "body", "mesh", "shaft"]
Values = Mapping[str, float]
FAINT = 1e-7
"""Share of a size that nothing shows: the motion then differs by less than 1e-4, the steps' own error."""


@dataclass(frozen=True, kw_only=True)
class SiteContext:
    """What a term may know when it acts: the machine, the site, base frequencies, shafts' speeds and a seed."""

    machine: MachineSpec
    site: str
    shaft: str
    shaft_base: str
    """Base name of the site's shaft speed, `f_r1`."""
    index: int
    """1-based number of the site among its kind: `bearing1` -> 1."""
    speed_hz: float
    bases_hz: Mapping[str, float]
    seed: int = 0
    sense: float = 1.0
    """Sense in which the site turns, a bearing's inner ring and cage or a gear's run-out: +1 x to y, -1 y to x."""

    def random(self, key: str) -> np.random.Generator:
        """A generator that depends on the seed, the site and `key` only."""
        text = f"{key}@{self.site}".encode()
        return np.random.default_rng([self.seed, *text])


def _as_it_is(machine: MachineSpec) -> MachineSpec:
    return machine


@dataclass(frozen=True, kw_only=True)
class Demo:
    """Where an effect is plain to see: its first `leading` lines stand out there against the machine without it.

    `machine` names a preset; `site` is empty for the first one where the effect may act; `values` replace defaults.
    `elsewhere` lists further sites with the same effect. `prepare` changes the machine where no preset has what the
    effect needs, and `note` says how. `falls`: the effect takes its lines away instead of raising them.
    """

    machine: str = "paper-lightly-damped"
    site: str = ""
    elsewhere: tuple[str, ...] = ()
    values: Values = field(default_factory=dict)
    leading: int = 3
    falls: bool = False
    note: str = ""
    prepare: Callable[[MachineSpec], MachineSpec] = _as_it_is


@dataclass(frozen=True, kw_only=True)
class Validation:
    """A check of an effect against something that is not its own code.

    `kind`: closed form, published table, independent calculation, or measurement. `deviation` is the largest relative
    difference the named test allows, and it must be measured: tests compare what they find with `deviation`.
    """

    kind: Literal["closed form", "published table", "independent calculation", "measurement"]
    source: str
    deviation: float
    test: str
    """`tests/sim/terms/test_x.py::test_name`."""


@dataclass(frozen=True, kw_only=True)
class Term:
    """Base of all effects. Subclasses override what they need; everything is a pure function.

    Composition order is `order` (small first); terms at equal order commute.
    """

    key: str
    title: str
    sentence: str
    sites: tuple[SiteKind, ...]
    params: tuple[Param, ...]
    references: tuple[str, ...]
    severity: str | None
    """Name of the parameter that measures the size of the effect; zero of it changes nothing when `zero_is_healthy`."""
    zero_is_healthy: bool = True
    passive: bool = False
    """Never adds energy to the machine."""
    order: int = 100
    excludes: tuple[str, ...] = field(default=())
    """Keys that cannot act at the same site."""
    strikes: Literal["outer", "inner", "ball", "tooth"] | None = None
    """The part whose every passage gives an impact, for local defects; none for what acts all the time."""
    damage: bool = False
    """A defect that no sound machine has, though it does not strike; what `strikes` is one anyway."""
    wear: bool = False
    """Play, a loose seat, a bend, a force of one's own: a sound machine has little of it, and much is a fault."""
    lasting: bool = False
    """A machine has it from its first day or never: it does not come between a baseline and a later recording."""
    repeats: str | None = None
    """Parameter that tells several effects of this kind at one site apart; none: one a site."""
    demo: Demo = field(default_factory=Demo)
    validation: tuple[Validation, ...] = ()

    @property
    def damages(self) -> bool:
        """Whether a machine that has it is no sound one, however small it is."""
        return self.damage or self.strikes is not None

    def values(self, given: Values, where: str) -> dict[str, float]:
        """Fill defaults and check bounds; SpecError lists every field that is wrong."""
        known = {p.name: p for p in self.params}
        problems: list[Problem] = []
        for name, value in given.items():
            if name not in known:
                problems.append(
                    Problem(
                        field=f"{where}.{name}",
                        message=f"unknown parameter of {self.key}",
                        given=name,
                        allowed=", ".join(known),
                    )
                )
            elif (problem := known[name].problem(value, f"{where}.{name}")) is not None:
                problems.append(problem)
        if problems:
            raise SpecError(problems)
        return {p.name: float(given.get(p.name, p.default)) for p in self.params}

    def machine_values(self, machine: MachineSpec, site: str) -> Values:  # noqa: ARG002
        """Parameters the machine itself gives at a site; what the term is given goes before them."""
        return {}

    def centre_play_m(self, values: Values) -> float:  # noqa: ARG002
        """How far the effect moves the shaft's centre at its site, m, or lets it move: sizes the meshes' tables."""
        return 0.0

    def modify(self, laws: Laws, values: Values, site: SiteContext) -> Laws:  # noqa: ARG002
        """Return the laws as this effect changes them."""
        return laws

    def elements(self, laws: Laws, values: Values, site: SiteContext) -> Sequence[Element]:  # noqa: ARG002
        """Return the contact or excitation elements this effect adds."""
        return ()

    def lines(self, values: Values, site: SiteContext) -> Sequence[Line]:  # noqa: ARG002
        """Return the spectral lines this effect predicts, the most telling first."""
        return ()

    def idle(self, values: Values) -> bool:
        """Whether these values leave the machine as it is: assembly then passes the effect over."""
        return self.severity is not None and self.zero_is_healthy and values[self.severity] == 0.0

    def faint(self, values: Values) -> Values | None:
        """Values of the same structure that change nothing to speak of, so that machines with the effect at other
        sites run beside this one; None where there are none."""
        if self.severity is None or not self.zero_is_healthy:
            return None
        return {**values, self.severity: FAINT * values[self.severity]}

    def cautions(self, values: Values, site: SiteContext) -> Sequence[str]:  # noqa: ARG002
        """Return sentences about values that are allowed but hardly meant, with the numbers in them."""
        return ()


class Registry:
    """Terms by key."""

    def __init__(self, terms: Sequence[Term]) -> None:
        self._terms: dict[str, Term] = {}
        for term in terms:
            if term.key in self._terms:
                raise ValueError(f"two terms named {term.key!r}")
            self._terms[term.key] = term

    def __iter__(self):  # type: ignore[no-untyped-def]  # noqa: ANN204
        return iter(self._terms.values())

    def keys(self) -> tuple[str, ...]:
        """Registered keys, in order."""
        return tuple(self._terms)

    def get(self, key: str) -> Term | None:
        """The term, or None."""
        return self._terms.get(key)
