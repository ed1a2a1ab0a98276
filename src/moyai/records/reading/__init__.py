"""Reading of measured files: sources, text, arrays, clocks, sensors, quality."""
