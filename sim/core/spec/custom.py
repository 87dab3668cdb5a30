"""Force laws of the user's own."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from sim.core.spec.base import WHOLE, Finite, Name, SpecModel

Dof = Annotated[str, Field(pattern=r"^[a-z][a-z0-9_]{0,39}(\.[a-z][a-z0-9_]{0,39}){0,2}\.(x|y|theta)$")]


class ForceTable(SpecModel):
    """Force over evenly spaced displacements, velocities and shaft angles; linear between, constant beyond the ends."""

    displacement: Annotated[list[Finite], Field(min_length=2, max_length=2)]
    """First and last displacement, m (rad)."""
    displacements: Annotated[int, Field(ge=2, le=256, strict=False), WHOLE]
    """Number of displacements."""
    velocity: Annotated[list[Finite], Field(min_length=2, max_length=2)] = Field(default=[-1.0, 1.0])
    """First and last velocity, m/s (rad/s)."""
    velocities: Annotated[int, Field(ge=1, le=256, strict=False), WHOLE] = 1
    """Number of velocities; one: the force does not depend on it."""
    angles: Annotated[int, Field(ge=1, le=256, strict=False), WHOLE] = 1
    """Number of shaft angles in a turn, the first at 0; one: the force does not depend on it."""
    force: Annotated[list[Finite], Field(min_length=2, max_length=4096)]
    """N (N m): displacement runs slowest, then velocity, the angle fastest."""

    @model_validator(mode="after")
    def _fits(self) -> ForceTable:
        count = self.displacements * self.velocities * self.angles
        if len(self.force) != count:
            raise ValueError(f"force must have displacements x velocities x angles = {count} values")
        for name, ends in (("displacement", self.displacement), ("velocity", self.velocity)):
            if not ends[1] > ends[0]:
                raise ValueError(f"{name} must rise from its first to its last value")
        return self


class CustomLaw(SpecModel):
    """A force law f between two degrees of freedom, or one and the ground; the term `custom_force` lets it act.

    x = `dof` - `against` in m (rad), v its rate, phi the angle of the site's shaft in rad. The machine feels -f on
    `dof` and +f on `against`: f = 1e6*x is a spring.
    """

    name: Name
    dof: Dof
    """For example `bearing1.outer.y`."""
    against: Dof | None = None
    """None: the ground."""
    expression: Annotated[str, Field(min_length=1, max_length=400)] | None = None
    """Numbers, x, v, phi, pi, + - * / ^ ( ), sin cos abs sign sqrt exp tanh max min; force in N (N m)."""
    table: ForceTable | None = None

    @model_validator(mode="after")
    def _one_form(self) -> CustomLaw:
        if (self.expression is None) == (self.table is None):
            raise ValueError("give either expression or table")
        return self


__all__ = ["CustomLaw", "ForceTable"]
