"""Kernels that make no array go without counts of who holds one.

Numba counts the holders of every array, with an atomic operation wherever a name takes or leaves one; a kernel that is
called millions of times, each time with a dozen arrays, spends a seventh of its time on that. Who calls a kernel holds
its arguments until it returns, so that a kernel that neither makes nor returns an array has nothing to count: its code
is shorter, and compiled sooner. What it computes does not change.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numba.core import ir, types
from numba.core.compiler_machinery import AnalysisPass, register_pass

#: Expressions that pass on what is there: elements and slices, parts of tuples, steps of loops.
_PASSED_ON = {
    "build_tuple", "cast", "exhaust_iter", "getitem", "getiter", "iternext", "pair_first", "pair_second", "phi",
    "typed_getitem",
}  # fmt: skip
#: Attributes of arrays that are views.
_VIEWS = {"T", "real", "imag"}
#: What a kernel may be called with: who calls it holds the arrays among these, and nothing else of them is counted.
_PLAIN_ARGUMENT = (
    types.Array, types.Number, types.Boolean, types.misc.NoneType, types.misc.Omitted, types.FunctionType,
    types.Dispatcher,
)  # fmt: skip
_PLAIN_INDEX = (types.Integer, types.misc.SliceType, types.misc.EllipsisType, types.misc.NoneType)


@register_pass(mutates_CFG=False, analysis_only=True)
class LeaveCountsOut(AnalysisPass):  # type: ignore[misc]
    """Lower a kernel that makes no array without counts."""

    _name = "leave_counts_out"

    def __init__(self) -> None:
        AnalysisPass.__init__(self)

    def run_pass(self, state: Any) -> bool:
        """Choose how the kernel is lowered."""
        if state.targetctx.enable_nrt and not _makes_arrays(state):
            state.targetctx = state.targetctx.subtarget(enable_nrt=False)
        return False


def _makes_arrays(state: Any) -> bool:
    """Whether a kernel makes or returns anything that is counted, or may do so."""
    models = state.targetctx.data_model_manager

    def counted(kind: Any) -> bool:
        return bool(models[kind].contains_nrt_meminfo())

    if state.func_ir.is_generator or counted(state.return_type) or not all(map(_is_plain_argument, state.args)):
        return True
    for block in state.func_ir.blocks.values():
        for statement in block.body:
            if isinstance(statement, ir.DynamicRaise | ir.Print | ir.DelItem | ir.SetAttr):
                return True
            if isinstance(statement, ir.SetItem) and not _is_plain(state.typemap[statement.index.name]):
                return True
            if isinstance(statement, ir.StaticSetItem) and not _is_plain_constant(statement.index):
                return True
            # what is written into a slice is copied first where the two overlap
            written = isinstance(statement, ir.SetItem | ir.StaticSetItem)
            if written and counted(state.typemap[statement.value.name]):
                return True
            if not (isinstance(statement, ir.Assign) and counted(kind := state.typemap[statement.target.name])):
                continue
            made = statement.value
            # a part of a text is a new one
            new = isinstance(made, ir.Expr) and (
                isinstance(kind, types.misc.UnicodeType) or not _passes_on(made, state.typemap)
            )
            if new or isinstance(made, ir.Yield):
                return True
    return False


def _passes_on(made: Any, kinds: Any) -> bool:
    """Whether an expression gives a part of something that is there."""
    if made.op == "getattr":
        return not isinstance(kinds[made.value.name], types.Array) or made.attr in _VIEWS
    if made.op in ("getitem", "typed_getitem"):
        return _is_plain(kinds[made.index.name])
    if made.op == "static_getitem":
        return _is_plain_constant(made.index)
    return made.op in _PASSED_ON


def _is_plain(index: Any) -> bool:
    """Whether an index gives an element or a view."""
    parts = index.types if isinstance(index, types.containers.BaseTuple) else (index,)
    return all(isinstance(part, _PLAIN_INDEX) for part in parts)


def _is_plain_constant(index: Any) -> bool:
    """Whether a constant index gives an element or a view."""
    parts = index if isinstance(index, tuple) else (index,)
    return all(part is None or part is ... or isinstance(part, int | slice | np.integer) for part in parts)


def _is_plain_argument(kind: Any) -> bool:
    """Whether an argument is a number, an array or a function, or a tuple of these."""
    if isinstance(kind, types.containers.BaseTuple):
        return all(map(_is_plain_argument, kind.types))
    return isinstance(kind, _PLAIN_ARGUMENT)
