"""What the program is asked for, to answer a request with a picture."""
from __future__ import annotations

from dataclasses import dataclass, field
from pathlib import Path
from typing import Any, Dict, Optional, Tuple

from candela.serve._options import LOAD, RENDER, SAVE, TYPES, Options
from candela.serve._renderer import Renderer


@dataclass
class Source:
    """Where a scene is: parameters of the program's method `load`, and what its bytes are known by, if they cannot
    change."""

    load: Dict[str, Any]
    key: Optional[Tuple[Any, ...]] = None


@dataclass
class Picture:
    """A file that answers a request."""

    path: Path
    type: str
    notes: Dict[str, str] = field(default_factory=dict)


def notes_of(outcome: Dict[str, Any]) -> Dict[str, str]:
    """The head of an answer says what the picture is."""
    return {"Candela-Spp": str(outcome["spp"]), "Candela-Complete": "true" if outcome["complete"] else "false",
            "Candela-Seconds": f"{outcome['seconds']:.3f}"}


def render(renderer: Renderer, source: Source, options: Options, folder: Path) -> Picture:
    """Renders a picture into the folder."""
    loading = options.of(LOAD)
    key = None if source.key is None else (*source.key, *(str(value) for value in sorted(loading.items())))
    scene = renderer.scene(key, {**source.load, **loading})
    outcome = renderer.call("render", {"scene": scene, **options.of(RENDER)})
    image = renderer.call("image", {"scene": scene})["image"]
    path = folder / f"picture.{options.format}"
    try:
        renderer.call("save", {"image": image, "file": str(path), **options.of(SAVE)})
    finally:
        renderer.release(image)
    if key is None:
        renderer.forget(scene)
    return Picture(path, TYPES[options.format], notes_of(outcome))
