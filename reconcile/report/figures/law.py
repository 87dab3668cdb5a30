"""The estimated force over one argument, with its band and the law through it."""

from __future__ import annotations

from collections.abc import Mapping

from reconcile.report.markup import Markup
from reconcile.report.pictures import numbers, text
from reconcile.report.plot import Frame, span
from reconcile.report.strict import Plain, plain
from reconcile.verdict import EstimatedForce

ARGUMENTS = {
    "displacement_m": "displacement, m",
    "velocity_m_per_s": "velocity, m/s",
    "angle_rad": "shaft angle, rad",
}


def law(picture: Mapping[str, Plain]) -> Markup:
    """One panel of `law`."""
    x, force = numbers(picture.get("x")), numbers(picture.get("force"))
    low, high, fitted = (numbers(picture.get(key)) for key in ("low", "high", "fitted"))
    labels = text(picture.get("x_label")), text(picture.get("y_label"))
    frame = Frame(x=span(x, pad=0.0), y=span(force, fitted), x_label=labels[0], y_label=labels[1], height=280.0)
    drawn = (
        frame.band(x, low, high, "force-band"),
        frame.axes(),
        frame.curve(x, force, "observed"),
        frame.curve(x, fitted, "after"),
    )
    return frame.svg(*drawn, title=f"Estimated force over {labels[0]}")


def from_force(force: EstimatedForce) -> dict[str, Plain] | None:
    """The picture that the report's force itself allows, where the engine drew none."""
    argument = next((key for key in ARGUMENTS if key in force.samples), None)
    if argument is None or "force_n" not in force.samples:
        return None
    order = sorted(range(len(force.samples[argument])), key=lambda i: force.samples[argument][i])

    def along(key: str) -> Plain:
        values = force.samples.get(key, ())
        return plain([values[i] for i in order]) if len(values) == len(order) else None

    return {
        "x_label": ARGUMENTS[argument],
        "y_label": "force, N",
        "x": along(argument),
        "force": along("force_n"),
        "low": along("low_n"),
        "high": along("high_n"),
        "fitted": None,
    }
