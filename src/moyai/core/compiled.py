"""Compiled kernels: numba's ``njit`` with a cache that sees what a kernel calls.

The cache of numba looks at the file of a kernel alone. A kernel that calls one of another file would go on with the old
inner one after an edit or an upgrade; here the content of every file of the package that it imports, directly or not,
belongs to the key.

Numba optimises a kernel and all that it calls, makes machine code of it and wrappers for calls from Python, and then
does so again for every kernel that calls it. Here a kernel that another one calls is typed and lowered, no more: it is
optimised once, as a part of what Python calls.
"""

from __future__ import annotations

import hashlib
import io
import pickle
import re
import sys
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager, suppress
from functools import cache, partial
from pathlib import Path
from typing import Any, ClassVar

import numba
from numba.core import event, sigutils, typing
from numba.core.caching import CompileResultCacheImpl, FunctionCache, IndexDataCacheFile
from numba.core.codegen import JITCodeLibrary
from numba.core.compiler import Compiler, Flags, compile_extra
from numba.core.environment import Environment, _rebuild_env, lookup_environment
from numba.core.registry import CPUDispatcher
from numba.core.runtime import rtsys

from moyai.core.shipped_kernels import shipped
from moyai.core.uncounted import LeaveCountsOut

_PACKAGE = Path(__file__).parents[1]
_IMPORT = re.compile(r"^from (moyai[\w.]*) import (\([^)]*\)|[^\n]*)", re.MULTILINE)
#: Versions of numba whose dispatchers are known to take kernels in as parts; with others kernels are compiled as numba
#: does it by itself, which takes longer and gives the same.
_KNOWN = numba.__version__.split(".")[:2] == ["0", "68"]


@cache
def _source(path: Path) -> tuple[bytes, frozenset[Path]]:
    """Return the content of a file, and the files of the package that it imports."""
    content = path.read_bytes()
    found: set[Path] = set()
    for module, names in _IMPORT.findall(content.decode("utf-8")):
        place = _PACKAGE.parent.joinpath(*module.split("."))
        candidates = [place, *(place / name for name in re.findall(r"\w+", names))]
        found.update(file for item in candidates if (file := item.with_suffix(".py")).is_file())
    return content, frozenset(found)


@cache
def kernel_stamp(path: Path) -> bytes:
    """Return a digest of a file with every file of the package that it imports, directly or not."""
    known, open_ones = {path}, [path]
    while open_ones:
        fresh = _source(open_ones.pop())[1] - known
        known |= fresh
        open_ones += fresh
    digest = hashlib.sha256()
    for file in sorted(known):
        digest.update(hashlib.sha256(_source(file)[0]).digest())
    return digest.digest()


def _with_stamp(locator: Any) -> Any:
    """Return a place for the cache that takes the stamp from all files of a kernel."""

    class Locator(locator):  # type: ignore[misc]
        def get_source_stamp(self) -> Any:
            path = Path(getattr(self, "_py_file", ""))
            return kernel_stamp(path) if path.suffix == ".py" and path.is_file() else super().get_source_stamp()

    return Locator


class _CacheImpl(CompileResultCacheImpl):  # type: ignore[misc]
    _locator_classes: ClassVar = [_with_stamp(locator) for locator in CompileResultCacheImpl._locator_classes]


def _environment(module: str, constants: list[Any], name: str) -> Environment:
    """Return the environment of a function of a kernel; see numba's function ``_rebuild_env``.

    Numba imports the module of each function that a kernel called. Machine code takes from the environment no more than
    constants, so that a module of numba that is not there yet is left out.
    """
    found = lookup_environment(name)
    if found is None and module.startswith("numba.") and module not in sys.modules:
        found = Environment({"__name__": module})
        found.consts[:], found.env_name = constants, name
        Environment._memo[name] = found
    return found or _rebuild_env(module, constants, name)


class _Unpickler(pickle.Unpickler):
    def find_class(self, module: str, name: str) -> Any:
        return _environment if _KNOWN and name == "_rebuild_env" else super().find_class(module, name)


class _Files(IndexDataCacheFile):  # type: ignore[misc]
    """Files of a kernel; those that cannot be read, damaged or of classes that are gone, are written anew."""

    def _load_index(self) -> Any:
        try:
            return super()._load_index()
        except Exception:
            return {}

    def _load_data(self, name: str) -> Any:
        try:
            return _Unpickler(io.BytesIO(Path(self._data_path(name)).read_bytes())).load()
        except Exception as error:
            raise OSError(f"{name} cannot be read") from error


