"""Puts compiled kernels into a wheel for one system and version of Python, where MOYAI_KERNELS names their folder."""

import os
from typing import Any

from hatchling.builders.hooks.plugin.interface import BuildHookInterface


class KernelsHook(BuildHookInterface):
    """Takes the folder of ``python -m moyai.core.shipped_kernels`` into the wheel."""

    def initialize(self, version: str, build_data: dict[str, Any]) -> None:
        """Add the folder; without it the wheel is one for all systems."""
        folder = os.environ.get("MOYAI_KERNELS")
        if folder and version != "editable":
            build_data["pure_python"], build_data["infer_tag"] = False, True
            build_data["force_include"][folder] = "moyai/compiled_kernels"
