"""Laws of the force of water on nets, one file each: formula, source, range, what happens outside it."""
