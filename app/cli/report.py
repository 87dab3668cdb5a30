"""What a machine amounts to: derived values, natural frequencies, defect orders, base frequencies, warnings."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from sim.assembly.assemble import assemble
from sim.assembly.modes import natural_frequencies_hz
from sim.core.spec import MachineSpec
from sim.core.system import System
from sim.parts.bearing import defect_orders, geometry_from_spec
from sim.solve.step_choice import base_rate_hz

Report = dict[str, object]


def machine_report(machine: MachineSpec, notes: Mapping[str, str], warnings: Sequence[str]) -> Report:
    """JSON-ready report; SpecError when the machine is impossible. `notes`, `warnings`: of its making, if any."""
    system = assemble(machine)
    return {
        "machine": machine.name,
        "degrees_of_freedom": len(system.dofs),
        "from_parameters": dict(notes),
        "derived": dict(system.derived),
        "natural_frequencies_hz": [float(f) for f in natural_frequencies_hz(system)],
        "frequencies": dict(system.bases_hz),
        "defect_orders": _orders(machine),
        "terms": [term.model_dump(mode="json") for term in machine.terms],
        "step_rate_hz": base_rate_hz(system),
        "channels": [channel.name for channel in system.channels],
        "warnings": _warnings(system, warnings),
    }


def _warnings(system: System, more: Sequence[str]) -> list[str]:
    # The same sentence from the table's making and from assembly is one warning.
    return list(dict.fromkeys([*more, *system.warnings]))


def _orders(machine: MachineSpec) -> dict[str, dict[str, float]]:
    """Orders of the carrying shaft: FTF, BPFO, BPFI, BSF."""
    found = {}
    for bearing in machine.bearings:
        orders = defect_orders(geometry_from_spec(bearing, field=f"bearings.{bearing.name}"))
        found[bearing.name] = {
            "ftf": orders.cage,
            "bpfo": orders.outer_pass,
            "bpfi": orders.inner_pass,
            "bsf": orders.ball_spin,
        }
    return found


def report_text(report: Mapping[str, object]) -> str:
    """The report for a person."""
    lines = [f"{report['machine']}: {report['degrees_of_freedom']} degrees of freedom"]
    lines += _block("from the parameters", _mapping(report["from_parameters"]))
    lines += _block("given and derived", _mapping(report["derived"]))
    lines += _block("frequencies, Hz", {k: _number(v) for k, v in _mapping(report["frequencies"]).items()})
    lines += _block(
        "defect orders of the carrying shaft",
        {
            n: "  ".join(f"{k} {_number(v)}" for k, v in _mapping(o).items())
            for n, o in _mapping(report["defect_orders"]).items()
        },
    )
    natural = [_number(f) for f in _sequence(report["natural_frequencies_hz"])]
    lines += ["natural frequencies, Hz:", *(f"  {'  '.join(natural[i : i + 8])}" for i in range(0, len(natural), 8))]
    terms = {
        f"{_mapping(t)['term']}@{_mapping(t)['site']}": _parameters(_mapping(t)) for t in _sequence(report["terms"])
    }
    lines += _block("effects", terms)
    lines += [f"warning: {warning}" for warning in _sequence(report["warnings"])]
    return "\n".join(lines)


def _block(title: str, entries: Mapping[str, object]) -> list[str]:
    if not entries:
        return []
    width = max(map(len, entries))
    return [f"{title}:", *(f"  {key:<{width}}  {value}" for key, value in entries.items())]


def _parameters(term: Mapping[str, object]) -> str:
    return ", ".join(f"{k} = {_number(v)}" for k, v in _mapping(term["parameters"]).items())


def _number(value: object) -> str:
    return f"{value:.6g}" if isinstance(value, int | float) else str(value)


def _mapping(value: object) -> Mapping[str, object]:
    return value if isinstance(value, Mapping) else {}


def _sequence(value: object) -> Sequence[object]:
    return value if isinstance(value, list | tuple) else ()
