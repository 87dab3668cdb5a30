"""The health document as Prometheus gauges."""

from __future__ import annotations

from prometheus_client import CollectorRegistry, Gauge

from app.health import Health


def state_metrics(health: Health) -> CollectorRegistry:
    """A registry filled from one health document."""
    registry = CollectorRegistry()
    _labelled(registry, "sideband_up", "Whether a part answers.", "part", _parts(health))
    _labelled(registry, "sideband_jobs", "Jobs by status.", "status", health.jobs)
    _labelled(registry, "sideband_workers", "Workers by state.", "state", _workers(health))
    _labelled(
        registry, "sideband_failures_last_hour", "Failed jobs by code, last hour.", "code", health.failures_last_hour
    )
    plain = {
        "sideband_outbox_jobs": ("Accepted jobs not yet with the broker.", health.queue.outbox),
        "sideband_queue_oldest_seconds": ("Age of the oldest waiting job.", health.queue.oldest_waiting_s or 0),
        "sideband_disk_free_bytes": ("Space left for results.", _free(health)),
        "sideband_finished_last_minute": ("Jobs finished in the last minute.", health.throughput.finished_last_minute),
        "sideband_finished_last_hour": ("Jobs finished in the last hour.", health.throughput.finished_last_hour),
        "sideband_run_seconds_mean": ("Mean running time, last hour.", health.throughput.mean_run_s or 0),
        "sideband_uptime_seconds": ("Time since the API process started.", health.uptime_s),
    }
    for name, (text, value) in plain.items():
        Gauge(name, text, registry=registry).set(value)
    return registry


def _labelled(registry: CollectorRegistry, name: str, text: str, label: str, values: dict[str, int]) -> None:
    gauge = Gauge(name, text, (label,), registry=registry)
    for key, value in values.items():
        gauge.labels(key).set(value)


def _free(health: Health) -> float:
    if health.disk.free_bytes is None:
        # An object store tells no bound; 0 would set off alarms.
        return float("inf") if health.disk.status == "ok" else 0.0
    return float(health.disk.free_bytes)


def _parts(health: Health) -> dict[str, int]:
    return {name: int(getattr(health, name).status == "ok") for name in ("broker", "catalogue", "artefacts")}


def _workers(health: Health) -> dict[str, int]:
    counts = {"idle": 0, "busy": 0}
    for worker in health.workers:
        counts[worker.state] = counts.get(worker.state, 0) + 1
    return counts
