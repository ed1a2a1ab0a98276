"""Kernels neither read nor write; problem, case and result objects are frozen; nobody prints or debugs."""

import ast
from pathlib import Path

import pytest

SOURCE = Path(__file__).resolve().parents[2] / "src" / "moyai"
FILES = sorted(SOURCE.rglob("*.py"))
NAMES = [str(path.relative_to(SOURCE)) for path in FILES]
FORBIDDEN_IN_KERNELS = {"print", "open", "input", "read_text", "write_text", "warn", "savefig", "to_netcdf"}
# Rooms whose business is to talk to files or people
TALKERS = {"cli", "app"}


def tree_of(path):
    return ast.parse(path.read_text(encoding="utf-8"))


def decorator_name(node):
    node = node.func if isinstance(node, ast.Call) else node
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def calls(node):
    for inner in ast.walk(node):
        if isinstance(inner, ast.Call):
            yield decorator_name(inner), inner.lineno


@pytest.mark.parametrize("path", FILES, ids=NAMES)
def test_compiled_kernels_do_no_input_or_output(path):
    wrong = []
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.FunctionDef):
            decorators = {decorator_name(decorator) for decorator in node.decorator_list}
            if decorators & {"njit", "jit", "vectorize", "guvectorize"}:
                wrong += [f"line {line}: {name}()" for name, line in calls(node) if name in FORBIDDEN_IN_KERNELS]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("path", FILES, ids=NAMES)
def test_physics_does_not_print(path):
    room = path.relative_to(SOURCE).parts[0]
    if room in TALKERS:
        return
    tree = tree_of(path)
    wrong = [f"line {line}: {name}()" for name, line in calls(tree) if name in ("print", "breakpoint", "set_trace")]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("path", FILES, ids=NAMES)
def test_dataclasses_are_frozen(path):
    """Public ones; a private record that a reader fills while it reads may change."""
    wrong = []
    for node in ast.walk(tree_of(path)):
        if not isinstance(node, ast.ClassDef) or node.name.startswith("_"):
            continue
        for decorator in node.decorator_list:
            if decorator_name(decorator) != "dataclass":
                continue
            frozen = isinstance(decorator, ast.Call) and any(
                keyword.arg == "frozen" and isinstance(keyword.value, ast.Constant) and keyword.value.value is True
                for keyword in decorator.keywords
            )
            if not frozen:
                wrong.append(f"line {node.lineno}: {node.name}")
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("path", FILES, ids=NAMES)
def test_schema_models_are_frozen(path):
    """Pydantic models inherit ``frozen`` from the base of the schema; that base must say so."""
    for node in ast.walk(tree_of(path)):
        if isinstance(node, ast.ClassDef) and any(getattr(base, "id", "") == "BaseModel" for base in node.bases):
            text = ast.unparse(node)
            assert "frozen=True" in text, f"line {node.lineno}: {node.name} derives from BaseModel and is not frozen"


@pytest.mark.parametrize("path", FILES, ids=NAMES)
def test_no_bare_except(path):
    wrong = [
        f"line {node.lineno}"
        for node in ast.walk(tree_of(path))
        if isinstance(node, ast.ExceptHandler) and node.type is None
    ]
    assert not wrong, "\n".join(wrong)
