"""Case files: schema, reader, builder. The only place that knows YAML, degrees and file paths."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.case.builder import build as build
    from moyai.case.derived import Number as Number
    from moyai.case.reader import Case as Case
    from moyai.case.reader import case_of as case_of
    from moyai.case.reader import derived_numbers as derived_numbers
    from moyai.case.reader import load_case as load_case
    from moyai.case.schema import json_schema as json_schema
    from moyai.case.schema import root_schema as root_schema
    from moyai.case.schema_types import Block as Block
    from moyai.case.templates import template as template
    from moyai.case.yaml_reader import CaseDocument as CaseDocument
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "builder": "build",
            "derived": "Number",
            "reader": "Case case_of derived_numbers load_case",
            "schema": "json_schema root_schema",
            "schema_types": "Block",
            "templates": "template",
            "yaml_reader": "CaseDocument",
        },
    )
