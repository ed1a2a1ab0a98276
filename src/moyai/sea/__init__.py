"""Water and site, dispersion, waves, spectra, irregular seas, kinematics, currents."""
