"""What each way of answering says of every recording and of every window of ten turns."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from learn.assess import Assessment, answered, assess, estimated
from learn.detector import kinematic_detector
from learn.looked import Looked
from learn.model import Model
from learn.real.load import Case
from learn.speed import Speed
from signals.series import FloatArray

WINDOW_TURNS = 10.0
MOST_WINDOWS = 15


@dataclass(frozen=True, kw_only=True)
class Unit:
    """A recording, or a window of it."""

    case: Case
    channels: FloatArray
    window: int | None

    @property
    def kind(self) -> str:
        """`recording` or `window`."""
        return "recording" if self.window is None else "window"


@dataclass(frozen=True, kw_only=True)
class Answer:
    """What was said of a unit; `detail` for the table of failures, `levels` (dB) of the families by the detector."""

    unit: Unit
    label: str
    detail: str
    assessment: Assessment | None = None
    levels: Mapping[str, float] = field(default_factory=dict)


Way = Callable[[Unit], Answer]


def units(case: Case) -> list[Unit]:
    """The whole recording, then windows one after the other (at most fifteen, evenly spread)."""
    n = case.channels.shape[1]
    size = int(WINDOW_TURNS * case.rate_hz / case.speed_hz)
    starts = np.arange(0, n - size + 1, size)
    if starts.size > MOST_WINDOWS:
        starts = starts[np.linspace(0, starts.size - 1, MOST_WINDOWS).astype(int)]
    cut = [Unit(case=case, channels=case.channels[:, s : s + size], window=k) for k, s in enumerate(starts.tolist())]
    return [Unit(case=case, channels=case.channels, window=None), *(cut if n > 1.5 * size else [])]


def by_detector(unit: Unit) -> Answer:
    """The kinematic envelope detector, at the true speed and geometry; without a geometry it cannot say anything."""
    if unit.case.orders is None:
        return Answer(unit=unit, label="healthy", detail="no bearing known to look for")
    label, levels = kinematic_detector(list(unit.channels), unit.case.rate_hz, unit.case.speed_hz, unit.case.orders)
    return Answer(unit=unit, label=label, detail=", ".join(f"{k} {v:.0f} dB" for k, v in levels.items()), levels=levels)


@dataclass(frozen=True, kw_only=True)
class ByModel:
    """The model; `speed`: `given` (as measured), `near` (estimated from the stated one), `none` (estimated alone)."""

    model: Model
    geometry: bool = True
    speed: str = "given"

    def __call__(self, unit: Unit) -> Answer:
        """What it says of a unit."""
        case = unit.case
        orders = case.orders if self.geometry else None
        rows = list(unit.channels)
        found = Speed(speed_hz=case.speed_hz, method="given", standing=0.0)
        if self.speed != "given":
            found = estimated(rows, case.rate_hz, case.stated_hz if self.speed == "near" else None, orders)
        answer = assess(rows, case.rate_hz, found.speed_hz, self.model, orders, found.doubt, found.likely)
        return _answer(unit, answer, found.speed_hz)


def _answer(unit: Unit, answer: Assessment, speed_hz: float) -> Answer:
    shares = ", ".join(f"{k} {p:.2f}" for k, p in answer.probabilities.items())
    return Answer(unit=unit, label=answer.label, detail=f"{shares}; {speed_hz:.2f} Hz", assessment=answer)


def _of_case(case: Case, way: Way, windows: bool) -> list[Answer]:
    return [way(unit) for unit in units(case) if windows or unit.window is None]


def ask(cases: Sequence[Case], way: Way, *, windows: bool = True, pool: Executor | None = None) -> list[Answer]:
    """Answers on all units, recording by recording."""
    work = partial(_of_case, way=way, windows=windows)
    return [answer for part in (pool.map(work, cases) if pool is not None else map(work, cases)) for answer in part]


def _by_models(case: Case, models: Mapping[str, Model]) -> dict[str, list[Answer]]:
    found: dict[str, list[Answer]] = {name: [] for name in models}
    for unit in units(case):
        seen = Looked(
            channels=tuple(unit.channels), rate_hz=case.rate_hz, speed_hz=case.speed_hz, orders=case.orders, doubt=0.0
        )
        for name, model in models.items():
            found[name].append(_answer(unit, answered(seen, model), case.speed_hz))
    return found


def ask_models(
    cases: Sequence[Case], models: Mapping[str, Model], pool: Executor | None = None
) -> dict[str, list[Answer]]:
    """What several models answer at the speed and geometry given: each unit is looked at once."""
    work = partial(_by_models, models=models)
    parts = list(pool.map(work, cases) if pool is not None else map(work, cases))
    return {name: [answer for part in parts for answer in part[name]] for name in models}
