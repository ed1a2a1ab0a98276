"""The version of the package, below all that writes it down."""

VERSION = "0.2.0"
