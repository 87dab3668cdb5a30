"""`/v1/machines`: the machines that recordings name, and their health over time. Kept features are read, none made."""

from __future__ import annotations

from typing import Annotated

from fastapi import APIRouter, Path, Query, Request, Response
from pydantic import AwareDatetime

from app.machine_views import (
    HealthOverTime,
    MachinePage,
    alarm_view,
    machine_view,
    point_view,
    trend_view,
    verdict_view,
)
from app.paging import mark_of, read_cursor, relative
from app.routes.responses import problems
from app.state import State
from jobs.health.machines import alarms_at, chosen, machine_names, trends
from jobs.health.rules import LEAST_BASELINES
from jobs.health.verdicts import verdicts_of
from sim.core.errors import Problem, SpecError, UnknownName

router = APIRouter(tags=["machines"])
ADDRESS = "/v1/machines"
MOST_VERDICTS = 10
MachineName = Annotated[str, Path(min_length=1, max_length=80)]
Names = Annotated[list[str] | None, Query(max_length=100)]


@router.get(ADDRESS, response_model=MachinePage, responses=problems(401, 422, 503))
def list_machines(
    request: Request,
    response: Response,
    state: State,
    limit: Annotated[int, Query(ge=1, le=200)] = 50,
    cursor: Annotated[str | None, Query(max_length=120, description="A name: the page begins behind it.")] = None,
) -> MachinePage:
    """Machines by name, with how many recordings there are, the latest one's time and state, and the worst state."""
    response.headers["Cache-Control"] = "no-store"
    names = machine_names(state.stores.catalogue)
    page = [name for name in names if cursor is None or name > cursor][:limit]
    following = None
    if page and page[-1] != names[-1]:
        following = relative(request.url.include_query_params(cursor=page[-1]))
        response.headers["Link"] = f'<{following}>; rel="next"'
    stores = state.stores
    seen = [state.watch.machine(stores.catalogue, stores.artefacts, name) for name in page]
    return MachinePage(machines=[machine_view(machine) for machine in seen], total=len(names), next=following)


@router.get(f"{ADDRESS}/{{name}}/health", response_model=HealthOverTime, responses=problems(401, 404, 422, 503))
def get_health(
    request: Request,
    response: Response,
    name: MachineName,
    state: State,
    start: Annotated[AwareDatetime | None, Query(alias="from", description="Recordings taken then or later.")] = None,
    end: Annotated[AwareDatetime | None, Query(alias="to", description="Recordings taken then or earlier.")] = None,
    channel: Names = None,
    feature: Names = None,
    limit: Annotated[int, Query(ge=1, le=500)] = 100,
    cursor: Annotated[str | None, Query(max_length=300)] = None,
) -> HealthOverTime:
    """Features over a machine's recordings with the limits they are held against, alarms, and last verdicts.

    A page holds the latest `limit` recordings in the order of time; `next` is the address of those before.
    """
    response.headers["Cache-Control"] = "no-store"
    stores, channels, features = state.stores, channel or [], feature or []
    machine = state.watch.machine(stores.catalogue, stores.artefacts, name)
    for unknown in (c for c in channels if c not in machine.channels):
        raise UnknownName("channel", unknown, machine.channels)
    if start is not None and end is not None and start > end:
        raise SpecError(Problem(field="from", message="lies after `to`", given=start.isoformat(), allowed="<= to"))
    inside = chosen(machine, start.timestamp() if start else None, end.timestamp() if end else None)
    before = None if cursor is None else read_cursor(cursor)
    older = [i for i in inside if before is None or (machine.points[i].time, machine.points[i].recording) < before]
    places = older[-limit:]
    following = None
    if len(older) > len(places):
        first = machine.points[places[0]]
        following = relative(request.url.include_query_params(cursor=mark_of(first.time, first.recording)))
        response.headers["Link"] = f'<{following}>; rel="next"'
    used = frozenset(p.recording for p in machine.points)
    return HealthOverTime(
        machine=name,
        state=machine.state,
        worst=machine.worst,
        baselines_needed=LEAST_BASELINES,
        channels=list(machine.channels),
        total=len(inside),
        points=[point_view(machine.points[i], machine.assessments[i]) for i in places],
        series=[trend_view(trend) for trend in trends(machine, places, channels, features)],
        alarms=[alarm_view(alarm) for alarm in alarms_at(machine, places, channels, features)],
        verdicts=[verdict_view(v) for v in verdicts_of(stores.catalogue, stores.artefacts, used, MOST_VERDICTS)],
        next=following,
    )
