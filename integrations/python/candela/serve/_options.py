"""The options of a request: from the query of its address, a form, or JSON."""
from __future__ import annotations

import json
import re
from dataclasses import dataclass
from http import HTTPStatus
from typing import Any, Dict, List, Optional, Tuple
from urllib.parse import parse_qsl

from candela.serve._refusal import Refusal

# By what the program does with them: docs/protocol.md has their meaning, and the program checks their values.
LOAD = ("time", "animation")
RENDER = ("camera", "size", "crop", "spp", "seed", "layers", "background", "target_error", "time_limit", "estimator",
          "sampler", "max_depth")
SAVE = ("exposure", "tonemap")
OURS = ("file", "format")
TYPES = {"png": "image/png", "jpg": "image/jpeg", "jpeg": "image/jpeg", "webp": "image/webp", "exr": "image/x-exr"}

# Options that are names; other texts are numbers, lists or names.
_NAMES = ("animation", "camera", "background", "estimator", "sampler", "tonemap", "format", "file")
MAX_OPTIONS = 64
# What the device keeps of a pixel, and how many bytes each value of a layer has (docs/adding.md).
_STATE_BYTES = 128
_LAYER_VALUES = 18
_VALUE_BYTES = 4


def bad(message: str) -> Refusal:
    """A refusal of an option."""
    return Refusal(HTTPStatus.BAD_REQUEST, message)


@dataclass
class Options:
    """What a request asks for."""

    values: Dict[str, Any]

    def of(self, names: Tuple[str, ...]) -> Dict[str, Any]:
        """Those of the names that are given."""
        return {name: self.values[name] for name in names if name in self.values}

    @property
    def format(self) -> str:
        """The end of the picture's file name."""
        return str(self.values.get("format", "png"))

    @property
    def file(self) -> Optional[str]:
        """The scene's name below the root."""
        return self.values.get("file")

    def check(self) -> None:
        """Refuses options that no request has, and those that are the server's own matter."""
        known = LOAD + RENDER + SAVE + OURS
        for name in self.values:
            if name not in known:
                raise bad(f"unknown option {name!r} (known: {', '.join(known)})")
        if self.format not in TYPES:
            raise bad(f"unknown format {self.format!r} (known: {', '.join(TYPES)})")
        if self.file is not None and not isinstance(self.file, str):
            raise bad("\"file\" is not the name of a file below the server's root")

    def picture_bytes(self) -> int:
        """The least memory that the picture needs, if its size is given."""
        size = self.values.get("size")
        if not isinstance(size, list) or len(size) != 2 or not all(isinstance(side, int) and side > 0 for side in size):
            return 0
        layers = _LAYER_VALUES if self.values.get("layers") == "all" else 4
        pixels: int = size[0] * size[1]
        return pixels * (_STATE_BYTES // 2 + layers * _VALUE_BYTES)


def from_texts(texts: Dict[str, str]) -> Dict[str, Any]:
    """Options whose values are texts, as `640x480`, `0,0,64,64`, `0.5` or JSON."""
    return {name: _value(name, text) for name, text in texts.items()}


def from_query(query: str) -> Dict[str, Any]:
    """The options in an address."""
    try:
        pairs = parse_qsl(query, keep_blank_values=True, strict_parsing=bool(query), errors="strict",
                          max_num_fields=MAX_OPTIONS)
    except ValueError:
        raise bad(f"the address's query is not a list of at most {MAX_OPTIONS} options, as in ?spp=64&size=640x480"
                  ) from None
    texts = dict(pairs)
    if len(texts) != len(pairs):
        raise bad("the address's query has an option twice")
    return from_texts(texts)


def from_json(data: bytes) -> Dict[str, Any]:
    """The options of a request that is nothing else."""
    try:
        values = json.loads(data)
    except (ValueError, RecursionError) as error:
        raise bad(f"the request is not JSON: {error}") from None
    if not isinstance(values, dict):
        raise bad('the request is not an object of options in JSON, as {"file": "chair.glb", "spp": 64}')
    return values


def merged(*parts: Dict[str, Any]) -> Options:
    """All of them, checked."""
    values: Dict[str, Any] = {}
    for part in parts:
        for name in part:
            if name in values:
                raise bad(f"the option {name!r} is in the address and in the request; give it once")
        values.update(part)
    options = Options(values)
    options.check()
    return options


def _value(name: str, text: str) -> Any:
    if re.fullmatch(r"\d{1,9}x\d{1,9}", text):
        return [int(side) for side in text.split("x")]
    if name in _NAMES and not text.startswith("{"):
        return text
    try:
        return json.loads(text)
    except (ValueError, RecursionError):
        return _list(text) if "," in text else text


def _list(text: str) -> List[Any]:
    parts: List[Any] = text.split(",")
    try:
        return [json.loads(part) for part in parts]
    except ValueError:
        return parts
