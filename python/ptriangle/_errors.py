"""Exceptions with the messages of the library."""
from __future__ import annotations

from typing import Type


class Error(Exception):
    """A call of the library failed. The text is the library's message. status: enum tri_status."""

    def __init__(self, text: str, status: int = 0) -> None:
        super().__init__(text, status)
        self.status = status

    def __str__(self) -> str:
        return str(self.args[0])


class InputError(Error, ValueError):
    """The input is invalid. The text names the fault and its place."""

    def __init__(self, text: str, status: int = 3) -> None:
        super().__init__(text, status)


class TooLargeError(Error, MemoryError):
    """The mesh needs more memory than available, or more triangles than one mesh can hold."""


class FileError(Error, OSError):
    """A file cannot be read or written."""

    def __init__(self, text: str, status: int = 4) -> None:
        super().__init__(text, status)


class StoppedError(Error):
    """The function given as `stop` returned True."""


_KINDS = {1: TooLargeError, 2: TooLargeError, 3: InputError, 4: FileError, 5: FileError, 8: StoppedError}


def exception_of(status: int, text: str) -> Error:
    kind: Type[Error] = _KINDS.get(status, Error)
    return kind(text, status)
