"""Reports of submerged members."""