class _Cache(FunctionCache):  # type: ignore[misc]
    _impl_class = _CacheImpl

    def __init__(self, function: Callable[..., Any]) -> None:
        super().__init__(function)
        self._cache_file.__class__ = _Files

    def load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return a kernel that is kept, ``None`` where there is none; see numba's method.

        Numba first loads all that it knows of Python and numpy; machine code requires nothing but its runtime.
        """
        if not _KNOWN:
            return super().load_overload(sig, target_context)
        rtsys.initialize(target_context)
        with self._guard_against_spurious_io_errors():
            return self._load_overload(sig, target_context)

    def _load_overload(self, sig: Any, target_context: Any) -> Any:
        """Return a kernel of the cache, or the one that came with the package; see numba's method."""
        found = None
        # what is damaged is compiled again and replaced
        with suppress(Exception):
            found = super()._load_overload(sig, target_context)
        if found is None and self._enabled:
            data = shipped(
                Path(self._py_func.__code__.co_filename), self._index_key(sig, target_context.codegen()), self._files_in
            )
            with suppress(Exception):
                found = None if data is None else self._impl.rebuild(target_context, data)
        return found

    def _files_in(self, folder: Path) -> _Files:
        return _Files(str(folder), self._impl.filename_base, self._cache_file._source_stamp)


class _Compiler(Compiler):  # type: ignore[misc]
    """Numba's compiler with less work, if its version is known."""

    def __init__(self, *arguments: Any) -> None:
        if _KNOWN:
            # Not before something is compiled: it imports a lot
            from moyai.core.compile_costs import cut_costs

            cut_costs(_part)
        super().__init__(*arguments)

    def define_pipelines(self) -> list[Any]:
        """Return the steps of numba, with one before machine code is made."""
        found: list[Any] = super().define_pipelines()
        if _KNOWN:
            from numba.core.typed_passes import IRLegalization

            for steps in found:
                steps.add_pass_after(LeaveCountsOut, IRLegalization)
                steps.finalize()
        return found


class _Part(JITCodeLibrary):  # type: ignore[misc]
    """Code of a kernel that is a part of another one: neither optimised nor made machine code of by itself."""

    def finalize(self) -> None:
        self._finalized = True


#: Called with kernel and types of the arguments before a kernel is compiled or taken from the cache.
_BEFORE: list[Callable[[Any, Sequence[Any]], None]] = []


class _Whole(CPUDispatcher):  # type: ignore[misc]
    """A kernel as numba compiles it."""

    #: Whether what is compiled is kept.
    cached = False
    _own_cache: Any = None

    @property
    def _cache(self) -> Any:
        """Return the cache, made when it is first asked for: most kernels are parts of others and never ask."""
        if self.cached and not isinstance(self._own_cache, _Cache):
            self._own_cache = _Cache(self.py_func)
        return self._own_cache

    @_cache.setter
    def _cache(self, given: Any) -> None:
        self._own_cache = given

    def compile(self, sig: Any) -> Any:
        """Compile for arguments of given types or take from the cache; see numba's method."""
        for call in _BEFORE:
            call(self, sigutils.normalize_signature(sig)[0])
        return super().compile(sig)


class _Kernel(_Whole):
    """A kernel that others take in as a part, and Python calls in a form of its own."""

    def __init__(self, *arguments: Any, **options: Any) -> None:
        super().__init__(*arguments, **options)
        #: Types of the arguments to signature and key of the part, which numba looks up by its key.
        self._parts: dict[tuple[Any, ...], tuple[Any, object]] = {}

    def _lower_as_part(self, arguments: tuple[Any, ...]) -> None:
        """Type and lower the kernel for arguments of given types."""
        context, flags = self.targetctx, Flags()
        self.targetdescr.options.parse_as_flags(flags, self.targetoptions)
        flags.no_compile = flags.no_cpython_wrapper = flags.no_cfunc_wrapper = True
        done = compile_extra(
            self.typingctx, context, self.py_func, args=arguments, return_type=None, flags=flags,
            locals=self._compiler.locals, pipeline_class=self._compiler.pipeline_class,
        )  # fmt: skip
        if done.typing_error is not None:
            raise done.typing_error
        code, key = done.library, object()
        code.__class__ = _Part
        # the parts of a part are linked by whoever takes it in
        context.insert_user_function(key, done.fndesc, [code, *code._linking_libraries])
        self._parts[arguments] = done.signature, key

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """Return how another kernel calls this one; see numba's method."""
        pysig, folded = self._compiler.fold_argument_types(args, kws)
        arguments = tuple(folded)
        if arguments not in self._parts:
            self._lower_as_part(arguments)
        name = self.py_func.__name__
        signatures = [signature for signature, _ in self._parts.values()]
        template = typing.make_concrete_template(f"CallTemplate({name})", key=name, signatures=signatures)
        return template, pysig, folded, {}

    def get_overload(self, sig: Any) -> object:
        """Return the key of the part for a signature; see numba's method."""
        arguments, _ = sigutils.normalize_signature(sig)
        return self._parts[tuple(arguments)][1]


