"""What was charged to holders of API keys, kept for a day."""

from __future__ import annotations

import zlib

from sqlalchemy import BigInteger, Connection, Engine, delete, func, insert, literal, select

from jobs.budget import WINDOW_S, Charge, wait_s
from jobs.errors import BudgetSpent, BudgetTooSmall
from store.catalogue import schema
from store.catalogue.engine import translated

_LOCK = 0x51DE << 32
"""Apart from other advisory locks; a holder's checksum is added."""


class SqlLedger:
    """`jobs.budget.Ledger` on the catalogue's database."""

    def __init__(self, engine: Engine) -> None:
        self._engine = engine

    def charge(self, charge: Charge, limit: float | None) -> int:
        """Keep a charge and return its number; raises BudgetSpent, BudgetTooSmall.

        Of two requests that come at once the second sees what the first was charged.
        """
        if limit is not None and charge.core_seconds > limit:
            raise BudgetTooSmall(limit=limit, asked=charge.core_seconds)
        table = schema.charges.c
        with translated(), self._engine.begin() as connection:
            if self._engine.dialect.name == "postgresql":
                lock = _LOCK + zlib.crc32(charge.holder.encode())
                connection.execute(select(func.pg_advisory_xact_lock(literal(lock, BigInteger()))))
            connection.execute(delete(schema.charges).where(table.time <= charge.time - WINDOW_S))
            if limit is not None:
                _check(connection, charge, limit)
            values = {name: getattr(charge, name) for name in Charge.__dataclass_fields__}
            statement = insert(schema.charges).values(values).returning(table.number)
            return int(connection.execute(statement).scalar_one())

    def refund(self, number: int) -> None:
        """Forget a charge."""
        with translated(), self._engine.begin() as connection:
            connection.execute(delete(schema.charges).where(schema.charges.c.number == number))

    def used(self, holder: str, now: float) -> float:
        """Core-seconds charged to a holder in the day before `now`."""
        with translated(), self._engine.execution_options(read_only=True).connect() as connection:
            return _used(connection, holder, now)


def _used(connection: Connection, holder: str, now: float) -> float:
    table = schema.charges.c
    mine = (table.holder == holder, table.time > now - WINDOW_S)
    return float(connection.execute(select(func.sum(table.core_seconds)).where(*mine)).scalar() or 0.0)


def _check(connection: Connection, charge: Charge, limit: float) -> None:
    used = _used(connection, charge.holder, charge.time)
    if used + charge.core_seconds <= limit:
        return
    table = schema.charges.c
    mine = select(table.time, table.core_seconds).where(table.holder == charge.holder).order_by(table.time)
    charges = [(float(row.time), float(row.core_seconds)) for row in connection.execute(mine)]
    wait = wait_s(charges, charge.core_seconds, limit, charge.time)
    raise BudgetSpent(limit=limit, used=used, asked=charge.core_seconds, retry_after_s=wait)
