"""Level `driven`: the input was measured with the response, so a model can be run on it and compared in time."""

from reconcile.driven.engine import reconcile_driven

__all__ = ["reconcile_driven"]
