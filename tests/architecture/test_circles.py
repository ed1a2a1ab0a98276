"""No module imports itself by way of others; imports in functions and for a type checker alone count as well."""

from __future__ import annotations

from collections.abc import Iterable, Mapping

from source_files import FILES, SOURCE, findings, findings_of_text


def module_of(path) -> str:
    parts = path.relative_to(SOURCE.parent).with_suffix("").parts
    return ".".join(parts[:-1] if parts[-1] == "__init__" else parts)


MODULES = {module_of(path): path for path in FILES}


def imports_of(module: str, imported: Iterable[str]) -> set[str]:
    """Return the modules of the product among the names that one imports."""
    found = set()
    for name in imported:
        while name and name not in MODULES:
            name = name.rpartition(".")[0]
        found |= {name} - {"", module}
    return found


def circles(imports: Mapping[str, set[str]]) -> list[set[str]]:
    """Return the groups of modules each of which reaches every other (Kosaraju)."""
    order: list[str] = []
    seen: set[str] = set()
    for start in imports:
        if start in seen:
            continue
        seen.add(start)
        path = [(start, iter(sorted(imports[start])))]
        while path:
            module, further = path[-1]
            following = next((one for one in further if one not in seen), None)
            if following is None:
                order.append(module)
                path.pop()
            else:
                seen.add(following)
                path.append((following, iter(sorted(imports.get(following, set())))))
    back: dict[str, set[str]] = {}
    for module, targets in imports.items():
        for target in targets:
            back.setdefault(target, set()).add(module)
    found, taken = [], set()
    for module in reversed(order):
        group, open_ones = set(), [module]
        while open_ones:
            one = open_ones.pop()
            if one not in taken:
                taken.add(one)
                group.add(one)
                open_ones += back.get(one, set())
        if len(group) > 1:
            found.append(group)
    return found


def test_no_module_imports_itself_by_way_of_others() -> None:
    imports = {module: imports_of(module, findings()[path].imported) for module, path in MODULES.items()}
    assert [sorted(group) for group in circles(imports)] == []


def test_the_check_sees_a_circle() -> None:
    text = "from typing import TYPE_CHECKING\nif TYPE_CHECKING:\n    from moyai.sea.water import Water\n"
    for each in (text, "def late():\n    import moyai.sea.water\n", "from .water import Water\n"):
        imported = findings_of_text(each, ("sea", "imaginary.py")).imported
        assert imports_of("moyai.sea.imaginary", imported) == {"moyai.sea.water"}
    assert circles({"a": {"b"}, "b": {"c"}, "c": {"b"}}) == [{"b", "c"}]
