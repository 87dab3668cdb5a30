"""The language of force laws: what it refuses, where, and that nothing else gets through."""

from __future__ import annotations

import pytest
from hypothesis import given
from hypothesis import strategies as st

from sim.core.errors import SpecError
from sim.core.expression import MAX_INSTRUCTIONS, MAX_STACK, compiled, stack_depth


@pytest.mark.parametrize(
    ("text", "position", "message"),
    [
        ("", 1, "is expected"),
        ("1 +", 4, "is expected"),
        ("2**x", 3, "is expected"),
        ("x^v", 3, "an exponent must be a number"),
        ("x^9.5", 3, "the exponent is out of bounds"),
        ("x^2^2", 4, "an operator is expected"),
        ("y + 1", 1, "unknown name"),
        ("neg(x)", 1, "unknown name"),
        ("__import__(x)", 1, "unknown name"),
        ("max(x)", 6, "',' is expected"),
        ("sin x", 5, "'(' is expected"),
        ("((x)", 5, "')' is expected"),
        ("x) ", 2, "an operator is expected"),
        ("x.real", 2, "is not part of a force law"),
        ("1;x", 2, "is not part of a force law"),
        ("1e999", 1, "the number is too large"),
        ("+".join("x" * 40), 66, "too many steps"),
        ("(" * 40 + "x" + ")" * 40, 33, "nested too deeply"),
        ("x" * 401, 401, "too long"),
    ],
)
def test_refused_with_its_place(text, position, message):
    with pytest.raises(SpecError) as caught:
        compiled(text, "here")
    problem = caught.value.problems[0]
    assert problem.field == "here" and problem.allowed
    assert problem.message.startswith(f"at character {position}: ") and message in problem.message


def test_too_deep_a_stack_is_refused():
    deep = "x" + "".join(f"*({k}+x" for k in range(1, 8)) + ")" * 7
    with pytest.raises(SpecError, match="too many values waiting"):
        compiled(deep)


@given(st.text(alphabet="xvphi0123456789.e+-*/^(), sincotaqrmw", max_size=60))
def test_any_text_gives_a_program_within_bounds_or_a_refusal(text):
    try:
        program = compiled(text)
    except SpecError as error:
        assert error.problems[0].message
        return
    assert 0 < len(program) <= MAX_INSTRUCTIONS
    assert 1 <= stack_depth(program) <= MAX_STACK
