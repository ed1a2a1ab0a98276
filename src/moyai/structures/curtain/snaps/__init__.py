"""Snaps in irregular seas: events, the flow that makes them, their statistics."""
