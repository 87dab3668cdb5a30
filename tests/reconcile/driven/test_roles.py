"""Which channel drives and which answers: told by place and name, never by the axis, and never one for both."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.driven import reconcile_driven
from reconcile.driven.answer import _revised
from reconcile.driven.channels import driven_of, undirected
from reconcile.driven.judge import Judgement
from reconcile.driven.machine import revised
from reconcile.driven.model import Model
from reconcile.entry import reconcile_recordings
from signals.recording import Recording
from sim.core.errors import SpecError
from sim.core.response import Channel
from sim.presets import preset
from tests.reconcile.driven.made import recording

SPEC = preset("oscillator")
FORCE = Channel(name="force", quantity="force", unit="N", location="mass", axis="y")
MOTION = Channel(name="motion", quantity="acceleration", unit="m/s^2", location="mass", axis="y")


def with_channels(*channels: Channel, seed: int = 1) -> Recording:
    samples = np.random.default_rng(seed).normal(size=(len(channels), 600))
    return Recording(sampling_rate_hz=500.0, channels=channels, samples=samples)


def roles(*channels: Channel) -> tuple[str, str]:
    found = driven_of(with_channels(*channels), SPEC)
    return found.drive_channel.name, found.answer_channel.name


@pytest.mark.parametrize(
    "channels",
    [
        (replace(FORCE, location="input"), replace(MOTION, location="output")),
        (replace(FORCE, location="input"), MOTION),
        (FORCE, replace(MOTION, location="output")),
        (replace(MOTION, location="response", axis="Y"), replace(FORCE, location="", axis="")),
    ],
)
def test_the_axis_gives_no_role(channels: tuple[Channel, ...]) -> None:
    assert roles(*channels) == ("force", "motion")
    assert not driven_of(with_channels(*channels), SPEC).prescribed


def test_a_name_gives_a_role_where_the_quantity_gives_no_other() -> None:
    assert roles(replace(FORCE, name="drive"), replace(MOTION, name="y")) == ("drive", "y")
    assert roles(FORCE, replace(MOTION, name="u", quantity="displacement", unit="m")) == ("force", "u")
    volts = Channel(name="out", quantity="voltage", unit="V", location="")
    assert roles(volts, replace(volts, name="in")) == ("out", "in")
    assert roles(volts, replace(volts, name="u")) == ("u", "out")
    assert not undirected(with_channels(replace(FORCE, name="drive"), MOTION), SPEC)
    assert not undirected(with_channels(FORCE, replace(MOTION, location="output")), SPEC)
    assert undirected(with_channels(FORCE, replace(MOTION, name="y")), SPEC)


def test_a_force_that_is_the_output_makes_the_motion_the_input() -> None:
    found = driven_of(with_channels(replace(FORCE, location="output"), MOTION), SPEC)
    assert (found.drive_channel.name, found.prescribed) == ("motion", True)


def test_of_several_motions_that_of_the_mass_along_its_axis_is_taken() -> None:
    other = replace(MOTION, name="other", location="frame")
    across = replace(MOTION, name="across", axis="x")
    moved = replace(MOTION, name="moved", quantity="displacement", unit="m")
    assert roles(FORCE, other, MOTION) == ("force", "motion")
    assert roles(FORCE, across, MOTION) == ("force", "motion")
    assert roles(FORCE, MOTION, moved) == ("force", "moved")
    assert roles(FORCE, moved, replace(MOTION, location="output")) == ("force", "motion")


@pytest.mark.parametrize(
    ("channels", "words"),
    [
        ((MOTION,), "which channel drives"),
        ((replace(MOTION, name="drive", location="drive_end"),), "which channel drives"),
        ((replace(MOTION, name="drive"), replace(MOTION, name="fan")), "which channel drives"),
        ((FORCE, replace(FORCE, name="second")), "which channel drives"),
        ((FORCE, MOTION, replace(MOTION, name="second")), "which motion is that of the mass"),
        ((replace(FORCE, location="input"), replace(MOTION, location="input")), "more than one channel"),
        ((replace(FORCE, location="shaker"), MOTION), r"channels\.force\.location: is not a place of this machine"),
        ((FORCE, replace(MOTION, location="bearing1")), r"allowed: mass, input, output, or nothing"),
    ],
)
def test_what_gives_no_input_and_output_is_refused(channels: tuple[Channel, ...], words: str) -> None:
    with pytest.raises(SpecError, match=words):
        driven_of(with_channels(*channels), SPEC)


def test_accelerometers_of_another_rig_are_refused_at_the_door() -> None:
    channels = (replace(MOTION, name="drive"), replace(MOTION, name="fan"))
    rig = [with_channels(*channels, seed=k) for k in range(2)]
    with pytest.raises(SpecError, match="which channel drives"):
        reconcile_recordings(SPEC, rig)


@pytest.mark.slow
def test_the_places_that_the_refusal_asks_for_give_the_answer_of_quantities() -> None:
    made = recording(None, seed=21, n=6000)
    placed = tuple(replace(c, location=p) for c, p in zip(made.channels, ("input", "output"), strict=True))
    plain, told = (reconcile_driven(SPEC, [r], seed=2) for r in (made, replace(made, channels=placed)))
    assert plain.verdict == told.verdict == "nothing_missing"
    assert told.machine == plain.machine


def test_numbers_that_make_no_machine_are_a_problem_with_their_place() -> None:
    data = driven_of(with_channels(FORCE, MOTION), SPEC)
    with pytest.raises(SpecError, match="stiffness_y_n_per_m"):
        revised(SPEC, Model(stiffness=1e22, damping=1.0, gain=1.0), data, data.drive)
    found = SimpleNamespace(published=Model(stiffness=1e22, damping=1.0, gain=1.0), held_run=SimpleNamespace(data=data))
    explained = Judgement(verdict="explained", reasons=(), rivals=())
    machine, judgement = _revised(SPEC, found, explained, data.drive)  # type: ignore[arg-type]
    assert machine is None and judgement.verdict == "not_decidable"
    assert "stiffness_y_n_per_m" in judgement.reasons[0]
