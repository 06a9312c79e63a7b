"""Keywords that do not exist are refused with the name of the one that was probably meant."""
from __future__ import annotations

import functools
import inspect
from typing import Any, Callable, TypeVar, cast

F = TypeVar("F", bound=Callable[..., Any])


def explained(function: F) -> F:
    """The function with its own signature, which says more of a keyword that it does not know than Python does."""
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
