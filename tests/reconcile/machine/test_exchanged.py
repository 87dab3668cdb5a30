"""A baseline with a defect that the tests have not is told as an exchange; the right way round nothing is said."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.kinematics.families import Family
from reconcile.machine import exchanged
from reconcile.machine.direct import NOTHING
from reconcile.machine.exchanged import _turned_otherwise, with_exchanged
from reconcile.observe.observation import observe
from reconcile.observe.watch import bases_at, watch_list
from reconcile.report.action import to_do
from reconcile.verdict import Cause, Report, Word
from sim.core.spec import MachineSpec
from sim.presets import preset
from tests.reconcile.machine.test_direct import CHANNELS, SPEED_HZ, recording, sound, struck


def told(
    machine: MachineSpec,
    now: np.ndarray,
    before: np.ndarray,
    verdict: Word = "unknown_physics",
    causes: tuple[Cause, ...] = (),
) -> Report:
    data = observe(machine, watch_list(machine), [recording(now)], [recording(before)])
    setting = SimpleNamespace(machine=machine, data=data, direct=NOTHING, seed=0)
    report = Report(verdict=verdict, sentence="Something is missing.", level="machine", causes=causes)
    return with_exchanged(report, setting, simulated({}, np.zeros((0, 1))), CHANNELS)  # type: ignore[arg-type]


def simulated(groups: dict[str, tuple[int, ...]], changes: np.ndarray) -> SimpleNamespace:
    """What is known of effects."""
    return SimpleNamespace(known=SimpleNamespace(library=SimpleNamespace(groups=groups, changes=changes)))


@pytest.mark.parametrize(
    ("falls", "named", "says"),
    [
        ((-6.0, -5.0, 0.0, 0.0), True, True),
        ((-6.0, -5.0, 0.0, 0.0), False, False),
        ((-6.0, -0.5, 0.0, 0.0, 1.0), True, False),
        ((-2.5, -2.5, -2.5, -2.5), True, False),
        ((6.0, 6.0, 6.0, 6.0), True, False),
    ],
)
def test_what_a_named_effect_takes_away_as_it_is_simulated_is_no_exchange(
    monkeypatch: pytest.MonkeyPatch, falls: tuple[float, ...], named: bool, says: bool
) -> None:
    """Lines that fell by six deviations, where each draw of a loose pedestal makes them fall by so many."""
    name = "pedestal_looseness@bearing1"
    monkeypatch.setattr(exchanged, "depth_over_sound", lambda *_: lambda _, change: change[:, 0])
    setting = SimpleNamespace(changes=SimpleNamespace(observed=np.array([-6.0])), data=(), plan=None)
    found = simulated({name: tuple(range(len(falls)))}, np.array(falls)[:, None])
    cause = Cause(term="pedestal_looseness", site="bearing1", severity=None, score=20.0, named=named)
    report = Report(verdict="explained", sentence="", level="machine", causes=(cause,))
    family = Family(kind="outer", site="bearing3", order=2.6, spacing=0.0, sidebands=0, slip=0.02)
    assert exchanged.brought(report, setting, found, family) is says  # type: ignore[arg-type]


@pytest.mark.parametrize("fell", [0.2, 0.0, -1.9, -np.inf])
def test_bands_that_lost_nothing_explain_no_loss(monkeypatch: pytest.MonkeyPatch, fell: float) -> None:
    name = "pedestal_looseness@bearing1"
    monkeypatch.setattr(exchanged, "depth_over_sound", lambda *_: lambda _, change: change[:, 0])
    setting = SimpleNamespace(changes=SimpleNamespace(observed=np.array([fell])), data=(), plan=None)
    found = simulated({name: (0, 1)}, np.array([[-np.inf], [-9.0]]))
    cause = Cause(term="pedestal_looseness", site="bearing1", severity=None, score=20.0, named=True)
    report = Report(verdict="explained", sentence="", level="machine", causes=(cause,))
    family = Family(kind="outer", site="bearing3", order=2.6, spacing=0.0, sidebands=0, slip=0.02)
    assert not exchanged.brought(report, setting, found, family)  # type: ignore[arg-type]


@pytest.mark.slow
def test_an_exchange_is_told_with_what_to_do() -> None:
    machine = preset("paper-lightly-damped")
    hit = sound(2) + struck(bases_at(machine, SPEED_HZ)["f_o1"])
    report = told(machine, sound(1), hit)
    assert "bearing1.outer" in report.sentence and "exchanged, or a part replaced" in report.sentence
    assert report.where.limits and "which recording is which" in to_do(report)
    assert "exchanged" not in told(machine, hit, sound(1)).sentence
    assert "exchanged" not in told(machine, sound(1), sound(3)).sentence
    assert "exchanged" not in told(machine, sound(1), hit, "nothing_missing").sentence
    louder = 20.0 * np.random.default_rng(7).normal(size=hit.shape)
    assert "exchanged" not in told(machine, sound(1) + louder, hit).sentence, "the test has more than the baseline"


@pytest.mark.slow
@pytest.mark.parametrize(
    ("verdict", "term", "site", "named", "said"),
    [
        ("explained", "fit_clearance", "bearing1", True, False),
        ("explained", "fit_clearance", "bearing2", True, True),
        ("explained", "bearing_stiffness", "bearing1", True, True),
        ("ambiguous", "fit_clearance", "bearing1", False, True),
        ("unknown_physics", "fit_clearance", "bearing1", False, True),
    ],
)
def test_a_named_change_of_how_the_ring_is_held_explains_that_its_lines_are_gone(
    verdict: Word, term: str, site: str, named: bool, said: bool
) -> None:
    machine = preset("paper-lightly-damped")
    hit = sound(2) + struck(bases_at(machine, SPEED_HZ)["f_o1"])
    cause = Cause(term=term, site=site, severity=None, score=20.0, named=named)
    report = told(machine, sound(1), hit, verdict, (cause,))
    assert ("exchanged" in report.sentence) is said


@pytest.mark.slow
def test_beside_a_name_the_name_comes_first_in_what_to_do() -> None:
    machine = preset("paper-lightly-damped")
    hit = sound(2) + struck(bases_at(machine, SPEED_HZ)["f_o1"])
    named = (Cause(term="unbalance", site="pinion", score=9.0, named=True),)
    report = told(machine, sound(1), hit, "explained", named)
    assert "exchanged" in report.sentence
    assert to_do(report).startswith("inspect pinion") and "which recording is which" in to_do(report)


def test_what_turns_on_a_shaft_without_teeth_moves_the_load_and_its_lines() -> None:
    gearbox, rig = preset("paper-lightly-damped"), preset("bearing-rig")
    for machine, site, named, otherwise in (
        (rig, "disc", True, True),
        (rig, "disc", False, False),
        (rig, "fan_end", True, False),
        (gearbox, "pinion", True, False),
    ):
        causes = (Cause(term="unbalance", site=site, score=9.0, named=named),)
        report = Report(verdict="explained", sentence="", level="machine", causes=causes)
        assert _turned_otherwise(report, machine) == otherwise
