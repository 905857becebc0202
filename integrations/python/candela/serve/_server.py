"""The server: connections, their limits, and what each request gets."""
from __future__ import annotations

import json
import shutil
import socket
import socketserver
import sys
import tempfile
import threading
import time
from dataclasses import dataclass
from http import HTTPStatus
from http.server import HTTPServer
from pathlib import Path
from typing import Any, Callable, Iterator, Optional, Tuple

import contextlib

import candela
from candela.serve._handler import Handler
from candela.serve._metrics import Metrics
from candela.serve._pictures import Picture
from candela.serve._refusal import Gone, Refusal
from candela.serve._renderer import Job, Renderer

# Seconds between two looks at whether a client is still there.
POLL = 0.1
# Connections beside those of requests that wait: for /health and /metrics, and to refuse others.
MORE_CONNECTIONS = 256


@dataclass
class Limits:
    """What all requests share, and what each may need."""

    queue: int = 64  # Requests that wait while another is rendered.
    seconds: float = 300.0  # Of a request, from when it is its turn.
    body_bytes: int = 256 << 20
    memory_bytes: int = 4 << 30
    scenes: int = 4  # That stay loaded.


class Server(socketserver.ThreadingMixIn, HTTPServer):
    """Answers requests until shutdown(); close() ends the program and removes all files."""

    daemon_threads = True
    request_queue_size = 512

    def __init__(self, address: Tuple[str, int], root: Optional[Path] = None, limits: Optional[Limits] = None,
                 options: Optional[list[str]] = None, log: Callable[[str], None] = lambda line: None) -> None:
        self.root = None if root is None else root.resolve(strict=True)
        self.limits = limits or Limits()
        self.log = log
        self.metrics = Metrics()
        self._places = threading.BoundedSemaphore(self.limits.queue + 1)
        self._connections = threading.BoundedSemaphore(self.limits.queue + 1 + MORE_CONNECTIONS)
        self._pending = 0
        self._lock = threading.Lock()
        self.address_family = socket.AF_INET6 if ":" in address[0] else socket.AF_INET
        super().__init__(address, Handler)
        self._folder = Path(tempfile.mkdtemp(prefix="candela-http-"))
        self.renderer = Renderer(options or [], self.limits.memory_bytes, self.limits.scenes, self.metrics)
        self.metrics.gauge("requests_pending", "Requests that wait or are rendered.", lambda: self._pending)
        self.metrics.gauge("program_resident_bytes", "Memory of the program that renders.",
                           lambda: self.renderer.resident_bytes)

    def server_bind(self) -> None:
        """As the base class, without asking a name server for this machine's name."""
        socketserver.TCPServer.server_bind(self)
        self.server_name, self.server_port = str(self.server_address[0]), self.server_address[1]

    def process_request(self, request: Any, client_address: Any) -> None:
        """Starts a thread for a connection, if there are not too many."""
        if not self._connections.acquire(blocking=False):
            self.metrics.answered(HTTPStatus.SERVICE_UNAVAILABLE)
            with contextlib.suppress(OSError):
                request.settimeout(0)
                request.send(b"HTTP/1.1 503 Service Unavailable\r\nConnection: close\r\nContent-Length: 0\r\n\r\n")
            self.shutdown_request(request)
            return
        super().process_request(request, client_address)

    def process_request_thread(self, request: Any, client_address: Any) -> None:
        """All of a connection."""
        try:
            super().process_request_thread(request, client_address)
        finally:
            self._connections.release()

    def handle_error(self, request: Any, client_address: Any) -> None:
        """Says what went wrong; the base class would print the whole way to it."""
        self.log(f"{client_address[0]}: {sys.exc_info()[1]!r}")

    @contextlib.contextmanager
    def place(self) -> Iterator[Path]:
        """A place in the queue, with a folder for the request's files."""
        if not self._places.acquire(blocking=False):
            raise Refusal(HTTPStatus.TOO_MANY_REQUESTS, f"{self.limits.queue} requests wait already; try again later")
        try:
            with self._lock:
                self._pending += 1
            folder = Path(tempfile.mkdtemp(dir=self._folder))
            try:
                yield folder
            finally:
                shutil.rmtree(folder, ignore_errors=True)
        finally:
            with self._lock:
                self._pending -= 1
            self._places.release()

    def render(self, run: Callable[[Renderer], Picture], is_gone: Callable[[], bool]) -> Picture:
        """What run() returns, when it is its turn. Raises Refusal, and Gone if the client does not wait for it."""
        pictures = []
        job = Job(lambda renderer: pictures.append(run(renderer)))
        self.renderer.submit(job)
        why: Optional[Exception] = None
        while not job.done.wait(POLL):
            if why is None and is_gone():
                why = Gone()
            if why is None and job.began is not None and time.monotonic() - job.began > self.limits.seconds:
                why = Refusal(HTTPStatus.GATEWAY_TIMEOUT,
                              f"the request took longer than {self.limits.seconds:g} s; ask for "
                              "fewer samples or pixels, or for what can be done within a \"time_limit\"")
            if why is not None:
                self.renderer.stop(job)
        if why is not None:
            raise why
        if job.error is not None:
            raise job.error
        return pictures[-1]

    def without_paths(self, message: str, folder: Path) -> str:
        """The message without the names of folders that are no client's business."""
        for path in (folder, self.root):
            if path is not None:
                message = message.replace(f"{path}/", "")
        return message

    def health(self) -> bytes:
        """What /health says."""
        return json.dumps({"status": "ok", "version": candela.__version__, "pending": self._pending}).encode() + b"\n"

    def close(self) -> None:
        """Ends the program, whatever it does, and removes all files. After shutdown()."""
        self.server_close()
        self.renderer.close()
        shutil.rmtree(self._folder, ignore_errors=True)
