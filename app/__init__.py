"""HTTP service, dashboard and command line."""
