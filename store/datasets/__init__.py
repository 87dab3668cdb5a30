"""Finished datasets in an object store."""
