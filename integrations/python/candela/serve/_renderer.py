"""The program that renders, which gets one job at a time, and the scenes that it keeps loaded."""
from __future__ import annotations

import collections
import os
import queue
import threading
import time
from http import HTTPStatus
from typing import Any, Callable, Dict, List, Optional, Tuple

from candela._connection import Connection
from candela._errors import Error
from candela.serve._metrics import Metrics
from candela.serve._refusal import Refusal

# Seconds that the program gets to stop what it does, before it is killed.
GRACE = 5.0
# What a driver for CPUs and the program itself need, beside scenes (SECURITY.md) [bytes].
PROGRAM_BYTES = 512 << 20


class Job:
    """What a request has the program do."""

    def __init__(self, run: Callable[[Renderer], None]) -> None:
        self.run = run
        self.done = threading.Event()
        self.began: Optional[float] = None
        self.error: Optional[BaseException] = None
        self.stopped: Optional[float] = None  # When it was told to stop.


class Renderer:
    """A program `candela serve`, a queue of jobs for it, and the thread that does them in order."""

    def __init__(self, options: List[str], memory_limit: int, scenes: int, metrics: Metrics) -> None:
        self._options = [*options, "--memory-limit", str(memory_limit)]
        self.memory_limit = memory_limit
        self._most_scenes = scenes
        self._metrics = metrics
        self._lock = threading.RLock()
        self._jobs: queue.SimpleQueue[Optional[Job]] = queue.SimpleQueue()
        self._job: Optional[Job] = None
        self._connection: Optional[Connection] = None
        self._scenes: collections.OrderedDict[Tuple[Any, ...], str] = collections.OrderedDict()
        self._mine: Optional[str] = None  # The scene of the job that runs.
        self._thread = threading.Thread(target=self._work, name="candela-renderer", daemon=True)
        self._thread.start()

    def submit(self, job: Job) -> None:
        """Puts it at the end of the queue. `done` is set in the end, and `error` if it failed."""
        self._jobs.put(job)

    def stop(self, job: Job) -> None:
        """Ends a job, which may wait or run; call it again until it is done. A program that does not stop is killed."""
        now = time.monotonic()
        with self._lock:
            if job.stopped is None:
                job.stopped = now
            connection = self._connection
            if self._job is not job or connection is None or not connection.is_open:
                return
            if now - job.stopped > GRACE:
                connection._process.kill()
            else:
                connection._send(0, "cancel", {})  # Whatever it does: it does only this.

    def call(self, method: str, params: Dict[str, Any]) -> Dict[str, Any]:
        """The result of a request to the program, for the job that runs; raises Error."""
        with self._lock:
            connection = self._open()
            self._check()
        result = connection.call(method, params)
        self._check()
        return result

    def scene(self, key: Optional[Tuple[Any, ...]], params: Dict[str, Any]) -> str:
        """The id of a scene: of one that is still loaded under this key, or else loaded now."""
        with self._lock:
            self._open()  # A program that has ended has no scenes any more.
        if key is not None and key in self._scenes:
            self._scenes.move_to_end(key)
            self._metrics.add("scenes_reused")
            self._mine = self._scenes[key]
            return self._mine
        while len(self._scenes) >= self._most_scenes:
            self.call("close", {"scene": self._scenes.popitem(last=False)[1]})
        number: str = self.call("load", params)["scene"]
        self._metrics.add("scenes_loaded")
        self._scenes[key if key is not None else ("once", number)] = number
        self._mine = number
        return number

    def forget(self, scene: str) -> None:
        """Frees a scene."""
        for key in [key for key, number in self._scenes.items() if number == scene]:
            del self._scenes[key]
        self.call("close", {"scene": scene})

    def release(self, image: str) -> None:
        """Frees an image, also for a job that was stopped."""
        if self._connection is not None and self._connection.is_open:
            self._connection._send(0, "release", {"image": image})

    def close(self) -> None:
        """Ends the program, and the thread after the job that runs."""
        self._jobs.put(None)
        with self._lock:
            if self._job is not None:
                self._job.stopped = time.monotonic() - GRACE
            if self._connection is not None:
                self._connection._process.kill()
        self._thread.join(GRACE)
        self._end()

    @property
    def resident_bytes(self) -> int:
        """The memory of the program; 0 without one, or where the system does not tell."""
        connection = self._connection
        try:
            if connection is None:
                return 0
            with open(f"/proc/{connection._process.pid}/statm", encoding="ascii") as statm:
                return int(statm.read().split()[1]) * os.sysconf("SC_PAGE_SIZE")
        except (OSError, ValueError, IndexError):
            return 0

    def _check(self) -> None:
        if self._job is not None and self._job.stopped is not None:
            raise Refusal(HTTPStatus.SERVICE_UNAVAILABLE, "the request was stopped")

    def _open(self) -> Connection:
        if self._connection is None or not self._connection.is_open:
            self._end()
            try:
                self._connection = Connection(self._options)
            except Error as error:
                raise Refusal(HTTPStatus.SERVICE_UNAVAILABLE, str(error)) from error
            self._metrics.add("program_starts")
        return self._connection

    def _end(self) -> None:
        """Ends the program, and forgets its scenes."""
        self._scenes.clear()
        if self._connection is not None:
            self._connection.close()
            self._connection = None

    def _work(self) -> None:
        while True:
            job = self._jobs.get()
            if job is None:
                return
            with self._lock:
                self._job, self._mine = job, None
                job.began = time.monotonic()
            try:
                self._check()
                self._run(job)
            except BaseException as error:  # pylint: disable=broad-except
                job.error = error
            with self._lock:
                self._job = None
                if self.resident_bytes > self.memory_limit + PROGRAM_BYTES:
                    self._end()
            job.done.set()

    def _run(self, job: Job) -> None:
        try:
            job.run(self)
        except Error as error:
            others = any(scene != self._mine for scene in self._scenes.values())
            if error.kind != "out_of_memory" or not others:
                raise self._refusal(error) from error
            with self._lock:
                self._end()  # Without the scenes of others, it may fit.
            try:
                job.run(self)
            except Error as again:
                raise self._refusal(again) from again

    def _refusal(self, error: Error) -> Refusal:
        if self._connection is None or not self._connection.is_open:
            return Refusal(HTTPStatus.INTERNAL_SERVER_ERROR, str(error))
        return Refusal.of(error)
