"""The engine where the machine can be simulated: all stages over an atlas of its effects."""

from reconcile.machine.budget import Budget
from reconcile.machine.engine import reconcile_machine

__all__ = ["Budget", "reconcile_machine"]
