"""Figures about the server, in the text format of Prometheus."""
from __future__ import annotations

import threading
from collections import Counter
from typing import Callable, Counter as Counts, Dict, List, Tuple

TYPE = "text/plain; version=0.0.4; charset=utf-8"


class Metrics:
    """Counts what has happened. Threads may share it."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._answers: Counts[int] = Counter()
        self._totals: Dict[str, float] = {name: 0 for name in _TOTALS}
        self._gauges: List[Tuple[str, str, Callable[[], float]]] = []

    def answered(self, status: int) -> None:
        """Counts an answer."""
        with self._lock:
            self._answers[status] += 1

    def add(self, name: str, value: float = 1) -> None:
        """Adds to one of _TOTALS."""
        with self._lock:
            self._totals[name] += value

    def gauge(self, name: str, text: str, value: Callable[[], float]) -> None:
        """Adds what is asked for anew each time."""
        self._gauges.append((name, text, value))

    def total(self, name: str) -> float:
        """One of _TOTALS so far."""
        with self._lock:
            return self._totals[name]

    def text(self) -> str:
        """All of them."""
        with self._lock:
            answers, totals = dict(self._answers), dict(self._totals)
        lines = _head("candela_http_requests_total", "Requests that were answered, by their status.", "counter")
        lines += [f'candela_http_requests_total{{code="{code}"}} {count}' for code, count in sorted(answers.items())]
        for name, text in _TOTALS.items():
            lines += _head(f"candela_{name}_total", text, "counter") + [f"candela_{name}_total {totals[name]:.9g}"]
        for name, text, value in self._gauges:
            lines += _head(f"candela_{name}", text, "gauge") + [f"candela_{name} {value():.9g}"]
        return "\n".join(lines) + "\n"


_TOTALS = {
    "pictures": "Pictures that were rendered.",
    "render_seconds": "Time that rendering took.",
    "scenes_loaded": "Scenes that were loaded.",
    "scenes_reused": "Pictures of scenes that were still loaded.",
    "cancelled": "Requests whose client went away before there was a picture.",
    "received_bytes": "Bytes of the requests, without their heads.",
    "sent_bytes": "Bytes of the pictures.",
    "program_starts": "How often the program that renders was started.",
}


def _head(name: str, text: str, kind: str) -> List[str]:
    return [f"# HELP {name} {text}", f"# TYPE {name} {kind}"]
