"""What scenes that are built of arrays get."""
from __future__ import annotations

import threading
from typing import Any, Dict, Optional

from ._camera import Camera
from ._draft import Draft
from ._errors import Error


class Building:
    """The functions of a Scene that add to it."""

    _lock: threading.RLock
    _draft: Optional[Draft]
    _is_stale: bool
    _edits: Dict[str, Any]

    def _drafted(self) -> Draft:
        """The draft, which is about to get more."""
        if self._draft is None:
            raise Error("the scene is from a file, and nothing can be added; begin with candela.Scene()", "usage", 2)
        self._is_stale = True
        return self._draft

    def add_mesh(self, vertices: Any, faces: Any, *, name: Optional[str] = None, material: Optional[str] = None,
                 normals: Any = None, uvs: Any = None, uvs1: Any = None, colors: Any = None, emission: Any = None,
                 two_sided: Optional[bool] = None, spread: Optional[float] = None, transform: Any = None,
                 transforms: Any = None, shadow_catcher: Optional[str] = None,
                 visible_to_camera: Optional[bool] = None) -> str:
        """Adds an object of triangles; returns its name. It is read when the scene is next used: until then, its arrays must
        stay as they are.

        vertices: (N, 3), in the object's space [m]. faces: (M, 3), indices of vertices, counter-clockwise seen from the
        front. material: a name; by default "default", a grey. normals: (N, 3), for smooth shading. uvs, uvs1: (N, 2), texture
        coordinates, v upwards. colors: (N, 3) or (N, 4), linear, from 0 to 1; for materials with vertex_colors=True.
        emission: radiance [W/(m² sr)]. spread: the full angle around the normal in which it leaves [degrees]. transform:
        (4, 4), from the object's space to the world's. transforms: (K, 4, 4), of as many instances. shadow_catcher: "catch"
        or "catch-reflections", if only shadows on it are to be seen. visible_to_camera: False if camera rays pass it.
        """
        if transform is not None and transforms is not None:
            raise Error("give either transform or transforms", "usage", 2)
        with self._lock:
            draft = self._drafted()
            chosen = draft.free_name(name, "mesh")
            draft.meshes[chosen] = {"vertices": vertices, "faces": faces, "normals": normals, "uvs": uvs, "uvs1": uvs1,
                                    "colors": colors, "emission": emission, "two_sided": two_sided, "spread": spread,
                                    "transform": transform, "transforms": transforms,
                                    "material": self._material_for(material, emission), "shadow_catcher": shadow_catcher,
                                    "visible_to_camera": visible_to_camera}
            return chosen

    def _material_for(self, material: Optional[str], emission: Any) -> Optional[str]:
        draft = self._drafted()
        if material is None and emission is None:
            draft.materials.setdefault("default", {"type": "diffuse", "reflectance": 0.5})
            return "default"
        return material

    def add_shape(self, type: str, *, name: Optional[str] = None, material: Optional[str] = None, **keys: Any) -> str:
        """Adds a shape of docs/scene-format.md as an object: a "sphere", "disk", "quad" or "box", or a file of the type "obj"
        or "ply". keys: its own, such as radius, and transform, (4, 4). Returns its name."""
        with self._lock:
            draft = self._drafted()
            chosen = draft.free_name(name, type)
            shape = {"type": type, "material": self._material_for(material, keys.get("emission")), **keys}
            draft.shapes[chosen] = {key: value for key, value in shape.items() if value is not None}
            return chosen

    def add_material(self, name: str, type: str = "principled", **values: Any) -> None:
        """Adds a material, with values of docs/scene-format.md. Colours are linear; images are arrays or candela.Texture."""
        with self._lock:
            draft = self._drafted()
            if name in draft.materials and name != "default":
                raise Error(f"there is a material {name!r} already; choose another name", "usage", 2)
            draft.materials[name] = {"type": type, **values}

    def add_light(self, type: str, name: Optional[str] = None, **keys: Any) -> None:
        """Adds a light without a surface: "point", "spot" or "directional", with keys of docs/scene-format.md."""
        with self._lock:
            self._drafted().lights.append({"type": type, **({} if name is None else {"name": name}), **keys})

    def add_camera(self, camera: Camera, name: str = "main") -> None:
        """Adds a camera. The first is the default; without one, a camera sees all of the scene from above the front."""
        with self._lock:
            self._drafted().cameras[name] = camera.to_dict()
            self._edits.get("cameras", {}).pop(name, None)
