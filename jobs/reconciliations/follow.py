"""Progress at the level of kinematics, whose engine reports nothing: where it stands is read off its call stack.

A thread beside it looks a few times a second. Stages are the engine's own functions, so a renamed one does not load.
"""

from __future__ import annotations

import contextlib
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from types import CodeType, FrameType
from typing import Any

from jobs.reporter import Reporter
from reconcile.gate import inspect_measurement
from reconcile.kinematics.doubted import against_rivals
from reconcile.kinematics.elsewhere import told_elsewhere
from reconcile.kinematics.gears import gear_evidence
from reconcile.kinematics.judge import named
from reconcile.kinematics.observe import observe
from reconcile.kinematics.remarks import remarked
from reconcile.unsteady import unsteady
from sim.core.errors import SidebandError

LOOK_S, TELL_S = 0.1, 1.0
"""Between two looks, and between two reports within a stage."""
SAMPLE_S = 6e-6
"""Core-seconds a sample, until a stage has ended and tells better; measured with 0.4 million samples."""


@dataclass(frozen=True, kw_only=True)
class Stage:
    """A function of the engine: what it is called for people, and the share of the whole at which it begins."""

    work: Callable[..., Any]
    name: str
    begin: float

    @property
    def code(self) -> CodeType:
        """What a frame of the function runs."""
        code: CodeType = self.work.__code__
        return code


STAGES = (
    Stage(work=unsteady, name="held speed", begin=0.0),
    Stage(work=inspect_measurement, name="sensor gate", begin=0.4),
    Stage(work=observe, name="speed and features", begin=0.5),
    Stage(work=named, name="lines of bearings", begin=0.6),
    Stage(work=gear_evidence, name="teeth, shafts and impacts", begin=0.7),
    Stage(work=told_elsewhere, name="other speeds", begin=0.8),
    Stage(work=against_rivals, name="other speeds", begin=0.8),
    Stage(work=remarked, name="held-out data", begin=0.9),
)
"""In the order in which they come; a later round of an earlier one is part of the later stage."""


class Pace:
    """From the stage that is seen at a time to the share of the whole and the time left, s; never back."""

    def __init__(self, stages: Sequence[Stage], *, expected_s: float) -> None:
        self._stages, self._whole_s, self._place = stages, max(expected_s, TELL_S), -1

    @property
    def begun(self) -> bool:
        """Whether any stage was seen."""
        return self._place >= 0

    @property
    def name(self) -> str:
        """Of the furthest stage that was reached."""
        return self._stages[self._place].name

    def seen(self, place: int, elapsed_s: float) -> bool:
        """Whether a stage begins that was not reached before; its share tells how long the whole takes."""
        if place <= self._place:
            return False
        self._place, begin = place, self._stages[place].begin
        self._whole_s = max(elapsed_s / begin, elapsed_s) if begin > 0 else self._whole_s
        return True

    def at(self, elapsed_s: float) -> tuple[float, float]:
        """The share, held between the bounds of the stage, and the time left, s."""
        begin = self._stages[self._place].begin
        end = next((s.begin for s in self._stages[self._place :] if s.begin > begin), 1.0)
        share = min(max(elapsed_s / self._whole_s, begin), end)
        return share, max(self._whole_s - elapsed_s, elapsed_s * (1 - share))


@contextlib.contextmanager
def followed(
    tell: Callable[[str, float, float | None], None], *, samples: int, stages: Sequence[Stage] = STAGES
) -> Iterator[None]:
    """Tell stage, share of the engine (0..1) and time left (s) of what this thread does inside, of `samples` in all."""
    ended, worker = threading.Event(), threading.get_ident()
    pace, begun = Pace(stages, expected_s=SAMPLE_S * samples), time.monotonic()

    def watch() -> None:
        told = begun - TELL_S
        # What cannot be told or is not wanted any more is found out by the engine's own thread.
        with contextlib.suppress(SidebandError):
            while not ended.wait(LOOK_S):
                now, place = time.monotonic(), place_of(sys._current_frames().get(worker), stages)
                if place is None and not pace.begun:
                    continue
                new = place is not None and pace.seen(place, now - begun)
                if new or now - told >= TELL_S:
                    told = now
                    share, left_s = pace.at(now - begun)
                    tell(pace.name, share, left_s)

    thread = threading.Thread(target=watch, name="progress", daemon=True)
    thread.start()
    try:
        yield
    finally:
        ended.set()
        thread.join()


def place_of(frame: FrameType | None, stages: Sequence[Stage]) -> int | None:
    """Which stage runs: the outermost of those on the stack; None between two."""
    codes = {stage.code: place for place, stage in enumerate(stages)}
    found = None
    while frame is not None:
        found = codes.get(frame.f_code, found)
        frame = frame.f_back
    return found


def teller(reporter: Reporter, begin: float, end: float) -> Callable[[str, float, float | None], None]:
    """Tells the reporter, where the engine has the shares from `begin` to `end` of the job."""

    def tell(stage: str, share: float, left_s: float | None) -> None:
        reporter.stage(stage, begin + (end - begin) * share, left_s)

    return tell
