"""The one exception of frictcomp."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ._engine import Message


class Error(Exception):
    """Something could not be done: a file cannot be read, a configuration has a mistake.

    ``str(error)`` is one sentence and, after it, what to do. The errors in the lines of a
    file are in ``messages``; ``file``, ``line``, ``column`` and ``code`` are those of the first of
    them. Lines and columns count from 1, columns in characters.
    """

    message: str
    help: str | None
    file: str | None
    line: int | None
    column: int | None
    code: str | None
    messages: list[Message]

    def __init__(
        self,
        message: str,
        *,
        help: str | None = None,
        file: str | None = None,
        messages: Sequence[Message] = (),
    ) -> None:
        super().__init__(message)
        self.message = message
        self.help = help
        self.messages = list(messages)
        first = self.messages[0] if self.messages else None
        self.file = first.file if first else file
        self.line = first.line if first else None
        self.column = first.column if first else None
        self.code = first.code if first else None

    def __str__(self) -> str:
        told = [str(it) for it in self.messages if str(it) != self.message]
        helped = [f"help: {self.help}"] if self.help else []
        return "\n  ".join([self.message, *told, *helped])

    def __reduce__(self) -> tuple[object, ...]:
        return (_unpickled, (self.message, self.help, self.file, self.messages))


def _unpickled(
    message: str, help: str | None, file: str | None, messages: Sequence[Message]
) -> Error:
    return Error(message, help=help, file=file, messages=messages)
