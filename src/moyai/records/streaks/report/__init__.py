"""Report of streak images."""
