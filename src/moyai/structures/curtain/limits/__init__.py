"""Up to which current and wave height a curtain holds."""
