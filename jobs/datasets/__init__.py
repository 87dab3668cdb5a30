"""Datasets as jobs: divided into shards over all workers, put together when the last is done."""
