"""An effect too faint to show leaves the motion as it was, with the structure of the effect at its full size."""

from __future__ import annotations

import numpy as np
import pytest

from reconcile.atlas.candidates import FREE, candidates
from sim.assembly.assemble import assemble
from sim.core.spec import MachineSpec, TermSpec
from sim.core.terms import FAINT, Term
from sim.presets import preset
from sim.solve.api import simulate
from sim.solve.ensemble import structure
from sim.solve.settings import Settings
from sim.terms import REGISTRY

WITHOUT = ("backlash", "fit_clearance", "fit_clearance_series")
"""Next to no play is a wall, or a flank, that is always met; without the effect there is none."""
SIZED = [t for t in REGISTRY if t.severity is not None and t.key not in (*WITHOUT, *FREE)]
SPAN_S = 0.04


def given(term: Term) -> tuple[MachineSpec, TermSpec]:
    """The effect's demonstration: machine without it, and the effect."""
    machine = term.demo.prepare(preset(term.demo.machine))
    first = next((c.site for c in candidates(machine) if c.term == term.key), "")
    values = {p.name: p.default for p in term.params} | dict(term.demo.values)
    values |= dict(term.machine_values(machine, term.demo.site or first))
    if values.get(term.severity or "") == 0.0:
        values[str(term.severity)] = 1e-6
    return machine, TermSpec(term=term.key, site=term.demo.site or first, parameters=values)


def moved(machine: MachineSpec) -> np.ndarray:
    settings = Settings(rtol=1e-5, estimate_error=False)
    return simulate(machine, duration_s=SPAN_S, output_rate_hz=20480.0, settings=settings).signals


@pytest.mark.slow
@pytest.mark.parametrize("key", [t.key for t in SIZED])
def test_a_faint_effect_changes_nothing_but_the_structure(key: str) -> None:
    term = REGISTRY.get(key)
    assert term is not None
    machine, full = given(term)
    values = term.faint(full.parameters)
    assert values is not None
    faint = full.model_copy(update={"parameters": dict(values)})
    sound, with_faint, with_full = (
        machine.model_copy(update={"terms": [*machine.terms, *more]}) for more in ([], [faint], [full])
    )
    assert structure(assemble(with_faint)) == structure(assemble(with_full))
    rest, shown = moved(sound), moved(with_faint)
    assert np.max(np.abs(shown - rest)) < 1e-3 * np.max(np.abs(rest))


def test_play_has_no_faint_form() -> None:
    for key in WITHOUT:
        term = REGISTRY.get(key)
        assert term is not None and term.faint({p.name: p.default for p in term.params}) is None


def test_the_share_is_far_below_what_a_step_resolves() -> None:
    assert 0.0 < FAINT < 1e-5
