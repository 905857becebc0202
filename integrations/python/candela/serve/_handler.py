"""One connection: its request, and the answer."""
from __future__ import annotations

import io
import os
import socket
import time
from http import HTTPStatus
from http.server import BaseHTTPRequestHandler
from pathlib import Path
from typing import TYPE_CHECKING, Any, Callable, Dict, List, Optional, Tuple
from urllib.parse import urlsplit

from candela.serve import _drake, _options
from candela.serve._body import CHUNK, Body, TimedSocket
from candela.serve._form import SceneFile, boundary_of, read_form
from candela.serve._metrics import TYPE as METRICS_TYPE
from candela.serve._options import Options
from candela.serve._pictures import Picture, Source, render
from candela.serve._refusal import Gone, Refusal
from candela.serve._renderer import Renderer

if TYPE_CHECKING:
    from candela.serve._server import Server

MAX_JSON_BYTES = 1 << 20
# Seconds for which the rest of a request that was refused is read, so that its client gets to read why.
LINGER = 2.0
TEXT = "text/plain; charset=utf-8"


class Handler(BaseHTTPRequestHandler):
    """Answers one request, and closes the connection."""

    protocol_version = "HTTP/1.1"
    server_version = "candela"
    sys_version = ""
    server: Server

    def setup(self) -> None:
        """Reads with limits on time; see TimedSocket."""
        super().setup()
        self._timed = TimedSocket(self.connection)
        self.rfile.close()
        self.rfile = io.BufferedReader(self._timed, CHUNK)
        self._began = time.monotonic()
        self._expects = False

    def handle(self) -> None:
        """One request."""
        self.close_connection = True
        try:
            self.handle_one_request()
        except (Gone, OSError):
            pass  # There is nobody to answer.

    def handle_expect_100(self) -> bool:
        """A client that asks whether to send its body is told when it is wanted."""
        self._expects = True
        return True

    def log_message(self, format: str, *args: Any) -> None:  # pylint: disable=redefined-builtin
        """A line for each answer is enough."""

    def send_error(self, code: int, message: Optional[str] = None, explain: Optional[str] = None) -> None:
        """Answers what the base class refuses."""
        self._answer(code, TEXT, f"{message or HTTPStatus(code).phrase}\n".encode())

    def do_GET(self) -> None:
        """/health and /metrics."""
        self._dispatch({"/health": lambda: self._answer(200, "application/json", self.server.health()),
                        "/metrics": lambda: self._answer(200, METRICS_TYPE, self.server.metrics.text().encode())},
                       {"/render": "POST"})

    do_HEAD = do_GET

    def do_POST(self) -> None:
        """/render."""
        self._dispatch({"/render": self._render}, {"/health": "GET, HEAD", "/metrics": "GET, HEAD"})

    def do_PUT(self) -> None:
        """No request that any address has."""
        self._dispatch({}, {"/render": "POST", "/health": "GET, HEAD", "/metrics": "GET, HEAD"})

    do_DELETE = do_PATCH = do_OPTIONS = do_PUT

    def _dispatch(self, routes: Dict[str, Callable[[], None]], others: Dict[str, str]) -> None:
        path = urlsplit(self.path).path
        try:
            if path in routes:
                routes[path]()
            elif path in others:
                self._answer(HTTPStatus.METHOD_NOT_ALLOWED, TEXT, f"{path} is for {others[path]}\n".encode(),
                             {"Allow": others[path]})
            else:
                raise Refusal(HTTPStatus.NOT_FOUND, "there is only POST /render, GET /health and GET /metrics")
        except Refusal as refusal:
            more = {"Retry-After": "1"} if refusal.status == HTTPStatus.TOO_MANY_REQUESTS else {}
            self._answer(refusal.status, TEXT, f"{refusal}\n".encode(), more)
            self._read_rest()

    def _render(self) -> None:
        try:
            body = self._body()
            query = _options.from_query(urlsplit(self.path).query)
            with self.server.place() as folder:
                if self._expects:
                    self._timed.send(b"HTTP/1.1 100 Continue\r\n\r\n")
                run = self._read(body, query, folder)
                self.server.metrics.add("received_bytes", body.size)
                try:
                    self._send(self.server.render(run, self._timed.is_gone))
                except Refusal as refusal:
                    raise Refusal(refusal.status, self.server.without_paths(str(refusal), folder)) from None
        except Gone:
            self.server.metrics.add("cancelled")
            self._log(f"{self.path}: the client has gone")
            raise

    def _body(self) -> Body:
        """The request's body, whose size the head tells."""
        text = self.headers.get("Content-Length")
        if text is None or "Transfer-Encoding" in self.headers:
            raise Refusal(HTTPStatus.LENGTH_REQUIRED,
                          "the request has no Content-Length; send it at once, not in chunks")
        if not (text.isascii() and text.isdigit()):
            raise Refusal(HTTPStatus.BAD_REQUEST, "the request's Content-Length is no number")
        size, limit = int(text), self.server.limits.body_bytes
        if size > limit:
            raise Refusal(HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
                          f"the request has {size} bytes, and the server's --max-body "
                          f"allows {limit}; make the scene smaller")
        self._timed.allow(size)
        return Body(self.rfile, size)

    def _read(self, body: Body, query: Dict[str, Any], folder: Path) -> Callable[[Renderer], Picture]:
        """Reads the request; returns what makes its picture."""
        kind = self.headers.get_content_type()
        if kind == "multipart/form-data":
            form = read_form(body, boundary_of(self.headers["Content-Type"]), folder)
            if _drake.is_drake(form):
                return _drake.renders(form, query, folder, self._check_size)
            options = _options.merged(query, _options.from_texts(form.fields))
            path, sha256 = form.scene, form.sha256
        elif kind == "application/json" and "file" not in query:
            options = _options.merged(query, _options.from_json(body.text(MAX_JSON_BYTES)))
            path, sha256 = None, ""
        else:
            options = _options.merged(query)
            path, sha256 = self._read_file(body, folder)
        self._check_size(options, body.size)
        source = self._source(options, path, sha256)
        return lambda renderer: render(renderer, source, options, folder)

    @staticmethod
    def _read_file(body: Body, folder: Path) -> Tuple[Optional[Path], str]:
        """The scene that is the whole body."""
        if body.left == 0:
            return None, ""
        file = SceneFile(folder)
        try:
            while data := body.read():
                file.write(data)
        finally:
            sha256 = file.close()
        return file.path, sha256

    def _check_size(self, options: Options, scene_bytes: int) -> None:
        """Refuses what cannot fit into memory, before anything is loaded."""
        needed, limit = options.picture_bytes() + scene_bytes, self.server.limits.memory_bytes
        if needed > limit:
            raise Refusal(HTTPStatus.REQUEST_ENTITY_TOO_LARGE,
                          f"the picture and the scene's file need at least {needed} "
                          f"bytes, and the server's --memory-limit allows {limit}; ask for fewer pixels or layers")

    def _source(self, options: Options, path: Optional[Path], sha256: str) -> Source:
        if (path is None) == (options.file is None):
            raise Refusal(HTTPStatus.BAD_REQUEST,
                          "send either a scene, or the name of a \"file\" below the server's root")
        if path is not None:
            return Source({"file": str(path)}, (sha256,))
        root = self.server.root
        if root is None:
            raise Refusal(HTTPStatus.FORBIDDEN, "the server has no --root; send the scene itself")
        assert options.file is not None
        return Source({"file": str(_below(root, options.file)), "folders": [str(root)]})

    def _send(self, picture: Picture) -> None:
        size = os.path.getsize(picture.path)
        with open(picture.path, "rb") as file:
            self._head(200, picture.type, size, picture.notes)
            self._timed.allow(size)
            while data := file.read(CHUNK):
                self._timed.send(data)
        self.server.metrics.add("pictures")
        self.server.metrics.add("render_seconds", float(picture.notes["Candela-Seconds"]))
        self.server.metrics.add("sent_bytes", size)

    def _answer(self, status: int, kind: str, data: bytes, more: Optional[Dict[str, str]] = None) -> None:
        self._head(status, kind, len(data), more or {})
        if self.command != "HEAD":
            self._timed.send(data)

    def _head(self, status: int, kind: str, size: int, more: Dict[str, str]) -> None:
        self.server.metrics.answered(int(status))  # Before a client that has the answer can ask.
        self.send_response(status)
        for name, value in {"Content-Type": kind, "Content-Length": str(size), "Connection": "close",
                            "X-Content-Type-Options": "nosniff", **more}.items():
            self.send_header(name, value)
        self._timed.allow(0)
        self.close_connection = True
        lines: List[bytes] = getattr(self, "_headers_buffer", [])  # HTTP/0.9 has none.
        if lines:
            self._timed.send(b"".join(lines) + b"\r\n")
        self._headers_buffer: List[bytes] = []
        self._log(f"{self.requestline!r}: {int(status)}, {size} bytes")

    def _log(self, text: str) -> None:
        self.server.log(f"{self.client_address[0]}: {text}, {time.monotonic() - self._began:.3f} s")

    def _read_rest(self) -> None:
        """Reads on for a little: if the connection were closed at once, the client would lose the answer."""
        try:
            self.connection.shutdown(socket.SHUT_WR)
            self._timed.allow(0, LINGER)
            while self.rfile.read1(CHUNK):
                pass
        except OSError:
            pass


def _below(root: Path, name: str) -> Path:
    """The file of that name in the root or below, also after following links."""
    try:
        path = (root / name.lstrip("/")).resolve(strict=True)
        if path.is_file() and root in path.parents:
            return path
    except (OSError, RuntimeError, ValueError):
        pass
    raise Refusal(HTTPStatus.NOT_FOUND, f"there is no file {name[:200]!r} below the server's root")
