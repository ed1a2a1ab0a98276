"""The curtain in a steady current: section, plan, drag, load laws and the governing steady load."""
