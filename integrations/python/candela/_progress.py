"""How far a rendering has got."""
from __future__ import annotations

import importlib
from typing import Any, Callable, Dict, Union

Progress = Union[bool, Callable[[float], None], None]


class Bar:
    """Shows progress as the caller wants it."""

    def __init__(self, progress: Progress) -> None:
        self._tell = progress if callable(progress) else None
        self._bar: Any = None
        self._done = 0.0
        if progress is True:
            try:
                self._bar = importlib.import_module("tqdm.auto").tqdm(total=100, unit="%", leave=False)
            except ImportError:
                pass

    def __enter__(self) -> Bar:
        return self

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def finish(self) -> None:
        """The program reports often, but not every step."""
        if self._done < 1.0:
            self({"done": 1.0})

    def __call__(self, told: Dict[str, Any]) -> None:
        self._done = told["done"]
        if self._tell is not None:
            self._tell(told["done"])
        if self._bar is not None:
            self._bar.update(100.0 * told["done"] - self._bar.n)
