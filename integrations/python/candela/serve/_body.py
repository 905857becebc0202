"""What a client sends: read from its socket within a time, and within a number of bytes."""
from __future__ import annotations

import io
import socket
import time
from http import HTTPStatus
from typing import TYPE_CHECKING, Optional

from candela.serve._refusal import Gone, Refusal

if TYPE_CHECKING:
    from typing_extensions import Buffer

CHUNK = 1 << 16
# How slow a client may be: seconds for what is small, and bytes per second for what is not.
PATIENCE = 30.0
LEAST_RATE = 100e3


class TimedSocket(io.RawIOBase):
    """A socket that is read and written until a moment, however slowly the bytes come."""

    def __init__(self, connection: socket.socket) -> None:
        self._socket = connection
        self._end = 0.0
        self.allow(0)

    def allow(self, size: int, patience: Optional[float] = None) -> None:
        """From now on, so many bytes may take their time."""
        self._end = time.monotonic() + (PATIENCE if patience is None else patience) + size / LEAST_RATE

    def readable(self) -> bool:
        """As streams have it."""
        return True

    def readinto(self, buffer: Buffer) -> int:
        """As streams have it; raises TimeoutError when the time is over."""
        left = self._end - time.monotonic()
        if left <= 0:
            raise TimeoutError("the time is over")
        self._socket.settimeout(left)
        return self._socket.recv_into(buffer)

    def send(self, data: bytes) -> None:
        """Sends all; raises OSError when the time is over or the client has gone."""
        self._socket.settimeout(max(0.001, self._end - time.monotonic()))
        self._socket.sendall(data)

    def is_gone(self) -> bool:
        """Whether the client has closed the connection, or its half of it."""
        try:
            self._socket.settimeout(0)
            return self._socket.recv(1, socket.MSG_PEEK) == b""
        except (BlockingIOError, InterruptedError):
            return False
        except OSError:
            return True


class Body:
    """The bytes that follow the head of a request."""

    def __init__(self, stream: io.BufferedIOBase, size: int) -> None:
        self._stream = stream
        self.size = size
        self.left = size

    def read(self) -> bytes:
        """The next bytes; none at the end. Raises Gone if the client stops before."""
        if self.left == 0:
            return b""
        try:
            # A buffered reader's read() would wait for all of them.
            data = self._stream.read1(min(CHUNK, self.left))
        except (TimeoutError, socket.timeout):  # Two until Python 3.10.
            raise Refusal(HTTPStatus.REQUEST_TIMEOUT, "the request came too slowly: a client has "
                          f"{PATIENCE:.0f} s, and another for each {LEAST_RATE / 1e3:.0f} kB; use a faster connection"
                          ) from None
        except OSError as error:
            raise Gone from error
        if not data:
            raise Gone
        self.left -= len(data)
        return data

    def text(self, limit: int) -> bytes:
        """All of them, if they are no more than the limit."""
        if self.left > limit:
            raise Refusal(HTTPStatus.REQUEST_ENTITY_TOO_LARGE, f"the request's options have {self.left} bytes; send at "
                                                               f"most {limit}")
        parts = []
        while data := self.read():
            parts.append(data)
        return b"".join(parts)
