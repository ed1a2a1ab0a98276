"""Forces on slender members: ideal inertia coefficients, Morison forces, the circulation of orbital flow."""
