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


@dataclass(kw_only=True, eq=False)
class _Sound:
    """A machine without a fault at one operating point, and the recordings that are made beside it; `response` once it
    is simulated."""

    ready: Ready
    response: Response | SidebandError | None = None
    members: list[Ready] = field(default_factory=list)
    recordings: dict[int, Recording] = field(default_factory=dict)
    """Its own recordings by the seed of their noise."""


def recorded_beside(plan: Plan, numbers: Sequence[int], cancelled: Callable[[], bool] | None = None) -> Iterator[Found]:
    """The recordings `numbers`, each once. A machine is simulated once without its fault for all that share it.

    Each is the same bytes alone or beside any others. Eight machines and eight faulty ones are held at once.
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
    faulty = [(member, sound) for sound in sounds for member in sound.members if member.drawing.effects]
    like = sounds[0].ready.alike
    # Fewer than eight machines leave lanes empty, where faulty ones of their structure have room.
    first = [one for one in faulty if one[0].alike == like][: WIDTH - len(sounds)]
    found = side_by_side(plan, [*(sound.ready for sound in sounds), *(member for member, _ in first)], cancelled)
    for sound, response in zip(sounds, found[: len(sounds)], strict=True):
        sound.response = response
        yield from (_made(plan, member, sound, response) for member in sound.members if not member.drawing.effects)
    for (member, sound), response in zip(first, found[len(sounds) :], strict=True):
        yield _made(plan, member, sound, response)
    taken = {id(member) for member, _ in first}
    left = [one for one in faulty if id(one[0]) not in taken]
    yield from (_made(plan, *one, one[1].response) for one in left if isinstance(one[1].response, SidebandError))
    simulated = [one for one in left if not isinstance(one[1].response, SidebandError)]
    for group in _alike(simulated, lambda one: one[0].alike):
        responses = side_by_side(plan, [member for member, _ in group], cancelled)
        yield from (_made(plan, *one, response) for one, response in zip(group, responses, strict=True))
    for sound in sounds:
        sound.response = None  # nothing more is made beside it: its outputs are not kept for the whole batch


def _made(plan: Plan, one: Ready, sound: _Sound, response: Response | SidebandError) -> Found:
    """A recording by its simulation; without its machine's own there is none either."""
    drawn, without = one.drawing, sound.response
    for simulated in (without, response):
        if isinstance(simulated, SidebandError):
            return drawn.number, failure_of(plan, drawn.number, simulated)
    assert isinstance(without, Response) and isinstance(response, Response)
    try:
        recording = _recording(plan, drawn, response, without)
        if drawn.effects:
            _check_shown(plan, drawn, sound, recording, without)
        else:
            sound.recordings[drawn.noise_seed] = recording
    except SidebandError as error:
        return drawn.number, failure_of(plan, drawn.number, error)
    return drawn.number, made_of(drawn, one.system, response, recording)


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
