"""Impact when a slack curtain becomes taut, and cycles of slack and taut in waves."""
