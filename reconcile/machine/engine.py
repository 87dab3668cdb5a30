"""All stages where the machine can be simulated: observe, calibrate, compare, nominate, refine, judge, validate."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace

from reconcile.atlas.bank import Mapper
from reconcile.atlas.candidates import Candidate, candidates
from reconcile.atlas.keep import Forgetful, Keeper, kept_bank
from reconcile.atlas.places import sensor_sites, simulated_channels, standard_channels
from reconcile.atlas.plan import AtlasPlan, atlas_plan, simulated_at, with_tooth_pairs
from reconcile.calibrate.uncertain import uncertain_numbers
from reconcile.faults import measurement_faults, with_faults
from reconcile.gate import inspect_measurement
from reconcile.gate.findings import Gate
from reconcile.gate.spoiled import without_spoiled
from reconcile.judge.changes import lenses, observed_changes
from reconcile.judge.space import Fitted
from reconcile.judge.turns import Turned
from reconcile.kinematics.unheard import with_unheard
from reconcile.machine.alone import rise_over_sound
from reconcile.machine.answer import answer, fault_answer, provenance
from reconcile.machine.assimilate import assimilated
from reconcile.machine.beaten import with_beaten
from reconcile.machine.beneath import beneath_a_tooth
from reconcile.machine.budget import QUICK, Budget
from reconcile.machine.by_turns import by_turns, clear, risen
from reconcile.machine.decide import remarkable, tempered, unmeasured
from reconcile.machine.decided import decided
from reconcile.machine.direct import direct_evidence
from reconcile.machine.drive import on_drive
from reconcile.machine.elsewhere import with_place
from reconcile.machine.estimated import with_force
from reconcile.machine.exchanged import with_exchanged
from reconcile.machine.faintest import faintest_seen
from reconcile.machine.foreign import with_foreign
from reconcile.machine.gate_orders import gate_orders
from reconcile.machine.grown import with_grown
from reconcile.machine.injected import placed_by_hearing
from reconcile.machine.left_lines import leaves_lines
from reconcile.machine.left_pairs import best_left_pair
from reconcile.machine.leftover import likelihoods
from reconcile.machine.library import Catalogued
from reconcile.machine.likelier import yielding
from reconcile.machine.local import around_baseline, told
from reconcile.machine.lone import with_lone, without_lone
from reconcile.machine.meter import Meter, Telling
from reconcile.machine.misfit import with_misfit
from reconcile.machine.mistaken import with_mistaken
from reconcile.machine.named_ripple import with_many_turns
from reconcile.machine.octave import doubted_speed, rival_speed
from reconcile.machine.pairs import Pairs, best_pair, named_pair
from reconcile.machine.pictures import as_named
from reconcile.machine.search import (
    broader,
    fit_views,
    located,
    nearest_effects,
    possible_seconds,
    refined,
    screen_atlas,
    to_fit,
)
from reconcile.machine.second import second_effect, strikes
from reconcile.machine.setting import Found, Setting
from reconcile.machine.short import with_short
from reconcile.machine.strange import explained_by, strange, with_strange
from reconcile.machine.suspected import of_a_sound_machine, of_the_sensor, without_suspected
from reconcile.machine.teeth_elsewhere import teeth_elsewhere
from reconcile.machine.told_by import teeth_tell
from reconcile.machine.turned import as_baselines_turned, told_apart, turned_alike, with_limits, with_unconfirmed
from reconcile.machine.unfitting import misfit_report, told_of
from reconcile.machine.unknown import Unknown, likely_supports, unknown_force
from reconcile.machine.wide import with_wide
from reconcile.observe.observation import PointData, observe, unpaired
from reconcile.observe.watch import watch_list
from reconcile.verdict import Report, operating_point
from signals.recording import Recording
from sim.core.spec import MachineSpec

Progress = Callable[[float, str], None]
ATLASES_BEGUN, ATLASES_DONE = 0.1, 0.6
"""Shares of a reconciliation between which atlases are made."""
CLOSER_LINES_P = 0.05
"""Chance of a change of single lines, on machines that agree with the baseline, from which candidates are asked."""


def _silent(_share: float, _stage: str) -> None:
    return None


def reconcile_machine(
    machine: MachineSpec,
    tests: Sequence[Recording],
    baselines: Sequence[Recording] = (),
    *,
    budget: Budget = QUICK,
    keeper: Keeper | None = None,
    mapper: Mapper = map,
    seed: int = 0,
    progress: Progress = _silent,
    nominated: Sequence[Candidate] | None = None,
) -> Report:
    """Reconcile recordings with a machine; SpecError says what cannot be done and why.

    `nominated` limits the effects considered; without it every registered effect at every site is a candidate.
    """
    meter = Meter(mapper)
    progress(0.0, "sensor gate")
    gate = _gate(machine, on_drive(machine, tests), on_drive(machine, baselines), seed)
    if not gate.usable:
        told_by = _told_by(meter, seed, budget)
        return with_faults(replace(fault_answer(gate, level="machine"), provenance=told_by), measurement_faults(gate))
    paired = with_tooth_pairs(machine)
    chosen = candidates(paired) if nominated is None else tuple(nominated)
    plan = atlas_plan(paired, uncertain_numbers(paired), chosen, seed=seed)
    asked = _Asked(machine=machine, plan=plan, budget=budget, keeper=keeper or Forgetful(), meter=meter, seed=seed)
    gate = as_baselines_turned(machine, without_spoiled(gate), seed)
    report = of_a_sound_machine(_reconciled(asked, gate, progress), gate)
    fewer = without_suspected(report, gate)
    if fewer is not None:
        report = of_the_sensor(report, _reconciled(asked, fewer, _silent), fewer)
    progress(1.0, "done")
    return with_faults(report, measurement_faults(gate), explained_by(report))


@dataclass(frozen=True, kw_only=True)
class _Asked:
    """What a reconciliation was asked with."""

    machine: MachineSpec
    plan: AtlasPlan
    budget: Budget
    keeper: Keeper
    meter: Meter
    seed: int


def _reconciled(asked: _Asked, gate: Gate, progress: Progress) -> Report:
    """All stages after the gate, on its recordings."""
    machine, budget, meter, seed = asked.machine, asked.budget, asked.meter, asked.seed
    channels = gate.tests[0].channels
    progress(0.05, "speed and features")
    data = observe(machine, watch_list(machine), sorted(gate.tests, key=_place), gate.baselines, seed=seed)
    factor = rival_speed(machine, data, channels)
    if factor is not None:
        return doubted_speed(factor, data, gate, _told_by(meter, seed, budget))
    fitting, elsewhere = teeth_elsewhere(machine, data, channels)
    if not fitting:
        return misfit_report(elsewhere, machine, data, gate, _told_by(meter, seed, budget))
    alike, apart = turned_alike(machine, fitting, channels)
    apart = (*unpaired(machine, gate.tests, gate.baselines), *(told_of(one, machine) for one in elsewhere), *apart)
    if not alike:
        return told_apart(apart, data, gate, _told_by(meter, seed, budget))
    setting = _setting(machine, gate, alike, asked.plan, asked.keeper, meter, progress)
    cost = {"until_atlas_core_s": meter.spent_s(), "budget": budget.name}
    progress(ATLASES_DONE, "candidates")
    looks = _answered(setting, screen_atlas(setting), budget, meter, progress)
    of_kind, setting, found = setting, looks.setting, looks.found
    progress(0.9, "laws that nobody listed")
    unknown = _force(setting, found, looks.pairs, budget, meter)
    progress(0.95, "held-out data")
    report = answer(setting, found, gate, meter, cost, looks.fit, unknown, looks.pairs)
    sensors = sensor_sites(looks.setting.machine, looks.setting.simulated)
    report = with_place(report, looks.setting.direct.evidence, len(looks.setting.data), sensors)
    report = with_foreign(with_exchanged(report, setting, found, channels), setting, channels)
    if report.verdict == "nothing_missing":
        report = replace(report, faintest=faintest_seen(of_kind, looks.atlas, looks.lines))
    report, heard = with_beaten(with_grown(report, machine)), looks.found.screen.heard
    report = with_mistaken(report, looks.setting, looks.by_families, channels, heard)
    report = with_misfit(report, looks.fit, machine)
    report = with_strange(report, strange(machine, alike, channels, gate.findings), machine, setting.direct.evidence)
    report = with_many_turns(report, looks.setting, [c.name for c in channels])
    supports = likely_supports(looks.setting, looks.found) if machine.bearings else ()
    report = with_force(report, looks.setting, supports, channels)
    report = with_lone(report, setting.lone)
    report = with_short(with_limits(with_unconfirmed(report, machine, alike), apart), alike, gate.findings)
    return as_named(with_wide(report))


def _told_by(meter: Meter, seed: int, budget: Budget) -> Mapping[str, object]:
    """Provenance where nothing was simulated."""
    return provenance(seed, 0, meter, {"budget": budget.name})


@dataclass(frozen=True, kw_only=True)
class _Looks:
    """What the candidates say (`found`), the setting it stands on, and how well machines agree with the baseline
    (`fit`); the look at all candidates on machines of the kind, and through the lines of those that agree; what stands
    beside the best effect (`pairs`)."""

    setting: Setting
    found: Found
    fit: Mapping[str, object]
    atlas: Found
    lines: Found | None
    pairs: Pairs | None = None

    @property
    def by_families(self) -> Fitted:
        """All candidates, in the setting."""
        return (self.lines or self.atlas).fitted


def _answered(setting: Setting, atlas: Found, budget: Budget, meter: Meter, progress: Progress) -> _Looks:
    """On machines of the kind (`atlas`), and where those or the single lines of machines that agree with the baseline
    show something, on such machines."""
    seen, turns = None, Turned()
    progress(0.62, "machines that agree with the baseline")
    local = around_baseline(setting, meter)
    closer, found = setting, atlas
    if local is not None:
        closer = replace(local.setting, overdispersion=atlas.fitted.overdispersion)
        (setting, atlas), (closer, seen) = without_lone((setting, atlas), (closer, fit_views(closer, atlas.known)))
        lines, turns = seen.screen.p_lines, risen(closer, seen.fitted)
        if not remarkable(atlas.screen) and lines > CLOSER_LINES_P and not clear(turns):
            quiet = replace(atlas, screen=replace(atlas.screen, p_lines=lines, p_turns=turns.p))
            return _Looks(setting=setting, found=quiet, fit=told(local), atlas=atlas, lines=seen)
        progress(0.7, "candidates on these machines")
        found = located(closer, atlas, setting, budget, meter, seen, possible_seconds(closer, seen))
    elif not remarkable(atlas.screen):
        quiet = replace(atlas, screen=unmeasured(atlas.screen))
        return _Looks(setting=setting, found=quiet, fit={}, atlas=atlas, lines=None)
    near = nearest_effects(atlas, setting.changes.observed)
    for turn in range(budget.rounds):
        progress(0.8 + 0.1 * turn / budget.rounds, "refining the best candidates")
        found = refined(closer, found, budget, meter, turn, near)
    if budget.broader and leaves_lines(
        found.screen.rest
    ):  # too few draws near the right size look like unknown physics
        found = broader(closer, found, atlas, setting, budget, meter)
        found = refined(closer, found, budget, meter, budget.rounds, near)
    progress(0.87, "machine and effect together")
    found = assimilated(closer, found, to_fit(closer, found, budget), budget.members, budget.assimilations, meter)
    based = setting.changes.with_baseline
    screen = tempered(found.screen, atlas.screen) if based else found.screen
    screen = screen if based and setting.machine.gears else unmeasured(screen)
    screen = replace(screen, struck=tuple(map(frozenset, setting.direct.struck)), silent=setting.direct.silent)
    if based and local is not None:
        screen = replace(screen, likelihoods=likelihoods(closer, found))
        screen = yielding(screen, found.views, closer.changes.observed)
        screen = beneath_a_tooth(screen, found.views, closer.changes.observed)
    fit = told(local) if local is not None else {}
    found = replace(found, screen=screen)
    if based and local is not None:
        found = replace(found, screen=placed_by_hearing(closer, found, meter))
        found = replace(found, screen=by_turns(closer, found, turns))
    progress(0.89, "two effects together")
    pairs = _paired(closer, found, atlas.known, budget, meter)
    return _Looks(setting=closer, found=found, fit=fit, atlas=atlas, lines=seen, pairs=pairs)


def _paired(setting: Setting, found: Found, atlas: Catalogued, budget: Budget, meter: Meter) -> Pairs | None:
    decision = decided(setting, found)
    if found.screen.by_turns or second_effect(setting, found, decision) is not None:
        return None
    first = decision.chosen[0] if decision.chosen else ""
    by_teeth = decision.word != "unknown_physics" and first and teeth_tell(setting, found, first)
    if first and (by_teeth or not strikes(first)):
        return best_left_pair(setting, found, decision, atlas, budget.members, budget.seconds, meter)
    return best_pair(setting, found, decision, budget.members, budget.pairs, meter)


def _force(setting: Setting, found: Found, pairs: Pairs | None, budget: Budget, meter: Meter) -> Unknown | None:
    decision, _ = named_pair(decided(setting, found), None, pairs)
    return unknown_force(setting, found, budget.supports, meter) if decision.word == "unknown_physics" else None


def _gate(machine: MachineSpec, tests: Sequence[Recording], baselines: Sequence[Recording], seed: int) -> Gate:
    own = gate_orders(machine)
    return with_unheard(
        inspect_measurement(
            baselines, tests, orders=own.other_meshes, mesh_orders=own.teeth, lowest_order=own.lowest, seed=seed
        )
    )


def _place(test: Recording) -> tuple[float, float]:
    """Tests in the order of their operating points, however they were given: draws depend on the order."""
    operating = test.operating
    return (operating.speed_hz, operating.torque_nm or 0.0) if operating is not None else (0.0, 0.0)


def _setting(
    machine: MachineSpec,
    gate: Gate,
    data: tuple[PointData, ...],
    plan: AtlasPlan,
    keeper: Keeper,
    mapper: Mapper,
    progress: Progress,
) -> Setting:
    recorded = gate.tests[0].channels
    simulated = simulated_channels(machine, recorded)
    distinct = standard_channels(machine, simulated)
    banks = []
    for k, one in enumerate(data):
        width = (ATLASES_DONE - ATLASES_BEGUN) / len(data)
        begun = ATLASES_BEGUN + k * width
        stage = f"atlas at {operating_point(one.point.speed_hz, one.point.torque_ratio)}"
        progress(begun, stage)
        telling = Telling(mapper, lambda share, a=begun, s=stage, w=width: progress(a + share * w, s))  # type: ignore[misc]
        bank = kept_bank(plan, simulated_at(machine, one.point), distinct, keeper=keeper, mapper=telling)
        banks.append(bank.at(range(len(plan.draws)), [distinct.index(s) for s in simulated]))
    seen = lenses(data, banks, plan)
    changes = observed_changes(data, seen, banks, plan)
    rise = rise_over_sound(changes, data, plan)
    return Setting(
        machine=machine,
        data=data,
        channels=tuple(c.name for c in recorded),
        simulated=simulated,
        plan=plan,
        banks=tuple(banks),
        seen_through=seen,
        changes=changes,
        seed=plan.seed,
        direct=direct_evidence(machine, data, recorded, seed=plan.seed, rise=rise),
    )
