"""The broker: tickets on an RQ queue."""
