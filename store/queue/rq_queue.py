"""`jobs.ports.Queue` on RQ over Redis or Valkey.

Tickets are JSON, never pickle. The broker's job id holds the attempt, so a message about an earlier attempt can
never be mistaken for a later one.
"""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager

from redis import Redis
from redis.backoff import ExponentialBackoff
from redis.exceptions import ConnectionError as RedisConnectionError
from redis.exceptions import RedisError
from redis.retry import Retry
from rq import Queue
from rq.exceptions import NoSuchJobError
from rq.job import Job, JobStatus
from rq.serializers import JSONSerializer

from jobs.errors import BrokerAway
from jobs.ports import Lane, Ticket

QUEUE_NAME = "sideband"
ENTRY_POINT = "workers.entry.run_job"
KEPT_S = 300
"""How long the broker remembers a finished ticket: only its own bookkeeping needs it."""
CLAIM_S = 15.0
"""Longest time between taking a ticket and claiming its job; afterwards the ticket is given out again."""


def connect(url: str, *, timeout_s: float = 2.0) -> Redis:
    """A client that gives up after `timeout_s` instead of holding a request."""
    return Redis.from_url(
        url,
        socket_connect_timeout=timeout_s,
        socket_timeout=timeout_s,
        retry=Retry(ExponentialBackoff(cap=0.2, base=0.05), 1),
        health_check_interval=15,
    )


class RqQueue:
    """Hands tickets to the workers."""

    def __init__(self, connection: Redis, name: str = QUEUE_NAME) -> None:
        self._connection = connection
        self._lanes = {
            lane: Queue(f"{name}-{lane.value}".rstrip("-"), connection=connection, serializer=JSONSerializer)
            for lane in Lane
        }

    @property
    def connection(self) -> Redis:
        """The broker's client."""
        return self._connection

    @property
    def queues(self) -> list[Queue]:
        """The queues as workers listen to them: each is drawn from when those before it are empty."""
        return list(self._lanes.values())

    def _lane(self, ticket: Ticket) -> Queue:
        return self._lanes[ticket.lane]

    def ping(self) -> None:
        """Raise BrokerAway unless the server answers and can write."""
        with _translated():
            self._connection.ping()

    def submit(self, ticket: Ticket) -> None:
        """Put the ticket at the end of the queue. A second copy does no harm: it is taken once."""
        with _translated():
            self._lane(ticket).enqueue_call(
                ENTRY_POINT,
                args=(ticket.job_id, ticket.attempt),
                job_id=name_of(ticket),
                timeout=ticket.timeout_s,
                result_ttl=KEPT_S,
                failure_ttl=KEPT_S,
                description=f"{ticket.job_id} attempt {ticket.attempt}",
            )

    def holds(self, ticket: Ticket) -> bool:
        """Whether the broker knows the ticket and has not finished with it."""
        with _translated():
            try:
                job = Job.fetch(name_of(ticket), connection=self._connection, serializer=JSONSerializer)
            except NoSuchJobError:
                return False
            status = job.get_status(refresh=False)
            if status is JobStatus.QUEUED:
                return self._listed(self._lane(ticket), job.id)
            return status is JobStatus.STARTED and _fresh(job)

    def _listed(self, queue: Queue, name: str) -> bool:
        """In the queue, or between it and a worker; both asked at one moment."""
        with self._connection.pipeline(transaction=True) as pipeline:
            pipeline.lpos(queue.key, name)
            pipeline.lpos(queue.intermediate_queue_key, name)
            return any(place is not None for place in pipeline.execute())

    def withdraw(self, ticket: Ticket) -> None:
        """Take the ticket out, if it is there."""
        with _translated():
            self._lane(ticket).remove(name_of(ticket))

    def length(self) -> int:
        """Number of tickets waiting."""
        with _translated():
            return sum(int(queue.count) for queue in self.queues)


def _fresh(job: Job) -> bool:
    """Whether a worker has only just taken the ticket: it is about to claim the job, or died trying."""
    return job.started_at is not None and time.time() - job.started_at.timestamp() < CLAIM_S


def name_of(ticket: Ticket) -> str:
    """The broker's id of a ticket."""
    return f"{ticket.job_id}-{ticket.attempt}"


@contextmanager
def _translated() -> Iterator[None]:
    try:
        yield
    except (RedisConnectionError, TimeoutError) as error:
        raise BrokerAway(f"the broker does not answer ({type(error).__name__})") from error
    except RedisError as error:
        raise BrokerAway(f"the broker refused: {error}") from error
