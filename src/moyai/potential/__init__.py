"""Two-dimensional linear potential theory: sections, boundary integrals, radiation, diffraction, memory, drift."""
