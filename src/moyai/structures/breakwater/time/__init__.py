"""The unit in the time domain: regular and irregular seas."""
