"""Many cases at once: variations of a base case, run here or on a cluster, and what comes out of them together."""
