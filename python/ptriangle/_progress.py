"""Reports progress to a function or, with progress=True, as a line on standard error."""
from __future__ import annotations

import sys
import time
from typing import Any, Callable, Union

from ._calls import Calls
from ._library import Progress


class _Line:
    """A line that is rewritten at most ten times a second, on a terminal or in a notebook."""

    def __init__(self) -> None:
        self.told = 0.0

    def __call__(self, done: float, triangles: int) -> None:
        now = time.monotonic()
        if done < 1 and now - self.told < 0.1:
            return
        self.told = now
        print("\rmesh: %3.0f%%, %d triangles" % (100 * done, triangles), end="\n" if done == 1 else "", file=sys.stderr,
              flush=True)


def follow(calls: Calls, progress: Union[bool, Callable[[float, int], Any]]) -> Any:
    """Returns the callback for the library. It passes on the share that is done, 0 to 1, and the number of
    triangles."""
    told = progress if callable(progress) else _Line()
    return Progress(calls.guarded(lambda _user, done, triangles: told(done, triangles) and None, None))
