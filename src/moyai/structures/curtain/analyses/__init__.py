"""The analyses of a curtain case, one file each."""
