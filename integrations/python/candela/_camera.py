"""Cameras."""
from __future__ import annotations

from typing import Any, Callable, Dict, Optional, Sequence

import numpy
from numpy.typing import NDArray

Vector = NDArray[numpy.float64]


class Camera:
    """A camera, by the keys of a scene file (docs/scene-format.md): `position`, `look_at` and `up` are points and a
    direction in world space [m], `vertical_fov` is the full angle [degrees].

    One of a scene changes the scene when an attribute is set; others are for `Scene.render(camera=...)`. Further keys,
    such as `lens`, are set by update().
    """

    def __init__(self, position: Sequence[float], look_at: Sequence[float], vertical_fov: Optional[float] = None,
                 up: Sequence[float] = (0.0, 1.0, 0.0), **keys: Any) -> None:
        self._keys: Dict[str, Any] = {"position": _numbers(position), "look_at": _numbers(look_at), "up": _numbers(up),
                                      **keys}
        if vertical_fov is not None:
            self._keys["vertical_fov"] = float(vertical_fov)
        self._change: Optional[Callable[[Dict[str, Any]], None]] = None

    @classmethod
    def _of(cls, keys: Dict[str, Any], change: Optional[Callable[[Dict[str, Any]], None]] = None) -> Camera:
        camera = cls.__new__(cls)
        camera._keys = dict(keys)
        camera._change = change
        return camera

    def update(self, **keys: Any) -> None:
        """Sets several keys at once; None removes one."""
        changed = {**self._keys, **{key: _plain(value) for key, value in keys.items()}}
        changed = {key: value for key, value in changed.items() if value is not None}
        if self._change is not None:
            self._change(changed)
        self._keys = changed

    def to_dict(self) -> Dict[str, Any]:
        """The keys of a scene file."""
        return dict(self._keys)

    @property
    def position(self) -> Vector:
        """(3,): where the camera is [m]."""
        return _vector(self._keys["position"])

    @position.setter
    def position(self, value: Sequence[float]) -> None:
        self.update(position=value)

    @property
    def look_at(self) -> Vector:
        """(3,): a point on its axis [m]."""
        return _vector(self._keys["look_at"])

    @look_at.setter
    def look_at(self, value: Sequence[float]) -> None:
        self.update(look_at=value)

    @property
    def up(self) -> Vector:
        """(3,): the direction that is upwards in the picture."""
        return _vector(self._keys["up"])

    @up.setter
    def up(self, value: Sequence[float]) -> None:
        self.update(up=value)

    @property
    def vertical_fov(self) -> Optional[float]:
        """The full vertical field of view [degrees]; None if the camera states its view in another way."""
        value: Optional[float] = self._keys.get("vertical_fov")
        return value

    @vertical_fov.setter
    def vertical_fov(self, value: float) -> None:
        self.update(vertical_fov=float(value))

    def __repr__(self) -> str:
        return f"candela.Camera({', '.join(f'{key}={value!r}' for key, value in self._keys.items())})"


def _numbers(values: Sequence[float]) -> Any:
    return numpy.asarray(values, numpy.float64).tolist()


def _plain(value: Any) -> Any:
    """The same for JSON."""
    if isinstance(value, (numpy.ndarray, numpy.generic)):
        return value.tolist()
    if isinstance(value, (list, tuple)):
        return [_plain(element) for element in value]
    if isinstance(value, dict):
        return {key: _plain(element) for key, element in value.items()}
    return value


def _vector(values: Any) -> Vector:
    """An array that says when somebody tries to change a part of it."""
    vector = numpy.array(values, numpy.float64)
    vector.flags.writeable = False
    return vector
