"""Errors of fitted numbers that scatter within one stretch does not show: of the model, the input, and the stretch.

A model is fitted again where a true one would come out the same: led by the measured output (a free run gathers what
model and measured input lack, a led one forgets it; Hausman 1978, Econometrica 46, 1251-1271, compares two such
estimates), with straight lines between the samples of the input, and on the other part. What a number moves by counts
as a standard error each time; between parts only what exceeds their scatter, half of it the part's own (DerSimonian &
Laird 1986, Controlled Clinical Trials 7, 177-188).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from reconcile.driven.channels import FloatArray
from reconcile.driven.fit import LED, Doubts, Fitted, descend
from reconcile.driven.model import Run, held_linear


def _moved(found: Fitted, runs: Sequence[Run]) -> FloatArray:
    return descend(found.model, runs).model.vector() - found.model.vector()


def doubted(found: Fitted, runs: Sequence[Run], other: Fitted | None) -> Fitted:
    """The fit with what its numbers may be off beside their scatter; `other`: the same structure on the other part."""
    moved = [_moved(found, [held_linear(r) for r in runs])]
    if runs[0].data.order < 2:
        moved.append(_moved(found, [replace(r, led=LED) for r in runs]))
    apart = None
    if other is not None and [law.key for law in other.model.laws] == [law.key for law in found.model.laws]:
        apart = (other.model.vector() - found.model.vector(), other.covariance)
    return replace(found, doubts=Doubts(moved=tuple(moved), apart=apart))
