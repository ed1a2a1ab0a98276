"""Files of other programs: coefficients of three-dimensional bodies, in the names and signs of this house."""
