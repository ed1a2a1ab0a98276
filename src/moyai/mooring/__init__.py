"""Moorings at rest: exact elastic catenary, line systems, stiffness."""
