"""Recordings made beside those of the same machines without the fault, by which background and fault are measured."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Iterator, Sequence
from dataclasses import dataclass, field, replace
from typing import TypeVar

from sideband_datasets.make.batch import Failure, Made, Ready, failure_of, made_of, put_together, side_by_side
from sideband_datasets.make.ground import heard
from sideband_datasets.plan.drawing import Drawing, drawing
from sideband_datasets.plan.ground import ground_of
from sideband_datasets.plan.plan import Plan
from signals.background import shown_db
from signals.recording import Recording
from signals.sensors import Motion, measure, motion_of
from signals.sensors.spec import SensorChain
from signals.series import FloatArray
from sim.core.errors import SidebandError
from sim.core.lanes import WIDTH
from sim.core.response import Response

Found = tuple[int, Made | Failure]
T = TypeVar("T")


class NotShown(SidebandError):
    """A fault that the recording hardly shows, where the recipe leaves such recordings out."""


@dataclass(frozen=True, kw_only=True)
class _Sound:
    """A machine without a fault at one operating point, and the recordings that are made beside it."""

    ready: Ready
    members: list[Ready] = field(default_factory=list)
    recordings: dict[int, Recording] = field(default_factory=dict)
    """Its own recordings by the seed of their noise."""


def recorded_beside(plan: Plan, numbers: Sequence[int], cancelled: Callable[[], bool] | None = None) -> Iterator[Found]:
    """The recordings `numbers`, each once. A machine is simulated once without its fault for all that share it.

    Each is the same bytes alone or beside any others. Eight machines and one class of them are held at once.
    """
    found: dict[Hashable, _Sound] = {}
    for number in dict.fromkeys(numbers):
        try:
            drawn = drawing(plan, number)
            key = (drawn.seed, drawn.sound.model_dump_json())
            if key not in found:
                found[key] = _Sound(ready=put_together(plan, replace(drawn, spec=drawn.sound, effects=())))
            ready = found[key].ready
            found[key].members.append(put_together(plan, drawn) if drawn.effects else replace(ready, drawing=drawn))
        except SidebandError as error:
            yield number, failure_of(plan, number, error)
    for group in _alike(found.values(), lambda sound: sound.ready.alike):
        yield from _of_machines(plan, group, cancelled)


def _alike(items: Iterable[T], structure: Callable[[T], Hashable]) -> Iterator[list[T]]:
    """Those of one structure, as many as there are lanes."""
    groups: dict[Hashable, list[T]] = {}
    for item in items:
        groups.setdefault(structure(item), []).append(item)
    for group in groups.values():
        for first in range(0, len(group), WIDTH):
            yield group[first : first + WIDTH]


def _of_machines(plan: Plan, sounds: Sequence[_Sound], cancelled: Callable[[], bool] | None) -> Iterator[Found]:
    responses = side_by_side(plan, [sound.ready for sound in sounds], cancelled)
    faulty: list[tuple[Ready, _Sound, Response]] = []
    for sound, response in zip(sounds, responses, strict=True):
        for member in sound.members:
            number = member.drawing.number
            if isinstance(response, SidebandError):
                yield number, failure_of(plan, number, response)
            elif not member.drawing.effects:
                yield number, _made(plan, member, sound, response, response)
            else:
                faulty.append((member, sound, response))
    for group in _alike(faulty, lambda one: one[0].alike):
        found = side_by_side(plan, [member for member, _, _ in group], cancelled)
        for (member, sound, without), response in zip(group, found, strict=True):
            number = member.drawing.number
            if isinstance(response, SidebandError):
                yield number, failure_of(plan, number, response)
            else:
                yield number, _made(plan, member, sound, response, without)


def _made(plan: Plan, one: Ready, sound: _Sound, response: Response, without: Response) -> Made | Failure:
    drawn = one.drawing
    try:
        recording = _recording(plan, drawn, response, without)
        if drawn.effects:
            _check_shown(plan, drawn, sound, recording, without)
        else:
            sound.recordings[drawn.noise_seed] = recording
    except SidebandError as error:
        return failure_of(plan, drawn.number, error)
    return made_of(drawn, one.system, response, recording)


def _recording(plan: Plan, drawn: Drawing, response: Response, without: Response) -> Recording:
    """What the sensors record of the motion and its background."""
    ground = ground_of(plan.recipe, drawn.machine)
    motion, unit = motion_of(response), 1.0
    if ground is not None and plan.recipe.background is not None:
        found = heard(response, without, drawn, ground, plan.recipe.settle_s)
        motion = found.motion
        unit = found.level if plan.recipe.background.chain_in_levels else 1.0
    if drawn.chain is None:
        return motion.recording
    recording = measure(_scaled(motion, 1.0 / unit), drawn.chain, seed=drawn.noise_seed).recording
    return recording if unit == 1.0 else _unscaled(recording, drawn.chain, unit)


def _scaled(motion: Motion, factor: float) -> Motion:
    """Accelerations in another unit: the chain's numbers are then in that unit."""
    if factor == 1.0:
        return motion
    rows = [c.quantity == "acceleration" for c in motion.recording.channels]
    return replace(motion, recording=replace(motion.recording, samples=_times(motion.recording.samples, rows, factor)))


def _unscaled(recording: Recording, chain: SensorChain, factor: float) -> Recording:
    rows = [channel.kind != "tacho" for channel in chain.channels]
    return replace(recording, samples=_times(recording.samples, rows, factor))


def _times(samples: FloatArray, rows: Sequence[bool], factor: float) -> FloatArray:
    found = samples.copy()
    found[list(rows)] *= factor
    return found


def _check_shown(plan: Plan, drawn: Drawing, sound: _Sound, recording: Recording, without: Response) -> None:
    """NotShown for a fault below the recipe's `shown_db` in every channel."""
    least = plan.recipe.shown_db
    if least is None:
        return
    if drawn.noise_seed not in sound.recordings:
        bare = replace(drawn, spec=drawn.sound, effects=())
        sound.recordings[drawn.noise_seed] = _recording(plan, bare, without, without)
    first = round(plan.recipe.settle_s * recording.sampling_rate_hz)
    pairs = zip(sound.recordings[drawn.noise_seed].samples[:, first:], recording.samples[:, first:], strict=True)
    found = max(shown_db(*pair) for pair in pairs)
    if found < least:
        message = f"the fault adds {found:.1f} dB at most to the machine without it, in the best of sixteen bands"
        raise NotShown(f"{message}; the recipe leaves out what is below {least:g} dB")
