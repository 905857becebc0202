"""The program `candela serve`, and the messages to it and from it: docs/protocol.md describes them."""
from __future__ import annotations

import collections
import glob
import itertools
import json
import os
import queue
import subprocess
import tempfile
import threading
import time
import weakref
from typing import Any, Callable, Deque, Dict, List, Optional, Tuple

from ._driver import advice, environment
from ._errors import Error
from ._program import find_program

PROTOCOL = 1
# Seconds that a rendering gets to stop, and the program to end.
PATIENCE = 10.0
# Seconds that it gets to start.
START = 60.0

Progress = Callable[[Dict[str, Any]], None]
Answer = Tuple[str, Any]


class Connection:
    """A running program, which threads may share."""

    def __init__(self, options: List[str]) -> None:
        program = find_program()
        self._errors = tempfile.TemporaryFile()
        # A session of its own: Ctrl-C in the terminal must not end the program.
        self._process = subprocess.Popen([program, "serve", "--stdio", *options], stdin=subprocess.PIPE,
                                         stdout=subprocess.PIPE, stderr=self._errors, bufsize=0, start_new_session=True,
                                         env=environment(program))
        self._lock = threading.Lock()
        self._ids = itertools.count(1)
        self._answers: Dict[int, queue.SimpleQueue[Answer]] = {}
        self._unused: Deque[Tuple[str, Dict[str, str]]] = collections.deque()
        self._end: Optional[str] = None  # Why there are no more answers.
        self._reader = threading.Thread(target=self._read, name="candela", daemon=True)
        self._reader.start()
        _all.add(self)
        try:
            self.call("version", {"protocol": PROTOCOL}, timeout=START)
        except BaseException:
            self.close()
            raise

    def call(self, method: str, params: Dict[str, Any], progress: Optional[Progress] = None,
             timeout: Optional[float] = None, sent: Optional[Callable[[int], None]] = None) -> Dict[str, Any]:
        """The result of a request; raises Error for its error. If the caller is interrupted, or progress() raises, the
        request is cancelled first; so it is after `timeout` seconds, without waiting for that, and Error is raised. sent() gets
        the request's number, for cancel()."""
        end = None if timeout is None else time.monotonic() + timeout
        self._send_unused()
        number = next(self._ids)
        answers: queue.SimpleQueue[Answer] = queue.SimpleQueue()
        self._send(number, method, params, answers)
        try:
            if sent is not None:
                sent(number)
            while True:
                kind, value = _next(answers, end)
                if kind != "progress":
                    return _result(kind, value)
                if progress is not None:
                    progress(value)
        except queue.Empty:
            self._send(0, "cancel", {"request": number})
            raise Error(f"{method}: not done within {timeout} seconds; allow more, or ask for less", "timeout", 7) from None
        except Error:
            raise
        except BaseException:
            self._cancel(number, answers)
            raise
        finally:
            with self._lock:
                self._answers.pop(number, None)

    def cancel(self, number: int) -> None:
        """Cancels a request of another thread, whose call() then returns what there is of its result."""
        self._send(0, "cancel", {"request": number})

    def call_later(self, method: str, params: Dict[str, str]) -> None:
        """Sends a request before the next one. May be called at any moment, by any thread."""
        self._unused.append((method, params))

    def close(self) -> None:
        """Ends the program, whatever it does."""
        if self._end is None:
            self._end = "the session is closed"
        assert self._process.stdin is not None and self._process.stdout is not None
        try:
            self._process.stdin.close()
        except (OSError, ValueError):
            pass
        try:
            self._process.wait(0 if self._answers else PATIENCE)
        except subprocess.TimeoutExpired:
            self._process.kill()
            self._process.wait()
        if self._reader is not threading.current_thread():
            self._reader.join(PATIENCE)
        self._process.stdout.close()
        self._errors.close()
        self._remove_files()

    def forget(self) -> None:
        """In a process that was forked: leaves the program to the parent."""
        self._end = "the session belongs to the process that was forked; load the scene in this one"
        self._lock = threading.Lock()
        self._process.returncode = 0
        for stream in (self._process.stdin, self._process.stdout):
            if stream is not None:
                stream.close()  # Neither has a buffer, nor a lock that a thread of the parent may hold.

    @property
    def is_open(self) -> bool:
        """Whether requests can be sent."""
        return self._end is None

    def _send(self, number: int, method: str, params: Dict[str, Any],
              answers: Optional[queue.SimpleQueue[Answer]] = None) -> None:
        line = json.dumps({"jsonrpc": "2.0", "id": number, "method": method, "params": params}) + "\n"
        with self._lock:
            if self._end is not None:
                raise Error(self._end)
            if answers is not None:
                self._answers[number] = answers
            assert self._process.stdin is not None
            try:
                rest = memoryview(line.encode())
                while rest:
                    rest = rest[self._process.stdin.write(rest) or 0:]
            except (OSError, ValueError):
                pass  # The reader says why.

    def _send_unused(self) -> None:
        while self._unused:
            try:
                self._send(0, *self._unused.popleft())
            except (IndexError, Error):
                return

    def _cancel(self, number: int, answers: queue.SimpleQueue[Answer]) -> None:
        try:
            self._send(0, "cancel", {"request": number})
            while answers.get(timeout=PATIENCE)[0] == "progress":
                pass
        except (Error, queue.Empty):
            pass

    def _read(self) -> None:
        assert self._process.stdout is not None
        try:
            rest = b""
            while chunk := self._process.stdout.read(1 << 16):
                *lines, rest = (rest + chunk).split(b"\n")
                for line in lines:
                    self._take(json.loads(line))
        except (OSError, ValueError):
            pass
        end = self._end or "the program ended: " + self._last_words()
        with self._lock:
            self._end = end
            waiting = list(self._answers.values())
        for answers in waiting:
            answers.put(("error", {"message": end}))

    def _take(self, message: Dict[str, Any]) -> None:
        number: Any = message["params"]["request"] if "method" in message else message.get("id")
        with self._lock:
            answers = self._answers.get(number)
        if answers is None:
            return
        if "method" in message:
            answers.put(("progress", message["params"]))
        elif "error" in message:
            answers.put(("error", message["error"]))
        else:
            answers.put(("result", message["result"]))

    def _last_words(self) -> str:
        """Why the program ended."""
        try:
            code = self._process.wait(PATIENCE)
            self._errors.seek(0)
            lines = self._errors.read().decode(errors="replace").strip().splitlines()
        except (OSError, ValueError, subprocess.TimeoutExpired):
            return "unknown"
        finally:
            self._remove_files()
        how = f"signal {-code}" if code < 0 else f"exit code {code}"
        return f"{how}: {lines[-1]}" if lines else how

    def _remove_files(self) -> None:
        """Removes what a program that was killed has left."""
        if self._process.poll() is None:
            return
        for folder in ("/dev/shm", tempfile.gettempdir()):
            for path in glob.glob(f"{glob.escape(folder)}/candela-shared-{self._process.pid}-*"):
                try:
                    os.unlink(path)
                except OSError:
                    pass


def _next(answers: queue.SimpleQueue[Answer], end: Optional[float]) -> Answer:
    """The next answer; raises queue.Empty if it does not come in time."""
    return answers.get(timeout=None if end is None else max(0.0, end - time.monotonic()))


def _result(kind: str, value: Any) -> Dict[str, Any]:
    if kind == "error":
        data = value.get("data", {})
        kind = data.get("kind", "failed")
        raise Error(value["message"] + (advice() if kind == "no_device" else ""), kind, data.get("exit_code", 1))
    result: Dict[str, Any] = value
    return result


_all: weakref.WeakSet[Connection] = weakref.WeakSet()


def _forget_all() -> None:
    for connection in list(_all):
        connection.forget()
    _all.clear()


os.register_at_fork(after_in_child=_forget_all)
