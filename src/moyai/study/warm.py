"""What the workers of a study import and load first, once for all that are forked from one process."""

from __future__ import annotations

from importlib import import_module

from moyai.sea.dispersion import wave_number

for _name in ("moyai.study.work", "moyai.case.builder", "xarray", "scipy.interpolate"):
    import_module(_name)
wave_number(1.0, 10.0, 9.81)  # a kernel loads what numba knows of numpy
