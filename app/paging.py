"""Pages of lists: cursors that hold their place while rows come and go."""

from __future__ import annotations

import base64
import json

from starlette.datastructures import URL

from jobs.record import JobRecord
from sim.core.errors import Problem, SpecError


def cursor_of(record: JobRecord, field: str) -> str:
    """Where a page ended that is sorted by `field`."""
    return mark_of(getattr(record, field), record.id)


def mark_of(value: float, name: str) -> str:
    """The same of any row: its sort value, and a name that tells it from others of that value."""
    text = json.dumps([value, name])
    return base64.urlsafe_b64encode(text.encode()).decode().rstrip("=")


def read_cursor(cursor: str) -> tuple[float, str]:
    """The sort value and id in a cursor."""
    try:
        padded = cursor + "=" * (-len(cursor) % 4)
        value, job_id = json.loads(base64.urlsafe_b64decode(padded))
        return float(value), str(job_id)
    except (ValueError, TypeError) as error:
        message = "is not a cursor of this list"
        raise SpecError(Problem(field="cursor", message=message, given=cursor, allowed="as in `next`")) from error


def relative(url: URL) -> str:
    """The address without the server."""
    return f"{url.path}?{url.query}"
