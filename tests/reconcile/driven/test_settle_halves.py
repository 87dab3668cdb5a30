"""Which laws go is asked of one half of what is held out; the gain is then that of the other."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
import pytest

from reconcile.driven import settle as module
from reconcile.driven.settle import settle


class Data:
    """Samples of an output, cut as a recording is."""

    def __init__(self, answer: np.ndarray) -> None:
        self.answer, self.drive = answer, answer
        self.bad_drive = self.bad_answer = None

    def part(self, first: int, last: int) -> Data:
        """Samples first <= i < last."""
        return Data(self.answer[first:last])


@pytest.mark.parametrize("goes", [True, False])
def test_where_a_law_goes_the_gain_is_that_of_the_half_that_chose_nothing(
    goes: bool, monkeypatch: pytest.MonkeyPatch
) -> None:
    seen: list[tuple[str, np.ndarray, str]] = []
    both = SimpleNamespace(laws=(SimpleNamespace(key="cubic"), SimpleNamespace(key="drag")))
    alone = SimpleNamespace(laws=both.laws[:1])

    def settled(case: module.Case, chosen: SimpleNamespace) -> module.Settled:
        seen.append(("held", case.held.data.answer, case.half))
        return module.Settled(final=SimpleNamespace(model=chosen), validations=())  # type: ignore[arg-type]

    def fewer(case: module.Case, found: SimpleNamespace) -> SimpleNamespace | None:
        seen.append(("asked", case.held.data.answer, case.half))
        return alone if goes and len(found.model.laws) > 1 else None

    monkeypatch.setattr(module, "_settled", settled)
    monkeypatch.setattr(module, "_fewer", fewer)
    monkeypatch.setattr(module, "ready", lambda data, _memory: SimpleNamespace(data=data))
    start = SimpleNamespace(linear=SimpleNamespace(model=SimpleNamespace(memory_s=0.1)))
    case = module.Case(
        parts=(), start=start, held=SimpleNamespace(data=Data(np.arange(10.0))), names=("a", "b"), seed=1,  # type: ignore[arg-type]
    )  # fmt: skip
    found = settle(case, both)  # type: ignore[arg-type]
    assert seen[0][0] == "held" and seen[0][1].size == 10 and seen[0][2] == ""
    assert all(np.array_equal(a, np.arange(5.0)) for what, a, _ in seen if what == "asked")
    last = [one for one in seen if one[0] == "held"][-1]
    if goes:
        assert np.array_equal(last[1], np.arange(5.0, 10.0)) and last[2] == "the second half of "
        assert [law.key for law in found.dropped] == ["drag"]
    else:
        assert last[1].size == 10 and found.dropped == ()
