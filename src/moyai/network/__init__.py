"""Networks of lines and nets in free arrangement: at rest, their modes, their motion in waves and current."""
