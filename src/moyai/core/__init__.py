"""Foundation of the house: errors, validity notices, identity checks, quantities, results, progress."""
