"""Answers made up, of recordings without samples."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from learn.assess import Assessment
from learn.orders import of_ratio
from learn.real.load import Case
from learn.sim2real.answers import Answer, Unit

ORDERS = of_ratio(9, 0.2)


def case(name, label, rig="one", *, stated_hz=20.0, size=None, orders=ORDERS, teeth=None):
    return Case(
        rig=rig,
        name=name,
        label=label,
        channels=np.zeros((1, 4)),
        rate_hz=1000.0,
        speed_hz=stated_hz,
        stated_hz=stated_hz,
        orders=orders,
        size=size,
        teeth=teeth,
    )


def answer(of, said, window=None, **more):
    return Answer(unit=Unit(case=of, channels=of.channels, window=window), label=said, detail="", **more)


def with_severity(of, said, index):
    told = Assessment(
        label=said,
        probabilities={said: 1.0},
        found={},
        comb={},
        stretches=1,
        turns=10.0,
        geometry="known",
        severity=index,
    )
    return replace(answer(of, said), assessment=told)


@pytest.fixture
def made():
    return SimpleNamespace(case=case, answer=answer, with_severity=with_severity)
