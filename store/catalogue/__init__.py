"""The system of record: jobs, their events, idempotency keys and workers, on SQLAlchemy Core."""
