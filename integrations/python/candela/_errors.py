"""What can go wrong."""
from __future__ import annotations


class Error(RuntimeError):
    """What candela reports: the message names the thing, the place, the cause and the remedy.

    Attributes:
        kind: "usage", "no_device", "device_lost", "out_of_memory", "cancelled", "busy", "timeout", or "failed" for all else.
        code: The exit code of the command line for such an error.
    """

    def __init__(self, message: str, kind: str = "failed", code: int = 1) -> None:
        super().__init__(message)
        self.kind = kind
        self.code = code
