"""Published and exact cases, one module a topic, each with a tuple ``CASES``; ``moyai validate`` runs them all."""
