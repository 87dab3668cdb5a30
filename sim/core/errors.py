"""Errors of the simulation core.

SidebandError
 +- SpecError (ValueError)      the specification cannot describe a machine; carries field problems
 +- UnknownName (KeyError)      a preset, term, site, bearing or channel that does not exist
 +- Diverged (ArithmeticError)  the integration left the finite numbers; time, DOF, advice
 +- Meaningless (ArithmeticError) the run ended, but its figures say that the numbers mean nothing; reasons, advice
 +- Cancelled                   the caller asked to stop
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import asdict, dataclass

from sim.core.near import did_you_mean


@dataclass(frozen=True, kw_only=True)
class Problem:
    """One thing wrong with an input: where, what was given, what is allowed, in which unit."""

    field: str
    message: str
    given: object = None
    allowed: str = ""
    unit: str = ""

    def to_dict(self) -> dict[str, object]:
        """Return the problem as JSON-ready keys."""
        return asdict(self)

    def __str__(self) -> str:
        given = "" if self.given is None else f" (given {self.given!r})"
        allowed = f"; allowed: {self.allowed}" if self.allowed else ""
        # The unit 1 of pure numbers is nothing to read.
        unit = f" {self.unit}" if self.unit not in ("", "1") and self.allowed else ""
        return f"{self.field}: {self.message}{given}{allowed}{unit}"


class SidebandError(Exception):
    """Base of every error a caller of Sideband can act on; the same after it came from another process."""

    def __reduce__(self) -> tuple[object, ...]:
        return _again, (type(self), self.args, self.__dict__)


def _again(kind: type[SidebandError], args: tuple[object, ...], state: dict[str, object]) -> SidebandError:
    """An error as it was, without asking its constructor: that takes what the message was made of."""
    error = kind.__new__(kind)
    error.args = args
    error.__dict__.update(state)
    return error


class SpecError(SidebandError, ValueError):
    """The specification is wrong; `problems` lists every field that must change."""

    def __init__(self, problems: Sequence[Problem] | Problem) -> None:
        self.problems: tuple[Problem, ...] = (problems,) if isinstance(problems, Problem) else tuple(problems)
        super().__init__("; ".join(str(p) for p in self.problems))


class UnknownName(SidebandError, KeyError):
    """A name that does not exist; `known` lists the names that do."""

    def __init__(self, kind: str, name: str, known: Sequence[str]) -> None:
        self.kind, self.name, self.known = kind, name, tuple(known)
        hint = did_you_mean(name, self.known)
        super().__init__(f"unknown {kind} {name!r}{hint}; known: {', '.join(self.known) or 'none'}")

    def __str__(self) -> str:
        return str(self.args[0])


class Diverged(SidebandError, ArithmeticError):
    """The motion left the finite numbers or the corrector could not converge."""

    def __init__(self, *, time_s: float, dof: str, advice: str) -> None:
        self.time_s, self.dof, self.advice = time_s, dof, advice
        super().__init__(f"{self.what}; {advice}")

    @property
    def what(self) -> str:
        """What happened, without the advice."""
        return f"simulation diverged at t = {self.time_s:.6g} s in {self.dof}"


class Meaningless(SidebandError, ArithmeticError):
    """A run whose energy balance, convergence or step error says that its numbers are none of the machine's."""

    def __init__(self, *, reasons: Sequence[str], advice: str) -> None:
        self.reasons, self.advice = tuple(reasons), advice
        super().__init__(f"{self.what}. {advice}")

    @property
    def what(self) -> str:
        """What is wrong, without the advice."""
        return f"the numbers of this run mean nothing: {'; '.join(self.reasons)}"


class TooStiff(SidebandError, ArithmeticError):
    """A run given up because its corrector takes more iterations than the caller allowed."""

    def __init__(self, *, time_s: float, per_step: float, allowed: float) -> None:
        self.time_s, self.per_step, self.allowed = time_s, per_step, allowed
        super().__init__(
            f"given up at t = {time_s:.4g} s: {per_step:.3g} iterations a step, where {allowed:g} were allowed"
        )


class Cancelled(SidebandError):
    """The work was stopped at the caller's request."""
