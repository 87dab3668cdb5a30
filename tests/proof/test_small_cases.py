"""Three concealed cases from file to verdict: hidden by the proof's own physics, answered by the engine.

A small atlas stands beside the tests (`tests/proof/atlas`), so that only what belongs to the case is simulated.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterator
from dataclasses import asdict
from pathlib import Path

import pytest

from proof import case as made
from proof.plan import SEEDS
from proof.score.one import Score, score
from reconcile.entry import reconcile_recordings
from reconcile.verdict import Report
from sim.core.spec import MachineSpec
from tests.proof.prebuilt import wanted as wanted_of
from tests.proof.remembered import Moved
from tests.proof.small import CASES, NOMINATED, nominal_machine, read_case
from tests.reconcile import prebuilt
from tests.reconcile.few import BUDGET, few_machines
from tests.reconcile.remembered import Simulated

pytestmark = [pytest.mark.slow, pytest.mark.long, pytest.mark.xdist_group("proof-small")]
FACTOR = {"broken_tooth": 1.5}
"""Within which a size must be."""
EXPLAINED = {name: case for name, case in CASES.items() if case.effects}
Answered = Callable[[str], tuple[Report, Score]]
TASKS = (-1,)
"""Of the atlas: the last, an effect on healthy machines."""


@pytest.fixture(scope="module")
def wanted(tmp_path_factory: pytest.TempPathFactory) -> prebuilt.Wanted:
    return wanted_of(nominal_machine(tmp_path_factory.mktemp("machine")))


@pytest.fixture(scope="module")
def atlas(wanted: prebuilt.Wanted, tmp_path_factory: pytest.TempPathFactory) -> prebuilt.Kept:
    why = prebuilt.stale(wanted)
    if why is not None:
        pytest.fail(why, pytrace=False)
    return prebuilt.kept([wanted], tmp_path_factory.mktemp("atlas"))


@pytest.fixture(scope="module", autouse=True)
def moved() -> Iterator[None]:
    with few_machines(), pytest.MonkeyPatch.context() as patched:
        patched.setattr(made, "accelerations", Moved())
        yield


@pytest.fixture(scope="module")
def simulated() -> Simulated:
    return Simulated()


@pytest.fixture
def answered(tmp_path: Path, atlas: prebuilt.Kept, simulated: Simulated) -> Answered:
    return lambda name: answer(name, tmp_path, atlas, simulated)


def answer(name: str, folder: Path, atlas: prebuilt.Kept, simulated: Simulated) -> tuple[Report, Score]:
    """Make the case, read it back as the engine's user would, reconcile, and score by the proof's own rules."""
    case = CASES[name]
    made.make(case, folder / "cases", folder / "truth")
    machine, tests, baselines = read_case(folder / "cases" / case.name)
    report = reconcile_recordings(
        machine, tests, baselines, budget=BUDGET, keeper=atlas, mapper=simulated, nominated=NOMINATED
    )
    truth = json.loads((folder / "truth" / f"{case.name}.json").read_text(encoding="utf-8"))
    return report, score(truth, json.loads(json.dumps(report.document())))


def test_there_are_at_most_six_and_none_of_a_split() -> None:
    assert len(CASES) <= 6
    assert not {c.seed for c in CASES.values()} & set(SEEDS.values())
    assert {c.group for c in CASES.values()} == {"null", "single", "sensor"}


def test_the_small_atlas_is_what_the_simulator_gives_today(wanted: prebuilt.Wanted, atlas: prebuilt.Kept) -> None:
    for task in TASKS:
        found = prebuilt.deviation_db(wanted, task)
        assert max(found.values()) < prebuilt.SAME_DB, f"the physics changed (dB: {found}): {prebuilt.REMAKE}"


def test_another_version_of_the_physics_names_the_command(
    wanted: prebuilt.Wanted, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(prebuilt, "PHYSICS_VERSION", "0.0.0")
    why = prebuilt.stale(wanted)
    assert why is not None and "is 0.0.0" in why and "make tests-atlas" in why


def test_nothing_hidden_is_nothing_missing(answered: Answered) -> None:
    report, _ = answered("nothing")
    assert report.verdict == "nothing_missing", report.sentence
    assert report.causes == () and report.machine is None and report.fault is None


@pytest.mark.parametrize("name", EXPLAINED)
def test_a_strong_effect_is_named_with_its_place_and_size(name: str, answered: Answered) -> None:
    (hidden,) = EXPLAINED[name].effects
    report, found = answered(name)
    said = (report.sentence, asdict(found))
    assert report.verdict == "explained", said
    assert found.mechanism and found.place, said
    cause = report.causes[0]
    assert (cause.named, cause.term, cause.site) == (True, hidden.about().terms[0], hidden.site)
    assert report.where.sites[0].site == hidden.site
    assert cause.severity is not None and cause.severity.unit == hidden.about().unit
    assert 1 / FACTOR[name] < cause.severity.value / hidden.value < FACTOR[name], said
    assert cause.severity.low <= hidden.value <= cause.severity.high, said
    assert report.machine is not None
    last = MachineSpec.model_validate(report.machine).terms[-1]
    assert (last.term, last.site) == (cause.term, cause.site)


def test_gaps_of_one_channel_are_a_fault_of_the_measurement(answered: Answered) -> None:
    report, found = answered("dropouts")
    assert report.verdict == "measurement_fault", report.sentence
    assert found.fault_kind and found.fault_channel, report.fault
    assert report.causes == () and report.machine is None
