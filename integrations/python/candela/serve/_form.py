"""Forms as browsers and programs send them (multipart/form-data), read as they come: RFC 7578."""
from __future__ import annotations

import email.parser
import hashlib
import re
from dataclasses import dataclass, field
from http import HTTPStatus
from pathlib import Path
from typing import Callable, Dict, Optional

from candela.serve._body import Body
from candela.serve._refusal import Refusal

SCENE = "scene"  # The part that is a file.
MAX_PARTS = 64
MAX_HEAD_BYTES = 8192
MAX_FIELD_BYTES = 1 << 16


@dataclass
class Form:
    """The fields by name, and the file, if there is one, with its SHA-256."""

    fields: Dict[str, str] = field(default_factory=dict)
    scene: Optional[Path] = None
    sha256: str = ""


def bad(message: str) -> Refusal:
    """A refusal of a form."""
    return Refusal(HTTPStatus.BAD_REQUEST, "the form: " + message)


class SceneFile:
    """The one file of a request. It has the same name whatever the client calls it."""

    def __init__(self, folder: Path) -> None:
        self.path = folder / SCENE
        self._hash = hashlib.sha256()
        self._file = open(self.path, "xb")

    def write(self, data: bytes) -> None:
        """Appends bytes."""
        self._hash.update(data)
        self._file.write(data)

    def close(self) -> str:
        """The SHA-256 of all."""
        self._file.close()
        return self._hash.hexdigest()


class _Field:
    """A field that is text."""

    def __init__(self, name: str, limit: int) -> None:
        self._name = name
        self._limit = limit
        self._data = bytearray()

    def write(self, data: bytes) -> None:
        if len(self._data) + len(data) > self._limit:
            raise bad(f"{self._name} has more than {self._limit} bytes; only the part {SCENE!r} may be a file")
        self._data += data

    def text(self) -> str:
        try:
            return self._data.decode()
        except UnicodeDecodeError:
            raise bad(f"{self._name} is not text in UTF-8") from None


class _Reader:
    """Bytes up to marks, of a body that is never in memory as a whole."""

    def __init__(self, body: Body) -> None:
        self._body = body
        self._rest = b"\r\n"  # The first boundary may begin the body.

    def until(self, mark: bytes, write: Callable[[bytes], None], what: str) -> None:
        """Writes what is before the next mark, and passes both."""
        while True:
            before, found, after = self._rest.partition(mark)
            if found:
                write(before)
                self._rest = after
                return
            safe = max(0, len(self._rest) - len(mark) + 1)
            write(self._rest[:safe])
            self._rest = self._rest[safe:] + self._more(what)

    def take(self, count: int, what: str) -> bytes:
        """The next bytes."""
        while len(self._rest) < count:
            self._rest += self._more(what)
        taken, self._rest = self._rest[:count], self._rest[count:]
        return taken

    def _more(self, what: str) -> bytes:
        data = self._body.read()
        if not data:
            raise bad(f"it ends within {what}; is it cut off, or another boundary meant?")
        return data


def boundary_of(content_type: str) -> bytes:
    """The boundary that the request's Content-Type names."""
    boundary = email.parser.HeaderParser().parsestr(f"Content-Type: {content_type}\n").get_boundary()
    if boundary is None or not re.fullmatch(r"[ -~]{1,70}", boundary):
        raise bad("its Content-Type names no boundary of 1 to 70 characters")
    return boundary.encode()


def read_form(body: Body, boundary: bytes, folder: Path) -> Form:
    """Reads all of a form; the part `scene` becomes a file in the folder."""
    reader = _Reader(body)
    form = Form()
    mark = b"\r\n--" + boundary
    reader.until(mark, lambda _: None, "what precedes its first part")
    for _ in range(MAX_PARTS + 1):
        end = reader.take(2, "a boundary")
        if end == b"--":
            break
        if end != b"\r\n":
            raise bad("a boundary is not followed by the end of its line")
        _read_part(reader, mark, form, folder)
    else:
        raise bad(f"it has more than {MAX_PARTS} parts")
    while body.read():
        pass  # What follows the last boundary means nothing.
    return form


def _read_part(reader: _Reader, mark: bytes, form: Form, folder: Path) -> None:
    head = _Field("the head of a part", MAX_HEAD_BYTES)
    reader.until(b"\r\n\r\n", head.write, "the head of a part")
    message = email.parser.HeaderParser().parsestr(head.text())
    name = message.get_param("name", header="content-disposition")
    if not isinstance(name, str) or message.get_content_disposition() != "form-data":
        raise bad('a part has no name: its head needs a line Content-Disposition: form-data; name="..."')
    if name in form.fields or (name == SCENE and form.scene is not None):
        raise bad(f"the part {name!r} is there twice")
    if name == SCENE:
        file = SceneFile(folder)
        try:
            reader.until(mark, file.write, f"the part {name!r}")
        finally:
            form.scene, form.sha256 = file.path, file.close()
    else:
        text = _Field(f"the field {name!r}", MAX_FIELD_BYTES)
        reader.until(mark, text.write, f"the part {name!r}")
        form.fields[name] = text.text()
