"""Where an effect is plain to see: the machine that its declaration names, with and without it, and its lines."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

from sim.assembly.assemble import BUILT_IN, predicted_lines
from sim.core.lines import Line
from sim.core.spec import MachineSpec, TermSpec
from sim.core.terms import Term
from sim.presets import preset


@dataclass(frozen=True, kw_only=True)
class Demonstration:
    """A machine with the effect at `site` and where its declaration says `elsewhere`, and the same without.

    One machine and no site for a built-in effect.
    """

    machine: MachineSpec
    without: MachineSpec
    site: str
    values: Mapping[str, float]
    """All parameters, defaults written out."""


def demonstration(term: Term) -> Demonstration:
    """The demonstration that a term declares."""
    plain = term.demo.prepare(preset(term.demo.machine))
    values = term.values(term.demo.values, "demo")
    if term.key in BUILT_IN:
        return Demonstration(machine=plain, without=plain, site="", values=values)
    site = term.demo.site or _sites(plain, term)[0]
    acting = [
        TermSpec(term=term.key, site=where, parameters=dict(term.demo.values)) for where in (site, *term.demo.elsewhere)
    ]
    machine = plain.model_copy(update={"terms": [*plain.terms, *acting]})
    return Demonstration(machine=machine, without=plain, site=site, values=values)


def predicted(term: Term, shown: Demonstration) -> list[tuple[Line, float]]:
    """The effect's lines with their frequencies in Hz, the most telling first, each label once.

    An effect without lines of its own may change a rate, as cage slip does: then the lines that move are listed.
    """
    lines, bases = predicted_lines(shown.machine)
    own = [line for line in lines if line.mechanism == term.key]
    if not own:
        healthy = predicted_lines(shown.without)[1]
        moved = {base for base, hz in bases.items() if hz != healthy.get(base)}
        own = [line for line in lines if moved & {base for base, _ in line.orders}]
    found = {(line.label, line.family): line for line in reversed(own)}
    return [(line, line.frequency_hz(bases)) for line in reversed(found.values())]


def _sites(machine: MachineSpec, term: Term) -> list[str]:
    parts: Mapping[str, list[str]] = {
        "bearing": [b.name for b in machine.bearings],
        "gear": [g.name for g in machine.gears],
        "body": [b.name for b in machine.bodies],
        "mesh": [m.name for m in machine.meshes],
        "shaft": [s.name for s in machine.shafts],
    }
    return [name for kind in term.sites for name in parts[kind]]
