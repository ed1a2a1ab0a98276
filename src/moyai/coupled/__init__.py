"""Bodies hung in flexible networks: floating, moored and towed bodies on lines that have mass, drag and snap."""
