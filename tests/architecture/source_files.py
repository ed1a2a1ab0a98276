"""The modules of the package, each parsed once for all rules on their text."""

from __future__ import annotations

import ast
import functools
import re
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from kept_runs import kept_value

SOURCE = Path(__file__).resolve().parents[2] / "src" / "moyai"
FILES = sorted(SOURCE.rglob("*.py"))
FORBIDDEN_IN_KERNELS = {"print", "open", "input", "read_text", "write_text", "warn", "savefig", "to_netcdf"}
COMPILED = {"njit", "jit", "vectorize", "guvectorize"}
# Packages whose business is to talk to files or people
TALKERS = {"cli", "app"}
ERRORS = {"InputError", "ConvergenceError", "MoyaiError"}
#: Blocks that only case files have; a key in degrees is one of theirs too.
OF_CASE_FILES = re.compile(r"^(structure|site|analyses|assess|display)\.|\w_deg\b")
#: A path of keys of a case file within a sentence.
PATH_OF_KEYS = re.compile(r"\b(structure|site|settings|analyses|assess|display)\.[a-z_]+|\b[a-z]\w*_deg\b")


@dataclass(frozen=True)
class Findings:
    """What one module imports, and where it breaks a rule: lines with what stands there."""

    imports: tuple[tuple[str, int], ...]
    imported: frozenset[str]
    keys_of_files: tuple[str, ...]
    kernels_that_talk: tuple[str, ...]
    prints: tuple[str, ...]
    mutable_dataclasses: tuple[str, ...]
    mutable_models: tuple[str, ...]
    bare_excepts: tuple[str, ...]
    empty_conditions: tuple[str, ...]
    classes: tuple[str, ...]
    lists_of_fields: tuple[str, ...]
    texts: tuple[tuple[int, str], ...]
    #: Name and lines of every function, its description not counted.
    functions: tuple[tuple[str, int], ...]


def called_name(node: ast.expr) -> str:
    node = node.func if isinstance(node, ast.Call) else node
    return node.attr if isinstance(node, ast.Attribute) else getattr(node, "id", "")


def _calls(nodes: list[ast.AST], names: set[str]) -> Iterator[str]:
    for node in nodes:
        if isinstance(node, ast.Call) and called_name(node) in names:
            yield f"line {node.lineno}: {called_name(node)}()"


def _frozen(decorator: ast.expr) -> bool:
    return isinstance(decorator, ast.Call) and any(
        keyword.arg == "frozen" and isinstance(keyword.value, ast.Constant) and keyword.value.value is True
        for keyword in decorator.keywords
    )


def _imported(nodes: list[ast.AST], package: list[str]) -> Iterator[str]:
    """Give the full names of all that a file imports, wherever the statement stands."""
    for node in nodes:
        if isinstance(node, ast.Import):
            yield from (alias.name for alias in node.names)
        elif isinstance(node, ast.ImportFrom):
            base = package[: len(package) - node.level + 1] if node.level else []
            stem = [*base, *([node.module] if node.module else [])]
            yield from (".".join([*stem, alias.name]) for alias in node.names)


def _descriptions(nodes: list[ast.AST]) -> set[int]:
    """Return what stands as a statement of its own: descriptions, which no user of a case file reads."""
    return {id(node.value) for node in nodes if isinstance(node, ast.Expr)}


def _keys_of_files(nodes: list[ast.AST]) -> Iterator[str]:
    """Give the errors that name a path or a key of a case file, and the sentences that name a path."""
    descriptions = _descriptions(nodes)
    for node in nodes:
        if not isinstance(node, ast.Constant) or not isinstance(node.value, str) or id(node) in descriptions:
            continue
        if " " in node.value and (found := PATH_OF_KEYS.search(node.value)):
            yield f"line {node.lineno}: the sentence names the key '{found[0]}'"
    for node in nodes:
        if not isinstance(node, ast.Call) or called_name(node) not in ERRORS:
            continue
        for keyword in node.keywords:
            if keyword.arg == "path":
                yield f"line {node.lineno}: {called_name(node)}(path=...) instead of parameter=..."
            if keyword.arg == "parameter":
                for part in ast.walk(keyword.value):
                    if isinstance(part, ast.Constant) and OF_CASE_FILES.search(str(part.value)):
                        yield f"line {node.lineno}: '{part.value}' is a key of case files"


