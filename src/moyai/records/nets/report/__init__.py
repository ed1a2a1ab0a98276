"""Report of net tests."""
