"""Physically based path tracing on any Vulkan device, to arrays of NumPy.

    import candela
    image = candela.load("scene.glb").render(spp=64, size=(640, 480))
    image.rgb      # (480, 640, 3), float32, linear Rec.709 radiance
    image.save("scene.png")

Lengths are in metres, angles in degrees; world space is right-handed with +Y up. Arrays of images are row-major, with
the origin at the top left.
"""
from ._camera import Camera
from ._errors import Error
from ._image import Image
from ._scene import Scene
from ._session import Session, devices, load
from ._tools import Comparison, Verdict, compare, selftest
from ._trimesh import from_trimesh
from ._values import Texture

__version__ = "0.1.0"

__all__ = ["Camera", "Comparison", "Error", "Image", "Scene", "Session", "Texture", "Verdict", "compare", "devices",
           "from_trimesh", "load", "selftest"]
