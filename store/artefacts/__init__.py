"""Where results lie. A folder by default; an object store can take its place behind `jobs.ports.ArtefactStore`."""
