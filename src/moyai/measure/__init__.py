"""Measured records: reading them, harmonics of periodic motion, incident and reflected waves."""
