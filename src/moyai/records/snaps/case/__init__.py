"""Files of ``moyai measure snaps``: schema, and the runs that they state."""
