"""Report of a survey."""
