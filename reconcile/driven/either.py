"""A mass that follows its base by less than it should: the gain of a sensor, or a spring that holds it to ground."""

from __future__ import annotations

from dataclasses import replace

from reconcile.verdict import NextExperiment, Report, SensorFault

HOLDS = "holds the mass to the ground"
"""How a fault's detail says that a spring would do the same (`reconcile.driven.pair`)."""
REST = " Apart from it the linear model explains the recordings."
"""As `reconcile.driven.faulty` says it."""
WHICH = NextExperiment(
    sentence="Put both sensors on the base and shake: a gain stays. Or push the mass with a force that is measured: a "
    "spring to the ground then counts with its stiffness."
)


def either(report: Report) -> Report:
    """The report whose only fault is such a gain as the set of both: neither channel nor machine is called wrong."""
    fault = report.fault
    if fault is None or HOLDS not in fault.detail:
        return report
    recording, _, rest = fault.detail.partition(": ")
    detail, _, spring = rest.partition("; either of both may be wrong, or ")
    alone = all(HOLDS in one.detail for one in report.measurement_faults)
    if report.verdict != "measurement_fault" or not alone:
        return replace(report, sentence=f"{report.sentence} Or, in place of that gain, {spring}.")
    rest = REST if REST in report.sentence else ""
    sentence = (
        f"A gain or a spring, and two motions do not tell which ({recording}): {detail}, and either sensor may be "
        f"wrong; or the sensors are right, and {spring}.{rest}"
    )
    return replace(
        report,
        verdict="ambiguous",
        sentence=sentence,
        fault=_doubtful(fault),
        measurement_faults=tuple(map(_doubtful, report.measurement_faults)),
        undecidable=(*report.undecidable, f"whether a sensor's gain is wrong, or {spring}"),
        next_experiment=WHICH,
    )


def _doubtful(fault: SensorFault) -> SensorFault:
    return replace(fault, doubtful=True)
