"""Silt curtains: statics, impact tension, waves, anchor loads."""
