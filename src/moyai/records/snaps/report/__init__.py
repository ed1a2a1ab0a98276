"""Report of ``moyai measure snaps``."""
