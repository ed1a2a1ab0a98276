"""What numba does again and again while it compiles, done once.

An operator between numbers has the same type each time; numba tries its rules for arrays first and rejects them each
time. Here the answer is kept for a set of argument types. Flags are compared by what was set. An array written into a
slice of another shape raises a fixed text: to put the shapes into words takes longer to compile than most kernels.
What a kernel computes does not change.
"""

from __future__ import annotations

from typing import Any

from numba.core.targetconfig import TargetConfig
from numba.core.types import Function
from numba.core.types.functions import BaseFunction
from numba.extending import overload
from numba.np import arrayobj

_search = BaseFunction.get_call_type
#: Identities of function and context and types of arguments, to the function, which stays alive, and the signature.
_kept: dict[tuple[Any, ...], tuple[Any, Any]] = {}


def _call_type(function: Any, context: Any, args: Any, kws: Any) -> Any:
    """Return the signature of a call, see numba's method; that of a rule without code of its own is kept."""
    if kws:
        return _search(function, context, args, kws)
    key = (id(function), id(context), *args)
    if key in _kept:
        return _kept[key][1]
    found = _search(function, context, args, kws)
    # rules that compile something say with each call what for
    if found is not None and function._impl_keys.get(found.args) is function.typing_key:
        _kept[key] = function, found
    return found


def _same_flags(one: Any, other: Any) -> Any:
    """Return whether all flags are equal; those that were not set have their default."""
    if not isinstance(other, TargetConfig):
        return NotImplemented
    if type(one) is not type(other):
        return one.values() == other.values()
    mine, others = one._values, other._values
    return mine == others or all(getattr(one, name) == getattr(other, name) for name in {**mine, **others})


def _refuse_shapes(source: Any, target: Any) -> None:
    """Raise ValueError; numba calls it in kernels where an array does not fit a slice."""


@overload(_refuse_shapes)  # type: ignore[untyped-decorator]
def _refuse_shapes_in_kernels(source: Any, target: Any) -> Any:
    def refuse(source: Any, target: Any) -> None:
        raise ValueError("cannot assign slice of shape: the shapes of the array and of the slice differ")

    return refuse


def cut_costs() -> None:
    """Let numba do these once."""
    for place, name, own in (
        (Function, "get_call_type", _call_type),
        (TargetConfig, "__eq__", _same_flags),
        (arrayobj, "raise_with_shape_context", _refuse_shapes),
    ):
        setattr(place, name, own)
