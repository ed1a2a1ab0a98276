"""Series in time: waves, harmonics, spectra, snaps, cycles and extremes of what was measured or simulated."""
