"""The simulated statistics of one operating point: made draw by draw, kept as plain arrays."""

from __future__ import annotations

import io
from collections.abc import Callable, Iterable, Sequence
from dataclasses import dataclass, fields, replace

import numpy as np

from reconcile.atlas.plan import AtlasPlan, Draw, Point
from reconcile.atlas.run import RATE_HZ, SETTLE_S, SPAN_S, run_members
from reconcile.observe.extract import extract
from reconcile.observe.mean_turn import Turning
from reconcile.observe.slack import slack
from reconcile.observe.statistics import Bands, Statistics
from reconcile.observe.watch import WatchList, bases_at, watch_list
from signals.series import FloatArray
from sim.core.errors import SidebandError
from sim.core.response import Response

ARRAYS = ("line", "floor", "total", "band", "depth", "turn", "kurtosis", "skewness", "phase")


@dataclass(frozen=True, kw_only=True)
class Bank:
    """Statistics of every draw of a plan at one point; arrays have the draws in front: `line` (N, C, L) and so on.

    `alive` marks draws whose simulation ended well, shape (N,).
    """

    alive: np.ndarray
    line: FloatArray
    floor: FloatArray
    total: FloatArray
    band: FloatArray
    depth: FloatArray
    turn: FloatArray
    kurtosis: FloatArray
    skewness: FloatArray
    phase: FloatArray
    resolution_hz: float
    duration_s: float

    def at(self, draws: Sequence[int] | np.ndarray, channels: Sequence[int]) -> Bank:
        """Some draws and some channels."""
        pick = np.ix_(np.asarray(draws), np.asarray(channels))
        arrays = {name: getattr(self, name)[pick] for name in ARRAYS}
        return Bank(
            alive=self.alive[np.asarray(draws)],
            resolution_hz=self.resolution_hz,
            duration_s=self.duration_s,
            **arrays,
        )

    def to_bytes(self) -> bytes:
        """npz with single-precision arrays."""
        buffer = io.BytesIO()
        arrays = {f.name: np.asarray(getattr(self, f.name)) for f in fields(self)}
        stored = {k: v.astype(np.float32) if v.dtype == np.float64 and v.ndim else v for k, v in arrays.items()}
        np.savez_compressed(buffer, **stored)  # type: ignore[arg-type]
        return buffer.getvalue()

    @staticmethod
    def from_bytes(data: bytes) -> Bank:
        """Inverse of `to_bytes`."""
        with np.load(io.BytesIO(data), allow_pickle=False) as found:
            arrays = {name: found[name].astype(np.float64) for name in ARRAYS}
            return Bank(
                alive=found["alive"],
                resolution_hz=float(found["resolution_hz"]),
                duration_s=float(found["duration_s"]),
                **arrays,
            )


@dataclass(frozen=True, kw_only=True)
class Task:
    """Draws to simulate together: numbers into `plan.draws`."""

    plan: AtlasPlan
    draws: tuple[int, ...]
    point: Point
    channels: tuple[str, ...]


def _empty(channels: int, watched: WatchList) -> Statistics:
    lines, modulations = np.full(len(watched.lines), np.nan), np.full(len(watched.modulations), np.nan)
    nothing = np.zeros((channels, round((SPAN_S) * RATE_HZ)))
    return extract(
        nothing,
        RATE_HZ,
        lines_hz=lines,
        line_slack=lines,
        modulations_hz=modulations,
        modulation_slack=modulations,
        turning=tuple(Turning(hz=np.nan, teeth=teeth) for _, teeth in watched.gears),
        phased=watched.phased,
    )


@dataclass(frozen=True, kw_only=True)
class Sought:
    """What is measured at one speed: see `extract`. The same for all draws."""

    lines_hz: FloatArray
    line_slack: FloatArray
    modulations_hz: FloatArray
    modulation_slack: FloatArray
    turning: tuple[Turning, ...]
    phased: tuple[int, ...]
    bands: Bands


