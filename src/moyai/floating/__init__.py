"""Rigid floating bodies: statics, frequency domain, time domain with memory."""
