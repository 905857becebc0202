"""The objects and materials of a scene, by name."""
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Dict, Iterator, List, Mapping, Tuple

import numpy
from numpy.typing import NDArray

from ._values import steps_of

if TYPE_CHECKING:
    from ._scene import Scene

Matrix = NDArray[numpy.float64]


class Material:
    """A material of a scene. Its attributes are the keys of its type in docs/scene-format.md, such as `reflectance`: colours
    are (3,) arrays or one number, linear; images are arrays or candela.Texture. Setting one changes the scene; further values
    stay. update() sets several at once."""

    def __init__(self, scene: Scene, name: str) -> None:
        object.__setattr__(self, "_scene", scene)
        object.__setattr__(self, "_name", name)

    def update(self, **values: Any) -> None:
        """Sets several values at once. With `type`, the material becomes another."""
        self._scene.change(materials={self._name: values})

    def to_dict(self) -> Dict[str, Any]:
        """Its values; of images, the names."""
        values: Dict[str, Any] = self._scene._call("material", material=self._name)["values"]
        return values

    def __getattr__(self, key: str) -> Any:
        if key.startswith("_"):
            raise AttributeError(key)
        values = self.to_dict()
        if key not in values:
            raise AttributeError(f"the material {self._name!r} has no {key!r} (it has: {', '.join(values)})")
        value = values[key]
        return numpy.array(value) if isinstance(value, list) else value

    def __setattr__(self, key: str, value: Any) -> None:
        self.update(**{key: value})

    def __dir__(self) -> List[str]:
        return [*super().__dir__(), *self.to_dict()]

    def __repr__(self) -> str:
        return f"<candela material {self._name!r}>"


class Instance:
    """An object as it is shown once."""

    def __init__(self, scene: Scene, name: str, number: int) -> None:
        self._scene = scene
        self._name = name
        self._number = number

    def _description(self) -> Dict[str, Any]:
        for instance in self._scene._call("object", object=self._name)["instances"]:
            if instance["instance"] == self._number:
                found: Dict[str, Any] = instance
                return found
        raise IndexError(f"the object {self._name!r} has no instance {self._number}")

    def _change(self, **values: Any) -> None:
        self._scene.change(objects={self._name: {"instances": {str(self._number): values}}})

    @property
    def transform(self) -> Matrix:
        """(4, 4): from the object's space to the world's, for columns; the last row is 0, 0, 0, 1."""
        matrix = numpy.array(self._description()["transform"], numpy.float64).reshape(4, 4)
        matrix.flags.writeable = False  # A change of a part of it would be lost.
        return matrix

    @transform.setter
    def transform(self, matrix: Any) -> None:
        self._change(transform=steps_of(matrix, f"the transform of {self._name!r}"))

    @property
    def visible(self) -> bool:
        """Whether it is there: what is not seen casts no shadow either."""
        return bool(self._description()["visible"])

    @visible.setter
    def visible(self, value: bool) -> None:
        self._change(visible=bool(value))

    @property
    def materials(self) -> Tuple[str, ...]:
        """The names of its materials."""
        return tuple(self._description()["materials"])


class Object(Instance):
    """An object of a scene. Its transform is that of its only instance; `instances` has those of one that is shown more than
    once."""

    def __init__(self, scene: Scene, name: str) -> None:
        super().__init__(scene, name, 0)

    def _change(self, **values: Any) -> None:
        self._scene.change(objects={self._name: values})

    @property
    def instances(self) -> Tuple[Instance, ...]:
        """Its instances."""
        found = self._scene._call("object", object=self._name)["instances"]
        return tuple(Instance(self._scene, self._name, instance["instance"]) for instance in found)

    def __repr__(self) -> str:
        return f"<candela object {self._name!r}>"


class Objects(Mapping[str, Object]):
    """The objects of a scene by name."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def _names(self) -> List[str]:
        names: List[str] = self._scene._describe()["objects"]
        return names

    def __getitem__(self, name: str) -> Object:
        if name not in self._names():
            raise KeyError(f"no object {name!r}; there are: {', '.join(self._names())}")
        return Object(self._scene, name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def __len__(self) -> int:
        return len(self._names())

    def __repr__(self) -> str:
        return f"<candela objects: {', '.join(self)}>"


class Materials(Mapping[str, Material]):
    """The materials of a scene by name."""

    def __init__(self, scene: Scene) -> None:
        self._scene = scene

    def _names(self) -> List[str]:
        names: List[str] = self._scene._describe()["materials"]
        return names

    def __getitem__(self, name: str) -> Material:
        if name not in self._names():
            raise KeyError(f"no material {name!r}; there are: {', '.join(self._names())}")
        return Material(self._scene, name)

    def __iter__(self) -> Iterator[str]:
        return iter(self._names())

    def __len__(self) -> int:
        return len(self._names())

    def __repr__(self) -> str:
        return f"<candela materials: {', '.join(self)}>"
