"""The estimated force over one argument, with its band and the law through it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from reconcile.report.figures.maps import across
from reconcile.report.markup import Markup, tag
from reconcile.report.pictures import numbers, text
from reconcile.report.plot import Frame, span
from reconcile.report.strict import Plain, plain
from reconcile.verdict import EstimatedForce

ARGUMENTS = {
    "displacement_m": "displacement, m",
    "velocity_m_per_s": "velocity, m/s",
    "angle_rad": "shaft angle, rad",
}


def law(picture: Mapping[str, Plain], ends: tuple[float, float] | None = None) -> Markup:
    """One panel of `law`, over `ends` where those are given."""
    x, force = numbers(picture.get("x")), numbers(picture.get("force"))
    low, high, fitted = (numbers(picture.get(key)) for key in ("low", "high", "fitted"))
    labels = text(picture.get("x_label")), text(picture.get("y_label"))
    frame = Frame(x=ends or span(x, pad=0.0), y=span(force, fitted), x_label=labels[0], y_label=labels[1], height=280.0)
    drawn = (
        frame.band(x, low, high, "force-band"),
        frame.axes(),
        frame.curve(x, force, "observed"),
        frame.curve(x, fitted, "after"),
    )
    return frame.svg(*drawn, title=f"Estimated force over {labels[0]}")


def law_words(picture: Mapping[str, Plain]) -> Markup:
    """Title of the panel, and what is which in it."""
    y_label, x_label = (text(picture.get(key)).split(",")[0] for key in ("y_label", "x_label"))
    drawn = [("observed", "estimated from the recording")]
    drawn += [("band", "its 90 % band")] if numbers(picture.get("low")) else []
    drawn += (
        [("after", "the nearest law" if picture.get("named") is False else "the named law")]
        if numbers(picture.get("fitted"))
        else []
    )
    key = tag("div", *(tag("span", tag("i", css=f"k-{css}"), words) for css, words in drawn), css="key")
    return Markup(tag("h3", f"{y_label.capitalize()} over {x_label}") + key)


def one_axis(laws: Sequence[Mapping[str, Plain]], planes: Sequence[Mapping[str, Plain]]) -> tuple[float, float] | None:
    """Ends of one horizontal axis for curves and maps under each other; None where they are over different things."""
    ends = [e for p in planes if (e := across(p)) is not None]
    ends += [span(x, pad=0.0) for p in laws if (x := numbers(p.get("x")))]
    alike = len({text(p.get("x_label")).split(",")[0].split(" (")[0] for p in (*laws, *planes)}) == 1
    return (min(a for a, _ in ends), max(b for _, b in ends)) if ends and alike else None


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
