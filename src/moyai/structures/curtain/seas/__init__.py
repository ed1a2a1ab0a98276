"""What sea states mean for a curtain: squared velocity, anchor energy, wave loads."""
