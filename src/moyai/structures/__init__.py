"""Structures: one folder each, with its case, its model, its analyses, its report and its template."""