def sought(watched: WatchList, bases_hz: dict[str, float]) -> Sought:
    """Of a watch list, with these base frequencies, Hz."""
    lines, modulations = watched.line_hz(bases_hz), watched.modulation_hz(bases_hz)
    return Sought(
        lines_hz=lines,
        line_slack=slack(watched.lines, lines),
        modulations_hz=modulations,
        modulation_slack=slack(watched.modulations, modulations),
        turning=watched.turning(bases_hz),
        phased=watched.phased,
        bands=watched.bands(bases_hz),
    )


def measure(response: Response, what: Sought) -> Statistics:
    """Statistics of a simulation after its start."""
    first = round(SETTLE_S * response.sampling_rate_hz)
    return extract(
        np.asarray(response.signals[:, first:]),
        response.sampling_rate_hz,
        lines_hz=what.lines_hz,
        line_slack=what.line_slack,
        modulations_hz=what.modulations_hz,
        modulation_slack=what.modulation_slack,
        turning=what.turning,
        phased=what.phased,
        bands=what.bands,
    )


def run_task(task: Task) -> list[Statistics | None]:
    """Simulate and measure; None where a machine is impossible or its motion left all bounds."""
    watched = watch_list(task.plan.machine)
    what = sought(watched, bases_at(task.plan.machine, task.point.speed_hz))
    members = [task.plan.member(task.plan.draws[k], task.point) for k in task.draws]
    found = run_members(members, task.channels)
    lost = [k for k, r in enumerate(found) if isinstance(r, SidebandError) and task.plan.draws[task.draws[k]].beside]
    alone = [task.plan.member(replace(task.plan.draws[task.draws[k]], beside=()), task.point) for k in lost]
    for k, again in zip(lost, run_members(alone, task.channels), strict=True):
        found[k] = again
    return [measure(r, what) if isinstance(r, Response) else None for r in found]


def tasks(plan: AtlasPlan, point: Point, channels: tuple[str, ...], together: int = 16) -> list[Task]:
    """Draws grouped by effect and place, which make one structure, so that lanes fill."""
    groups: dict[tuple[str, ...], list[int]] = {}
    for k, draw in enumerate(plan.draws):
        groups.setdefault(_kind(draw), []).append(k)
    return [
        Task(plan=plan, draws=tuple(group[i : i + together]), point=point, channels=channels)
        for group in groups.values()
        for i in range(0, len(group), together)
    ]


def _kind(draw: Draw) -> tuple[str, ...]:
    """Effect and the places where it acts or would show nothing."""
    if draw.candidate is None:
        return ("",)
    return (draw.candidate.term, *sorted({draw.candidate.site, *(t.site for t in draw.beside)}))


Mapper = Callable[[Callable[[Task], list[Statistics | None]], Iterable[Task]], Iterable[list[Statistics | None]]]
"""`map` or a pool's ordered map."""


def make_bank(plan: AtlasPlan, point: Point, channels: tuple[str, ...], mapper: Mapper = map) -> Bank:
    """Simulate every draw of the plan at a point. Cost: about 0.1 core-second a draw."""
    todo = tasks(plan, point, channels)
    results: list[Statistics | None] = [None] * len(plan.draws)
    for task, found in zip(todo, mapper(run_task, todo), strict=True):
        for k, one in zip(task.draws, found, strict=True):
            results[k] = one
    return _bank(results, plan, channels)


def _bank(results: Sequence[Statistics | None], plan: AtlasPlan, channels: tuple[str, ...]) -> Bank:
    blank = next((r for r in results if r is not None), None) or _empty(len(channels), watch_list(plan.machine))
    arrays = {
        name: np.stack(
            [getattr(r, name) if r is not None else np.full_like(getattr(blank, name), np.nan) for r in results]
        )
        for name in ARRAYS
    }
    return Bank(
        alive=np.array([r is not None and bool(np.all(np.isfinite(r.band) | np.isnan(r.band))) for r in results]),
        resolution_hz=blank.resolution_hz,
        duration_s=blank.duration_s,
        **arrays,
    )
