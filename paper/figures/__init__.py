"""Pictures of the page, one file a group."""