def _part(**options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return a decorator of functions that numba brings for kernels: they are parts of what calls them."""
    kinds, pipeline = options.pop("locals", {}), options.pop("pipeline_class", Compiler)
    options.pop("cache", None)  # parts are kept with what calls them
    target = {"nopython": True, "boundscheck": None, **options}
    return partial(_Kernel, locals=kinds, targetoptions=target, pipeline_class=pipeline)


def njit(*, pointer: bool = False, **options: Any) -> Callable[[Callable[..., Any]], Any]:
    """Return numba's decorator of the same name; ``cache=True`` sees the kernels that a kernel calls.

    ``pointer`` says that another kernel takes this one as an argument.
    """
    cached = options.pop("cache", False)
    options["nogil"] = True
    if _KNOWN and not pointer:
        options["no_cfunc_wrapper"] = True

    def compiled(function: Callable[..., Any]) -> Any:
        if numba.config.DISABLE_JIT:
            return function
        kind = _Kernel if _KNOWN else _Whole
        target = {"nopython": True, "boundscheck": None, **options}
        kernel = kind(py_func=function, targetoptions=target, pipeline_class=_Compiler)
        kernel.cached = cached
        return kernel

    return compiled


@contextmanager
def before_compiling(call: Callable[[Any, Sequence[Any]], None]) -> Iterator[None]:
    """Call with kernel and types of its arguments before it is compiled or taken from the cache."""
    _BEFORE.append(call)
    try:
        yield
    finally:
        _BEFORE.remove(call)


@contextmanager
def when_compiling(call: Callable[[], None]) -> Iterator[None]:
    """Call once when the first kernel is compiled that no run before has left in the cache."""

    class Once(event.Listener):  # type: ignore[misc]
        called = False

        def on_start(self, event: Any) -> None:
            if not self.called:
                self.called = True
                call()

        def on_end(self, event: Any) -> None:
            pass

    with event.install_listener("numba:compile", Once()):
        yield


class _Pointer:
    """A compiled function for arguments of given types as another one takes it; numba requires these two methods."""

    def __init__(self, function: Any, arguments: tuple[Any, ...]) -> None:
        kinds = tuple(numba.typeof(value) for value in arguments)
        function.compile(kinds)
        compiled = function.overloads[kinds]
        self._signature = compiled.signature.return_type(*kinds)
        self._address = compiled.library.get_pointer_to_function(compiled.fndesc.llvm_cfunc_wrapper_name)

    def __wrapper_address__(self) -> int:
        return int(self._address)

    def signature(self) -> Any:
        """Return the signature."""
        return self._signature


def with_pointers(
    kernel: Any, called: Sequence[tuple[Any, tuple[Any, ...]]], arguments: tuple[Any, ...]
) -> Callable[..., Any]:
    """Return a kernel whose first arguments are other kernels, compiled for arguments of these types.

    The others come as addresses, so that they are not compiled again and the kernel is kept for the next process; with
    kernels as they are it is not.

    Parameters
    ----------
    kernel : kernel
    called : sequence of (kernel, tuple)
        Kernels that it takes, of ``njit(pointer=True)``, and arguments of the types that they are called with.
    arguments : tuple
        Arguments after those kernels.
    """
    pointers = [_Pointer(*each) for each in called]
    kinds = (*(numba.types.FunctionType(each.signature()) for each in pointers), *map(numba.typeof, arguments))
    kernel.compile(kinds)
    return partial(kernel.overloads[kinds].entry_point, *pointers)
