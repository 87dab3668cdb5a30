"""The RQ worker: forks a warm process for each job, watches over it, and leaves the truth to the catalogue."""

from __future__ import annotations

import logging
import os
import signal
import time
from types import FrameType
from typing import cast

from redis.client import Pipeline
from redis.exceptions import RedisError
from rq import Queue, Worker
from rq.exceptions import StopRequested
from rq.job import Job
from rq.serializers import JSONSerializer
from rq.timeouts import HorseMonitorTimeoutException
from rq.worker.base import WorkerStatus

from jobs.errors import JobError
from workers.context import Context
from workers.process import die_with_parent
from workers.watch import JobWatch, Verdict, death

log = logging.getLogger(__name__)

LOOK_EVERY_S = 1
RECOVERY_KEY = "sideband:recovery"
WORKER_TTL_S = 30
"""An idle worker leaves its blocking wait at half this time, to report itself and to look after the registries."""


class SidebandWorker(Worker):
    """A worker on one queue.

    The broker may come and go while a job runs: its errors are logged, the job goes on, the catalogue is told.
    """

    max_connection_wait_time = 2.0

    def __init__(self, context: Context) -> None:
        self._context = context
        self._watch = JobWatch(context)
        self._stop_at: float | None = None
        super().__init__(
            context.stores.queue.queues,
            name=context.name,
            connection=context.stores.queue.connection,
            serializer=JSONSerializer,
            worker_ttl=WORKER_TTL_S,
            job_monitoring_interval=LOOK_EVERY_S,
            maintenance_interval=context.settings.maintenance_s,
            log_job_description=False,
        )

    def heartbeat(self, timeout: int | None = None, pipeline: Pipeline | None = None) -> None:
        """Tell the broker and the catalogue that this worker lives."""
        try:
            super().heartbeat(timeout, pipeline)
        finally:  # also while the broker is away: the job goes on
            self._watch.report("busy" if self._horse_pid else "idle")

    def run_maintenance_tasks(self) -> None:
        """The broker's registries, and one pass of recovery over the catalogue, if no other worker makes one now."""
        super().run_maintenance_tasks()  # type: ignore[no-untyped-call]
        if self._my_turn():
            self._watch.recover()

    def _my_turn(self) -> bool:
        """One worker of all in each interval: a thousand of them would ask catalogue and broker for nothing else."""
        try:
            soon = max(1, int(self._context.settings.maintenance_s) - 1)
            return bool(self.connection.set(RECOVERY_KEY, self.name, nx=True, ex=soon))
        except RedisError:
            return True

    def main_work_horse(self, job: Job, queue: Queue) -> None:
        """In the forked child: end with the worker, whatever happens to it."""
        die_with_parent(signal.SIGKILL, self.pid or os.getppid())
        super().main_work_horse(job, queue)

    @property
    def asked_to_stop(self) -> bool:
        """Whether the loop ended because someone asked."""
        return self._stop_at is not None

    def monitor_work_horse(self, job: Job, queue: Queue) -> None:
        """Wait for the child; once a second renew the lease and see whether the job should go on."""
        job_id, attempt = cast(tuple[str, int], tuple(job.args))
        self._watch.begin(job_id, attempt)
        status: int | None = None
        while True:
            try:
                with self.death_penalty_class(LOOK_EVERY_S, HorseMonitorTimeoutException):
                    _, status, _ = self.wait_for_horse()
                break
            except HorseMonitorTimeoutException:
                self._look_after(job)
            except InterruptedError:
                continue
        self._horse_pid = 0
        self._watch.ended(status)
        if status != os.EX_OK:
            self._tell_broker(job, queue, status)

    def _look_after(self, job: Job) -> None:
        try:
            self.maintain_heartbeats(job)
        except RedisError as error:
            log.warning("the broker does not answer, the job goes on: %s", error)
        overdue = self._stop_at is not None and time.monotonic() >= self._stop_at
        verdict = self._watch.look(leaving=overdue)
        if verdict is not Verdict.GO_ON:
            log.warning("stopping the work on %s: %s", job.id, verdict.value)
            self.kill_horse()

    def _tell_broker(self, job: Job, queue: Queue, status: int | None) -> None:
        try:
            self.handle_job_failure(job, queue=queue, exc_string=death(status).message)
        except RedisError as error:
            log.warning("the broker does not answer: %s", error)

    def request_stop(self, signum: int, frame: FrameType | None) -> None:  # noqa: ARG002 - a signal handler's form
        """Leave: at once when idle, after a grace when busy; asked again, at once."""
        now = time.monotonic()
        self._stop_at = now if self._stop_at is not None else now + self._context.settings.shutdown_grace_s
        self._stop_requested = True
        if self._state != WorkerStatus.BUSY and not self._horse_pid:
            raise StopRequested

    def teardown(self) -> None:
        """Leave the lists of workers; a broker that is away finds out by itself."""
        try:
            super().teardown()  # type: ignore[no-untyped-call]
        except (RedisError, JobError) as error:
            log.warning("could not sign off: %s", error)
        self._watch.sign_off()
