"""Points and bodies that hang on one anchor alone: they lie anywhere in the circle of their slack line."""

from __future__ import annotations

from moyai.structures.network.model import NetworkProblem


def single_anchors(problem: NetworkProblem) -> dict[str, str]:
    """Return the only fixed point that each free point or body is tied to, by its name.

    What nets, sheets or driven points hold is left out: it has a place of its own.
    """
    if problem.nets or problem.sheets:
        return {}
    parts: dict[str, set[str]] = {}

    def join(one: str, other: str) -> None:
        merged = parts.get(one, {one}) | parts.get(other, {other})
        parts.update(dict.fromkeys(merged, merged))

    for body in problem.bodies:
        join(body.name, body.name)
        for point in body.points:
            join(body.name, point)
    for line in problem.lines:
        join(line.start, line.end)
    kinds = {point.name: point.kind for point in problem.points}
    movable = [*(point.name for point in problem.points if point.kind == "free"), *(b.name for b in problem.bodies)]
    found = {}
    for name in movable:
        held = [other for other in parts.get(name, ()) if kinds.get(other, "free") != "free"]
        if len(held) == 1 and kinds[held[0]] == "fixed":
            found[name] = held[0]
    return found
