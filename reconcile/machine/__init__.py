"""The engine where the machine can be simulated: all stages over an atlas of its effects."""

from reconcile.machine.engine import Budget, reconcile_machine

__all__ = ["Budget", "reconcile_machine"]
