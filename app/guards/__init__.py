"""ASGI guards in front of the routes: who may call, what a body may be, which headers a reply carries."""
