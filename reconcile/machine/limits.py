"""What these recordings cannot say, whatever the engine does: the limits that the report prints beside places."""

from __future__ import annotations

from reconcile.machine.setting import Setting
from reconcile.verdict import operating_point

ONE_SENSOR = "one sensor cannot locate a broadband force: places rest on the spectra the machine model predicts"
NO_BASELINE = "without a baseline the machine's parameters and the sensors' paths were fitted to the test itself"
ONE_POINT = "one operating point: the held-out data are a later time of the same record"


def limits(setting: Setting) -> tuple[str, ...]:
    """Sentences of the report."""
    found = []
    if len(setting.channels) == 1:
        found.append(ONE_SENSOR)
    if not setting.changes.with_baseline:
        found.append(NO_BASELINE)
    if len(setting.data) == 1:
        found.append(ONE_POINT)
    if setting.changes.delays:
        found.append(_apart(setting))
    return (*found, *_mirrored(setting))


def _mirrored(setting: Setting) -> tuple[str, ...]:
    """Which sensors were read the other way round, one sentence for all."""
    read = [
        f"{setting.channels[c]} at {operating_point(d.point.speed_hz, d.point.torque_ratio)}"
        for d in setting.data
        for c in d.mirrored
    ]
    if not read:
        return ()
    told = (
        f"{', '.join(read)}: moves across the load half a turn of phase apart from the baseline, which is the mirror "
        "image of one motion, as likely in a sound machine; read the other way round (a sensor that was turned round "
        "since looks so too)"
    )
    return (told,)


def _apart(setting: Setting) -> str:
    worst = max(setting.changes.delays, key=lambda d: abs(d.seconds))
    pair = (setting.channels[(worst.channel + k) % len(setting.channels)] for k in (0, 1))
    return (
        f"{' and '.join(pair)} are {abs(worst.seconds) * 1e3:.3g} ms further apart in time than in the baseline: "
        "sensors of one recording must share a clock; phases between them were not compared"
    )
