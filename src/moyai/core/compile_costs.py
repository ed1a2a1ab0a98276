"""What numba does again and again while it compiles, done once.

An operator between numbers has the same type each time; numba tries its rules for arrays first and rejects them each
time. Here the answer is kept for a set of argument types. Flags are compared by what was set. An array written into a
slice of another shape raises a fixed text: to put the shapes into words takes longer to compile than most kernels.
Functions of numpy are taken in as parts, like kernels that others call. The names in a statement are listed without
asking each of its values for its type twice; calls of the compiler's library raise no events.
What a kernel computes does not change.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from llvmlite.binding import ffi
from numba.core.ir import Expr, Inst, Stmt, Var
from numba.core.targetconfig import TargetConfig
from numba.core.types import Function
from numba.core.types.functions import BaseFunction
from numba.core.typing.templates import _OverloadFunctionTemplate
from numba.extending import overload
from numba.np import arrayobj

#: What may hold names.
_HOLDERS = (Inst, list, tuple, dict, Var)

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


def _names(value: Any) -> list[Any]:
    """Return the names in a statement, an expression, or in what they hold; see numba's method ``list_vars``."""
    if isinstance(value, Var):
        return [value]
    if isinstance(value, Inst):
        found: list[Any] = value.list_vars()
        return found
    if isinstance(value, dict):
        value = value.values()
    elif not isinstance(value, (list, tuple)):
        return []
    found = []
    for one in value:
        # most values are names, texts and places in the source
        if type(one) is Var:
            found.append(one)
        elif isinstance(one, _HOLDERS):
            found += _names(one)
    return found


def cut_costs(part: Callable[..., Any]) -> None:
    """Let numba do these once.

    Parameters
    ----------
    part : callable
        Decorator of functions of numpy, with options, in place of numba's own.
    """
    for place, name, own in (
        (Function, "get_call_type", _call_type),
        (TargetConfig, "__eq__", _same_flags),
        (arrayobj, "raise_with_shape_context", _refuse_shapes),
        (Stmt, "list_vars", lambda statement: _names(statement.__dict__)),
        (Expr, "list_vars", lambda expression: _names(expression._kws)),
        (_OverloadFunctionTemplate, "_get_jit_decorator", lambda template: part),
    ):
        setattr(place, name, own)
    ffi.lib._lock._cblist.clear()
