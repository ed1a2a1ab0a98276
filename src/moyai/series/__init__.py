"""Time series: what is found in any record or simulation."""
