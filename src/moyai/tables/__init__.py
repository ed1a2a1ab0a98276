"""Sourced data tables: chain and rope, drag coefficients, safety factors.

Every table is a text file in ``data/`` with meaning of columns, sources and ranges on top, read by
:mod:`moyai.tables.reader`, and one module that turns its rows into objects with units in their names.
"""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.tables.design_codes import CodeRule as CodeRule
    from moyai.tables.design_codes import available_codes as available_codes
    from moyai.tables.lines import LineProperties as LineProperties
    from moyai.tables.lines import available_line_types as available_line_types
    from moyai.tables.lines import line_type as line_type
    from moyai.tables.nets import NetMaterial as NetMaterial
    from moyai.tables.nets import available_net_materials as available_net_materials
    from moyai.tables.nets import net_material as net_material
    from moyai.tables.waters import WaterProperties as WaterProperties
    from moyai.tables.waters import available_waters as available_waters
    from moyai.tables.waters import water_properties as water_properties
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "design_codes": "CodeRule available_codes",
            "lines": "LineProperties available_line_types line_type",
            "nets": "NetMaterial available_net_materials net_material",
            "waters": "WaterProperties available_waters water_properties",
        },
    )
