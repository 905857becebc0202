"""Pictures as arrays."""
from __future__ import annotations

import mmap
import os
import tempfile
import weakref
from pathlib import Path
from typing import Any, Dict, Tuple, Union

import numpy
from numpy.typing import NDArray

from ._connection import Connection
from ._errors import Error

Array = NDArray[numpy.float32]


class Image:
    """A picture, as it was when it was made. Its arrays are the program's memory, mapped: nothing is copied until they are
    written to, which the program does not see.

    Attributes:
        width, height: Pixels of the arrays.
        crop: (x0, y0, x1, y1), where the arrays are in the whole picture; x1 and y1 are exclusive.
        spp: Samples that every pixel has at least.
        complete: Whether all samples are there that were asked for.
        error: The estimated relative error, if one was asked for.
        seconds: The time that rendering took.
        layers: The names of the arrays.
    """

    def __init__(self, connection: Connection, place: Dict[str, Any]) -> None:
        self.width: int = place["width"]
        self.height: int = place["height"]
        x0, y0, x1, y1 = place["crop"]
        self.crop: Tuple[int, int, int, int] = (x0, y0, x1, y1)
        self.spp: int = place["spp"]
        self.complete: bool = place["complete"]
        self.error: Union[float, None] = place["error"]
        self.seconds: float = place["seconds"]
        self.layers: Tuple[str, ...] = tuple(place["layers"])
        self._connection = connection
        self._names: Union[Dict[str, Tuple[Any, ...]], None] = None
        self._id: str = place["image"]
        weakref.finalize(self, connection.call_later, "release", {"image": self._id})
        file = os.open(place["file"], os.O_RDWR | getattr(os, "O_CLOEXEC", 0))
        try:
            memory = mmap.mmap(file, place["bytes"], access=mmap.ACCESS_COPY)
        finally:
            os.close(file)
        self._arrays: Dict[str, Array] = {}
        for name, layer in place["layers"].items():
            count = self.width * self.height * layer["channels"]
            flat = numpy.frombuffer(memory, numpy.float32, count, layer["offset"])
            shape = (self.height, self.width, layer["channels"])
            self._arrays[name] = flat.reshape(shape if layer["channels"] > 1 else shape[:2])

    def __getitem__(self, layer: str) -> Array:
        """The layer of that name."""
        if layer not in self._arrays:
            raise Error(f"the image has no layer {layer!r} (it has: {', '.join(self.layers)}); render it with this layer",
                        "usage", 2)
        return self._arrays[layer]

    @property
    def rgb(self) -> Array:
        """(H, W, 3): radiance, linear Rec.709 [W/(m² sr)]."""
        return self["rgb"]

    @property
    def denoised(self) -> Array:
        """(H, W, 3): the same, denoised; see Scene.render()."""
        return self["denoised"]

    @property
    def alpha(self) -> Array:
        """(H, W): the fraction of camera rays that hit something; of a picture before nothing, 1 minus the share of the
        background that is seen."""
        return self["alpha"]

    @property
    def albedo(self) -> Array:
        """(H, W, 3): the mean albedo of what is hit first."""
        return self["albedo"]

    @property
    def normal(self) -> Array:
        """(H, W, 3): the mean shading normal of what is hit first, in world space."""
        return self["normal"]

    @property
    def position(self) -> Array:
        """(H, W, 3): where the ray through the pixel's centre hits, in world space [m]."""
        return self["position"]

    @property
    def depth(self) -> Array:
        """(H, W): the depth of that place along the axis of the view [m]; infinity where nothing is hit."""
        return self["depth"]

    @property
    def distance(self) -> Array:
        """(H, W): the distance of that place along the ray [m]; infinity where nothing is hit."""
        return self["distance"]

    @property
    def variance(self) -> Array:
        """(H, W, 3): the variance of the pixel's mean, of `rgb`; infinity with fewer than two samples."""
        return self["variance"]

    @property
    def object_id(self) -> Array:
        """(H, W): the number of the object that covers most of the pixel, in names["object_id"]; 0: none."""
        return self["object_id"]

    @property
    def instance_id(self) -> Array:
        """(H, W): the same for instances; names["instance_id"] has the object's name and the instance's number."""
        return self["instance_id"]

    @property
    def material_id(self) -> Array:
        """(H, W): the same for materials."""
        return self["material_id"]

    @property
    def names(self) -> Dict[str, Tuple[Any, ...]]:
        """What the numbers in the layers of ids mean: names["object_id"][number]. Number 0 is None."""
        if self._names is None:
            labels = self._connection.call("labels", {"image": self._id})
            objects = (None, *labels["objects"])
            instances = tuple((objects[one["object"]], one["instance"]) for one in labels["instances"])
            self._names = {"object_id": objects, "instance_id": (None, *instances),
                           "material_id": (None, *labels["materials"])}
        return dict(self._names)

    @property
    def samples(self) -> Array:
        """(H, W): the number of samples."""
        return self["samples"]

    def save(self, path: Union[str, os.PathLike[str]], exposure: Union[float, str] = 0.0,
             tonemap: str = "linear") -> None:
        """Writes what `candela render` would: .exr with all layers, or .png, .jpg or .webp for the screen. Changes of the
        arrays are not in it.

        exposure: stops, or "auto". tonemap: "linear", "reinhard", "aces", "agx" or "neutral".
        """
        self._connection.call("save", {"image": self._id, "file": os.path.abspath(path), "exposure": exposure,
                                       "tonemap": tonemap})

    def _repr_png_(self) -> bytes:
        with tempfile.TemporaryDirectory() as folder:
            path = Path(folder) / "image.png"
            self.save(path)
            return path.read_bytes()

    def __repr__(self) -> str:
        return f"<candela.Image of {self.width}x{self.height} pixels, {self.spp} spp: {', '.join(self.layers)}>"
