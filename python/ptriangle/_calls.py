"""Calls of the library, with callbacks of the user, signals, and exceptions in both.

INVARIANT: no exception leaves a function that C code has called, because ctypes would drop it. An exception in a
callback, or in a handler of a signal (KeyboardInterrupt), is stored. It ends the call, and is raised after that.
"""
from __future__ import annotations

import signal
import sys
import threading
from ctypes import byref
from typing import Any, Callable, Dict, Optional, TypeVar

from ._errors import exception_of
from ._library import ErrorDetail, Stop

R = TypeVar("R")


class Calls:
    """The callbacks of one call of the library. who: name of the public function, for messages."""

    def __init__(self, who: str) -> None:
        self.who = who
        self.fault: Optional[BaseException] = None  # the first exception
        self._thread = threading.get_ident()
        self._inside = False    # this thread runs a callback of the user, in which exceptions are caught
        self._running = False

    def keep(self, fault: BaseException) -> None:
        if self.fault is None:
            self.fault = fault

    def guarded(self, function: Callable[..., R], otherwise: R) -> Callable[..., R]:
        """Wraps a function for C code. After an exception it is not called any more, and the wrapper returns
        `otherwise`."""
        def call(*arguments: Any) -> R:
            if self.fault is not None:
                return otherwise
            try:
                try:
                    self._inside = threading.get_ident() == self._thread
                    return function(*arguments)
                finally:
                    self._inside = False
            except BaseException as fault:
                self._inside = False
                self.keep(fault)
                return otherwise
        return call

    def stop(self, function: Optional[Callable[[], Any]]) -> Any:
        """Returns the stop callback. It calls the function of the user, if there is one, and stops after an
        exception."""
        if function is None:
            return Stop(lambda _user: self.fault is not None)
        asked = self.guarded(lambda: bool(function()), True)
        return Stop(lambda _user: asked() or self.fault is not None)

    # --- signals

    def _instead(self, handler: Callable[[int, Any], Any]) -> Callable[[int, Any], Any]:
        """A handler may run at any instruction, even at the start of a callback, before any `try`. So its exception is
        stored. The exception is raised at once only inside a function of the user, which might never return."""
        def handle(number: int, frame: Any) -> None:
            try:
                handler(number, frame)
            except BaseException as fault:
                if not self._running:
                    raise
                if self._inside and self.fault is None:
                    self._inside = False  # once
                    raise
                self.keep(fault)
        return handle

    def run(self, function: Callable[..., R], *arguments: Any) -> R:
        """Calls the library without the lock of the interpreter."""
        handlers = _handlers()
        try:
            self._running = True
            for number, handler in handlers.items():
                _signal.signal(number, self._instead(handler))
            returned = function(*arguments)
        finally:
            self._running = False  # if our handler stays in place after a signal, it does the same as the previous one
            for number, handler in handlers.items():
                _signal.signal(number, handler)
        if self.fault is not None:
            raise self.fault
        return returned

    def run_checked(self, function: Callable[..., int], *arguments: Any) -> None:
        """The same for functions that return a status and have a tri_error as last argument."""
        error = ErrorDetail()
        status = self.run(function, *arguments, byref(error))
        if status:
            raise exception_of(status, self._text(error))

    def _text(self, error: ErrorDetail) -> str:
        text: str = error.text.decode("utf-8", "replace")
        if error.file:
            where = error.file.decode("utf-8", "replace") + (":%d" % error.line if error.line else "")
            return "%s: %s" % (where, text)
        return "%s: %s" % (self.who, text[len("settings: "):] if text.startswith("settings: ") else text)


# The functions of `signal` make an enum of each number and of each handler: a quarter of a millisecond for all signals.
_signal: Any = sys.modules.get("_signal", signal)
_SIGNALS = tuple(int(number) for number in signal.valid_signals())


def _handlers() -> Dict[int, Callable[[int, Any], Any]]:
    """Returns the handlers written in Python; none outside the main thread, which alone runs them."""
    if threading.current_thread() is not threading.main_thread():
        return {}
    getsignal = _signal.getsignal
    return {number: getsignal(number) for number in _SIGNALS if callable(getsignal(number))}
