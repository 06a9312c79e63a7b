"""Rejects unknown keywords, and suggests the one that was probably meant."""
from __future__ import annotations

import functools
import inspect
from typing import Any, Callable, TypeVar, cast

F = TypeVar("F", bound=Callable[..., Any])


def explained(function: F) -> F:
    """Wraps a function with its own signature. The error for an unknown keyword is more helpful than that of Python."""
    names = list(inspect.signature(function).parameters)

    @functools.wraps(function)
    def call(*given: Any, **named: Any) -> Any:
        for name in named:
            if name not in names:
                raise TypeError("%s() got an unexpected keyword %r%s" % (function.__name__, name, _advice(name, names)))
        return function(*given, **named)
    return cast(F, call)


def _advice(name: str, names: list[str]) -> str:
    import difflib
    near = difflib.get_close_matches(name, names, 1)
    return "; did you mean %r?" % near[0] if near else ""
