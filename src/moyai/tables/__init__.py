"""Sourced data tables: chain and rope, drag coefficients, safety factors.

Every table is a text file in ``data/`` with meaning of columns, sources and ranges on top, read by
:mod:`moyai.tables.reader`, and one module that turns its rows into objects with units in their names.
"""
