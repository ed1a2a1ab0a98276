"""The unit in the frequency domain: operators, regular and irregular seas."""
