"""Physics names the parameters of its own calls; only readers of files and commands name keys and options."""

import ast
import re

from source_files import FILES, SOURCE, called_name

PHYSICS = {
    *("sea", "tables", "series", "potential", "morison", "mooring", "flexible", "floating", "coupled", "design"),
    *("structures", "records"),
}
ROLES = {"case", "report"}
ERRORS = {"InputError", "ConvergenceError", "MoyaiError"}
#: Blocks that only case files have; a key in degrees is one of theirs too.
OF_CASE_FILES = re.compile(r"^(structure|site|analyses|assess|display)\.|\w_deg\b")


def faults_of(text):
    for node in ast.walk(ast.parse(text)):
        if not isinstance(node, ast.Call) or called_name(node) not in ERRORS:
            continue
        for keyword in node.keywords:
            if keyword.arg == "path":
                yield f"line {node.lineno}: {called_name(node)}(path=...) instead of parameter=..."
            if keyword.arg == "parameter":
                for part in ast.walk(keyword.value):
                    if isinstance(part, ast.Constant) and OF_CASE_FILES.search(str(part.value)):
                        yield f"line {node.lineno}: '{part.value}' is a key of case files"


def test_physics_names_parameters_and_no_keys():
    wrong = []
    for path in FILES:
        parts = path.relative_to(SOURCE).parts
        if parts[0] in PHYSICS and not ROLES & set(parts):
            wrong += [f"{path.relative_to(SOURCE)}, {fault}" for fault in faults_of(path.read_text(encoding="utf-8"))]
    assert not wrong, "\n".join(wrong) + "\nwhere a parameter comes from in a case file, its case/keys.py says"


def test_the_check_sees_keys_and_paths():
    text = 'raise InputError("x", path="mass")\nraise InputError("x", parameter=f"structure.{name}")\n'
    assert len(list(faults_of(text + 'raise InputError("x", parameter="waves.heading_deg")\n'))) == 3
    assert not list(faults_of('raise InputError("x", parameter="lines.north.anchor")'))
