"""Kernels are compiled with numba, run without the interpreter's lock, and cached by source."""

from collections.abc import Callable
from typing import Any, TypeVar, cast

import numba
from numba import types
from numba.core.registry import CPUDispatcher

from esplanade.planning.compiled import cache, notice

notice.begin()

F = TypeVar("F", bound=Callable[..., object])


class Kernel(CPUDispatcher):
    """A function that is compiled for calls from Python and, apart from that, for other kernels.

    The code that takes arguments from Python unpacks every array of every tuple. It is as large as
    many a kernel itself. The code that other kernels call does without it, and is not kept either:
    it is part of those that call it.
    """

    def __init__(
        self,
        py_func: Any,
        locals: Any = None,  # noqa: A002 (as numba calls it)
        targetoptions: Any = None,
        **more: Any,
    ) -> None:
        super().__init__(py_func, locals, targetoptions, **more)
        options = {**targetoptions, "no_cpython_wrapper": True, "no_cfunc_wrapper": True}
        self._inner = CPUDispatcher(py_func, locals, options, **more)

    def enable_caching(self) -> None:
        """Keep the code compiled for calls from Python, if there is a folder for it."""
        kept_in = cache.folder()
        if kept_in is not None:
            self._cache = cache.KernelCache(self.py_func, kept_in)

    def get_call_template(self, args: Any, kws: Any) -> Any:
        """The function that another kernel calls, and its types."""
        return self._inner.get_call_template(args, kws)

    def get_overload(self, sig: Any) -> Any:
        """The library that another kernel is linked with."""
        return self._inner.get_overload(sig)

    def get_compile_result(self, sig: Any) -> Any:
        """The same with all that is known of it."""
        return self._inner.get_compile_result(sig)


def _compiled(function: F, **options: bool) -> F:
    if numba.config.DISABLE_JIT:  # type: ignore[attr-defined]
        return function
    common = {"nopython": True, "nogil": True, "boundscheck": None, "error_model": "numpy"}
    made = Kernel(function, {}, {**common, **options})
    made.enable_caching()
    return cast(F, made)


def kernel(function: F) -> F:
    """Compile a function of arrays and scalars; it runs without the interpreter's lock."""
    return _compiled(function)


def inlined(function: F) -> F:
    """A kernel that is always compiled into those that call it.

    It is meant for the innermost loops: numba counts references to every array that is handed to a
    function, and the compiler removes that only where it sees both ends.
    """
    return _compiled(function, forceinline=True, _nrt=False)


def borrowing(function: F) -> F:
    """A kernel that counts no references to the arrays that it is handed, and makes none itself.

    Numba counts them twice in each call, for every array of every tuple: half a microsecond for
    those of a zone, and longer while another thread does the same. Its caller holds them anyhow.
    """
    return _compiled(function, _nrt=False)


def compile_for(function: Callable[..., object], *kinds: types.Type) -> None:
    """Compile a kernel for these types of arguments, and keep it, without calling it."""
    cast(Kernel, function).compile(kinds)
