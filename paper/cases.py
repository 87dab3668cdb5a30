"""The machines of the study: preset, clearance variant, centre-distance form, run-out, clearance, speed."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Literal

from paper.changes import CHANGES
from sim.core.spec import MachineSpec, TermSpec
from sim.presets import preset

Form = Literal["printed", "true"]
PRESETS = ("paper", "paper-lightly-damped")
VARIANTS = ("fit_clearance", "fit_clearance_series")
FORMS: tuple[Form, ...] = ("printed", "true")
RUNOUT_M = 2e-5
COLLISION_DAMPING: Mapping[str, float] = {"paper": 2e5, "paper-lightly-damped": 2e3}
"""c_N, N*s/m: Table 1 for the preset as written, an engineering value for the lightly damped one."""
GAPS_UM = (1.0, 2.5, 5.0, 10.0, 15.0, 20.0, 25.0, 30.0, 35.0, 40.0, 45.0, 50.0)
SPEEDS_HZ = (10.0, 15.0, 20.0, 25.0, 30.0, 40.0, 50.0, 60.0)
SPEED_SWEEP_GAP_UM = 20.0


@dataclass(frozen=True, kw_only=True)
class Setting:
    """Everything that is the same along a sweep. `change` names an entry of `CHANGES` (sensitivity study)."""

    preset: str
    variant: str = "fit_clearance"
    form: Form = "printed"
    runout_m: float = 0.0
    change: str = ""


@dataclass(frozen=True, kw_only=True)
class Case:
    """One machine at one operating point. `gap_um` None: no clearance term at all (the healthy machine)."""

    setting: Setting
    gap_um: float | None
    speed_hz: float = 30.0


def machine(case: Case) -> MachineSpec:
    """The machine of a case."""
    setting = case.setting
    spec = preset(setting.preset)
    assert spec.operating is not None  # both presets turn
    terms = list(spec.terms)
    if case.gap_um is not None:
        values = {"gap": case.gap_um * 1e-6, "damping": COLLISION_DAMPING[setting.preset]}
        terms.append(TermSpec(term=setting.variant, site="bearing1", parameters=values))
    if setting.runout_m > 0:
        terms.append(TermSpec(term="eccentricity", site="pinion", parameters={"radius": setting.runout_m}))
    spec = spec.model_copy(
        update={
            "terms": terms,
            "meshes": [m.model_copy(update={"centre_distance_form": setting.form}) for m in spec.meshes],
            "operating": spec.operating.model_copy(update={"speed_hz": case.speed_hz}),
        }
    )
    spec = CHANGES[setting.change].apply(spec) if setting.change else spec
    return MachineSpec.model_validate(spec.model_dump())


def clearance_sweep(setting: Setting, gaps_um: tuple[float, ...] = GAPS_UM) -> tuple[Case, ...]:
    """The healthy machine, then growing clearance; zero gap (a rigid wall) only where it is another machine."""
    rigid = (0.0,) if setting.variant == "fit_clearance" else ()
    healthy = Case(setting=healthy_of(setting), gap_um=None)
    return (healthy, *(Case(setting=setting, gap_um=gap) for gap in (*rigid, *gaps_um)))


def healthy_of(setting: Setting) -> Setting:
    """The same machine without clearance has no clearance variant: one run serves both."""
    return replace(setting, variant="fit_clearance")


def speed_sweep(setting: Setting) -> tuple[Case, ...]:
    """20 um at every speed."""
    return tuple(Case(setting=setting, gap_um=SPEED_SWEEP_GAP_UM, speed_hz=hz) for hz in SPEEDS_HZ)


def all_settings() -> tuple[Setting, ...]:
    """Preset x variant x form x run-out."""
    return tuple(
        Setting(preset=p, variant=v, form=f, runout_m=r)
        for p in PRESETS
        for v in VARIANTS
        for f in FORMS
        for r in (0.0, RUNOUT_M)
    )
