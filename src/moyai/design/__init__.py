"""Design: similarity of models, extremes, utilisation against a code."""
