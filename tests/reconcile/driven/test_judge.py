"""What speaks against single laws of a set leaves it a curve through the force, what speaks against all does not."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from reconcile.driven.judge import FARTHER, NOT_ALL, ROUGH, _of_law, _of_single_laws
from reconcile.driven.model import LINEAR
from reconcile.driven.settle import LOST
from reconcile.force_law.library import CUBIC, QUADRATIC, Law

ZERO = "zero"
"""The reason that the first law's interval includes zero."""


def found(
    laws: tuple[Law, ...] = (CUBIC, QUADRATIC), after: float = 0.01, led: bool = False, farther: bool = False
) -> SimpleNamespace:
    """An analysis whose first law may be zero; `farther`: it leaves that much more on the part held out."""
    v = SimpleNamespace(after=after, led=led, diverged=False, held="test 2", fitted_on="test 1")
    final = SimpleNamespace(
        model=SimpleNamespace(laws=laws), interval=lambda i: (1.0, -1.0, 3.0) if i == LINEAR else (1.0, 0.5, 1.5)
    )
    leave = after / (2 * FARTHER) if farther else after
    return SimpleNamespace(final=final, validations=(v,), laws_leave=leave)


@pytest.mark.parametrize(
    ("analysis", "reasons", "so"),
    [
        (found(), (), True),
        (found(), (ZERO,), True),
        (found(), (NOT_ALL, ZERO), True),
        (found(), (ZERO, "gain not above that of a linear retuning"), False),
        (found(laws=(CUBIC,)), (ZERO,), False),  # alone it is no set
        (found(after=1.1 * ROUGH), (ZERO,), False),  # it leaves too much to be the force
        (found(after=1.1 * ROUGH), (), True),
        (found(led=True), (ZERO,), False),
        (found(after=1.1 * LOST, farther=True), (ZERO,), False),
    ],
)
def test_a_set_that_holds_as_a_whole_is_a_curve_whichever_law_may_be_zero(
    analysis: SimpleNamespace, reasons: tuple[str, ...], so: bool
) -> None:
    zero = _of_law(analysis, 0)[0]  # type: ignore[arg-type]
    assert "includes zero" in zero
    told = tuple(zero if reason == ZERO else reason for reason in reasons)
    assert _of_single_laws(analysis, told) is so  # type: ignore[arg-type]