def _imports(nodes: list[ast.AST], package: list[str]) -> Iterator[tuple[str, int]]:
    """Give all modules that a file imports, wherever the statement stands, with their line."""
    for node in nodes:
        if isinstance(node, ast.Import):
            for alias in node.names:
                yield alias.name, node.lineno
        elif isinstance(node, ast.ImportFrom):
            if node.level:
                base = package[: len(package) - node.level + 1]
                module = ".".join([*base, *([node.module] if node.module else [])])
            else:
                module = node.module or ""
            yield module, node.lineno
            if module == "moyai":
                for alias in node.names:
                    yield f"moyai.{alias.name}", node.lineno
        elif (
            isinstance(node, ast.Call)
            and called_name(node) in ("import_module", "__import__")
            and node.args
            and isinstance(node.args[0], ast.Constant)
        ):
            yield str(node.args[0].value), node.lineno


def _functions(node: ast.AST) -> Iterator[tuple[str, int]]:
    """Give the functions of a module with their lines; the name of an inner one begins with that of the outer one."""
    for child in ast.iter_child_nodes(node):
        own = getattr(child, "name", "") if isinstance(child, ast.FunctionDef | ast.ClassDef) else ""
        if isinstance(child, ast.FunctionDef):
            first = child.body[0]
            described = ast.get_docstring(child) is not None
            description = (first.end_lineno or 0) - first.lineno + 1 if described else 0
            yield own, (child.end_lineno or 0) - child.lineno + 1 - description
        yield from ((f"{own}.{name}" if own else name, lines) for name, lines in _functions(child))


def findings_of_text(text: str, parts: tuple[str, ...]) -> Findings:
    """Examine one module; ``parts`` is its path below the package.

    A dataclass whose name starts with an underscore, a private record that a reader fills while it reads, may change.
    Pydantic models inherit ``frozen`` from the base of the schema; that base must say so.
    """
    tree = ast.parse(text)
    nodes = list(ast.walk(tree))
    kernels: list[str] = []
    dataclasses: list[str] = []
    models: list[str] = []
    bare: list[str] = []
    empty: list[str] = []
    classes: list[str] = []
    lists: list[str] = []
    for node in nodes:
        if isinstance(node, ast.FunctionDef):
            if COMPILED & {called_name(decorator) for decorator in node.decorator_list}:
                kernels += _calls(list(ast.walk(node)), FORBIDDEN_IN_KERNELS)
        elif isinstance(node, ast.ClassDef):
            classes.append(node.name)
            if any(called_name(decorator) == "dataclass" for decorator in node.decorator_list):
                lists += [node.name] * ("Parameters\n-----" in (ast.get_docstring(node) or ""))
            if not node.name.startswith("_"):
                for decorator in node.decorator_list:
                    if called_name(decorator) == "dataclass" and not _frozen(decorator):
                        dataclasses.append(f"line {node.lineno}: {node.name}")
            of_schema = any(getattr(base, "id", "") == "BaseModel" for base in node.bases)
            if of_schema and "frozen=True" not in ast.unparse(node):
                models.append(f"line {node.lineno}: {node.name}")
        elif isinstance(node, ast.ExceptHandler) and node.type is None:
            bare.append(f"line {node.lineno}")
        elif isinstance(node, ast.If) and all(isinstance(statement, ast.Pass) for statement in node.body):
            empty.append(f"line {node.lineno}: if {ast.unparse(node.test)}: pass")
    prints = () if parts[0] in TALKERS else tuple(_calls(nodes, {"print", "breakpoint", "set_trace"}))
    imports = tuple(_imports(nodes, ["moyai", *parts[:-1]]))
    texts = tuple(
        (node.lineno, node.value)
        for node in nodes
        if isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value
    )
    return Findings(
        imports,
        frozenset(_imported(nodes, ["moyai", *parts[:-1]])),
        tuple(_keys_of_files(nodes)),
        tuple(kernels),
        prints,
        tuple(dataclasses),
        tuple(models),
        tuple(bare),
        tuple(empty),
        tuple(classes),
        tuple(lists),
        texts,
        tuple(_functions(tree)),
    )


@functools.cache
def findings() -> dict[Path, Findings]:
    """Examine every module of the package, once for all workers."""
    own = Path(__file__).read_text(encoding="utf-8")
    return kept_value(own, lambda: {path: _findings_of(path) for path in FILES})  # type: ignore[no-any-return]


def _findings_of(path: Path) -> Findings:
    return findings_of_text(path.read_text(encoding="utf-8"), path.relative_to(SOURCE).parts)
