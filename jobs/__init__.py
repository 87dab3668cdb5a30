"""Use cases over typed requests; ports for queue and store."""
