"""Sourced data tables: chain and rope, drag coefficients, safety factors."""
