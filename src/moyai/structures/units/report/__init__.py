"""The report of a floating row of units."""
