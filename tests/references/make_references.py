#!/usr/bin/env python3
"""Makes the references of this folder with Mitsuba 3: `python3 make_references.py [NAME]...`, or all of them.

A reference is the picture of a scene by an independent renderer: NAME.exr of NAME.json here, or of the scene of that
name in scenes/; mean and variance of the mean over many renderings with seeds of their own. reference_test.cpp compares
candela with them. Requirements, in a virtual environment of their own (candela itself does not need them):

    python3 -m venv venv && venv/bin/pip install mitsuba==3.9.1 numpy && venv/bin/python make_references.py

Mitsuba compiles its kernels with LLVM 16 or newer (Debian: libllvm19); where there are several, the variable
DRJIT_LIBLLVM_PATH names the library. All references together take about twenty minutes on two cores.
"""

import json
import re
import sys
import tempfile
from pathlib import Path

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
mi.set_log_level(mi.LogLevel.Error)

from meshes import box, read_ply, write_ply
import light_texture  # noqa: E402, F401 (registers a plugin; both need the variant)
import principled_model  # noqa: E402
import reflection_models  # noqa: E402
import spot_cone  # noqa: E402, F401 (registers a plugin)
from surroundings import around  # noqa: E402

HERE = Path(__file__).parent
SCENES = HERE.parent.parent / "scenes"

SIZE = 64  # Pixels on each side of every picture.
SEEDS = 64
# Samples per pixel and seed; the names of all references.
SPP = {
    "cornell-box": 256,
    "colour-bleeding": 256,
    "mirror": 256,
    "glass": 128,
    "absorbing-glass": 64,
    "nested-glass": 64,
    "rough-metal": 128,
    "phong": 256,
    "depth-of-field": 256,
    "environment": 128,
    "small-sphere-light": 128,
    "many-lights": 512,
    "mesh-light": 256,
    "smooth-normals": 128,
    "textured-diffuse": 256,
    "textured-roughness": 128,
    "textured-emitter": 256,
    "mask": 256,
    "normal-map": 256,
    "brushed-metal": 128,
    "frosted-glass": 64,
    "thin-glass": 256,
    "coated-plastic": 256,
    "punctual-lights": 256,
    "hundred-lights": 512,
    "orthographic": 256,
    "smoke": 128,
    "haze": 128,
    "milk": 64,
}

# Of scenes with media, where it is not 64.
MOST_VERTICES = {"haze": 40, "milk": 128}

# A string, which stays, or a comment, which becomes a space.
STRING_OR_COMMENT = re.compile(r'("(?:\\.|[^"\\])*")|//[^\n]*|/\*.*?\*/', re.DOTALL)


def read_scene(name):
    """The scene file, and the folder from which it names other files."""
    path = next(p for p in (HERE / f"{name}.json", SCENES / f"{name}.json") if p.exists())
    text = path.read_text(encoding="utf-8")
    return json.loads(STRING_OR_COMMENT.sub(lambda match: match.group(1) or " ", text)), path.parent


def rgb(value):
    """Three numbers from three, or from one for all channels."""
    return list(value) if isinstance(value, list) else [value] * 3


def colour(value):
    return bitmap(value, False) if isinstance(value, dict) else {"type": "rgb", "value": rgb(value)}


# --- Textures --------------------------------------------------------------------------------------------------------

FOLDER = [HERE]  # Of the scene's file: that of its images.


def uv_transform(texture):
    """From (u, v), v upwards, to where Mitsuba looks: v downwards, on either side."""
    scale, offset = np.eye(3), np.eye(3)
    scale[0, 0], scale[1, 1] = np.broadcast_to(texture.get("uv_scale", 1), 2)
    offset[:2, 2] = texture.get("uv_offset", [0, 0])
    turn = rotation(texture.get("uv_rotation", 0), [0, 0, 1])[:3, :3]
    flip = np.array([[1, 0, 0], [0, -1, 1], [0, 0, 1]])
    return mi.ScalarTransform3f(flip @ offset @ turn @ scale @ flip)


def bitmap(texture, is_data):
    """Mitsuba's texture. Its texels are multiplied by the factor here, since not all that take textures have one."""
    texels = np.array(mi.Bitmap(str(FOLDER[0] / texture["image"])), dtype=np.float32) / 255
    if texels.ndim == 2:
        texels = texels[..., None]
    encoding = texture.get("encoding", "linear" if is_data else "srgb")
    if encoding == "srgb":
        texels = np.where(texels > 0.04045, ((texels + 0.055) / 1.055) ** 2.4, texels / 12.92)
    if is_data == "number":
        texels = texels[..., [["red", "green", "blue", "alpha"].index(texture.get("channel", "red"))]]
    else:
        texels = texels[..., :3]
    texels = texels * np.array(texture.get("factor", 1), dtype=np.float32)
    wrap = texture.get("wrap", "repeat")
    return {"type": "bitmap", "bitmap": mi.Bitmap(texels.astype(np.float32)), "raw": True, "format": "variant",
            "filter_type": texture.get("filter", "bilinear"), "wrap_mode": wrap, "to_uv": uv_transform(texture)}


# --- Materials -------------------------------------------------------------------------------------------------------


def diffuse(material, smooth):
    # Mitsuba decides by the shading normal which side of a two-sided surface is lit, which is wrong at silhouettes.
    lambert = {"type": "diffuse", "reflectance": colour(material["reflectance"])}
    return lambert if smooth else {"type": "twosided", "bsdf": lambert}


def mirror(material, smooth):
    ideal = {"type": "conductor", "material": "none", "specular_reflectance": colour(material.get("reflectance", 1))}
    return {"type": "twosided", "bsdf": ideal}


def phong(material, smooth):
    colours = {"diffuse": rgb(material.get("diffuse", 0)), "specular": rgb(material["specular"])}
    return {"type": "candela_phong", **colours, "exponent": float(material["exponent"])}


def metal(material, smooth):
    alpha = material["alpha"]
    alpha = bitmap(alpha, "number") if isinstance(alpha, dict) else float(alpha)
    return {"type": "candela_metal", "reflectance": rgb(material["reflectance"]), "alpha": alpha}


def dielectric(material, smooth):
    if material["ior"] == material.get("exterior_ior", 1):
        return {"type": "null"}
    assert material.get("fresnel") == "exact", "Mitsuba knows no approximation of Fresnel's equations"
    return {"type": "dielectric", "int_ior": float(material["ior"]), "ext_ior": float(material.get("exterior_ior", 1))}


def interface(material, smooth):
    return {"type": "null"}


def detailed(bsdf, material):
    """With the material's normal map and opacity."""
    if "normal_map" in material:
        inner = bsdf["bsdf"] if bsdf["type"] == "twosided" else bsdf
        bsdf = {"type": "twosided", "bsdf": {"type": "normalmap", "normalmap": bitmap(material["normal_map"], "normal"),
                                             "bsdf": inner}}
    if "opacity" in material:
        bsdf = {"type": "mask", "opacity": bitmap({"channel": "alpha", **material["opacity"]}, "number"), "bsdf": bsdf}
    return bsdf


PRINCIPLED_NUMBERS = ["metalness", "roughness", "ior", "specular", "anisotropy", "anisotropy_rotation", "transmission",
                      "diffuse_transmission", "coat", "coat_roughness", "coat_ior"]
PRINCIPLED_COLOURS = ["base_color", "specular_color", "diffuse_transmission_color"]


def principled(material, smooth):
    keys = {"type", "thin_walled", "absorption", "priority", *PRINCIPLED_NUMBERS, *PRINCIPLED_COLOURS}
    assert not set(material) - keys, "principled_model.py does not know all keys"
    result = {"type": "candela_principled", "base_color": mi.ScalarColor3f(0.8)}
    result |= {key: float(material[key]) for key in PRINCIPLED_NUMBERS if key in material}
    result |= {key: mi.ScalarColor3f(rgb(material[key])) for key in PRINCIPLED_COLOURS if key in material}
    return {**result, "thin_walled": material.get("thin_walled", "absorption" not in material)}


def rough_conductor(material, smooth):
    rest = {key: value for key, value in material.items() if key not in ("type", "reflectance")}
    return principled({**rest, "base_color": material["reflectance"], "metalness": 1}, smooth)


def rough_dielectric(material, smooth):
    return principled({"thin_walled": False, **material, "base_color": 1, "transmission": 1}, smooth)


BSDFS = {"diffuse": diffuse, "mirror": mirror, "phong": phong, "conductor": metal, "dielectric": dielectric,
         "interface": interface,
         "principled": principled, "rough_conductor": rough_conductor, "rough_dielectric": rough_dielectric}
BLACK = {"type": "diffuse", "reflectance": 0.0}
BOUNDARIES = ("dielectric", "interface", "principled", "rough_dielectric")


def coefficients(material):
    """Absorption and scattering [1/m] of what is inside a material, or of the scene's medium."""
    absorption, scattering = material.get("absorption"), material.get("scattering", {})
    sigma_a, sigma_s = np.zeros(3), np.array(rgb(scattering.get("coefficient", 0)), dtype=float)
    if absorption:
        sigma_a = -np.log(rgb(absorption["transmittance"])) / absorption["distance"]
    if "albedo" in scattering:
        sigma_t, albedo = 1 / np.array(rgb(scattering["mean_free_path"])), np.array(rgb(scattering["albedo"]))
        sigma_a, sigma_s = (1 - albedo) * sigma_t, albedo * sigma_t
    return sigma_a, sigma_s


MEDIA = {}  # By their descriptions: one object for all that refer to a medium.


def medium(material):
    """The medium inside a material, or around everything; none if it neither absorbs nor scatters."""
    sigma_a, sigma_s = coefficients(material)
    sigma_t = sigma_a + sigma_s
    if not sigma_t.any():
        return None
    scale = float(max(sigma_t))  # Mitsuba treats it as a colour, in [0, 1].
    albedo = np.divide(sigma_s, sigma_t, out=np.zeros(3), where=sigma_t > 0)
    g = material.get("scattering", {}).get("g", 0)
    key = str((sigma_a, sigma_s, g))
    if key not in MEDIA:
        MEDIA[key] = mi.load_dict({"type": "homogeneous", "albedo": colour(albedo.tolist()), "scale": scale,
                                   "sigma_t": colour((sigma_t / scale).tolist()), "phase": {"type": "hg", "g": float(g)}})
    return MEDIA[key]


# --- Shapes ----------------------------------------------------------------------------------------------------------


def rotation(degrees, axis):
    return np.array(mi.ScalarTransform4f().rotate(axis, degrees).matrix)


def transform(shape):
    """The 4 x 4 matrix of all steps."""
    total = np.eye(4)
    for step in shape.get("transform", []):
        matrix = np.eye(4)
        if "scale" in step:
            matrix[:3, :3] = np.diag(rgb(step["scale"]))
        elif "rotate" in step:
            matrix = rotation(step["rotate"], step["axis"])
        elif "translate" in step:
            matrix[:3, 3] = step["translate"]
        else:
            matrix = np.reshape(step["matrix"], (4, 4))
        total = matrix @ total
    return total


def mesh_of(shape, folder, temporary):
    """A mesh of any kind but OBJ as a file that Mitsuba reads."""
    normals, uvs = None, None
    if shape["type"] == "quad":
        positions, triangles = shape["vertices"], [(0, 1, 2), (0, 2, 3)]
        uvs = [[0, 0], [1, 0], [1, 1], [0, 1]]
    elif shape["type"] == "box":
        positions, triangles = box(shape)
    elif shape["type"] == "ply":
        positions, triangles, normals = read_ply(folder / shape["file"])
    else:
        positions, triangles, normals = shape["positions"], shape["triangles"], shape.get("normals")
        uvs = shape.get("uvs")
    path = temporary / f"{len(list(temporary.iterdir()))}.ply"
    write_ply(path, np.array(positions), triangles, normals, None if uvs is None else np.array(uvs))
    return {"type": "ply", "filename": str(path), "face_normals": normals is None}


def geometry(shape, folder, temporary):
    """Mitsuba's shape, without its material."""
    to_world = transform(shape)
    if shape["type"] == "sphere":
        local = mi.ScalarTransform4f().translate(shape.get("center", [0, 0, 0])).scale(shape.get("radius", 1))
        result = {"type": "sphere"}
        # Mitsuba's tangent goes around its +Z, candela's around +Y.
        to_world = to_world @ np.array(local.matrix) @ rotation(-90, [1, 0, 0])
    elif shape["type"] == "disk":
        # Mitsuba's disk looks along its +Z.
        center, normal = np.array(shape.get("center", [0, 0, 0])), np.array(shape["normal"])
        up = [1, 0, 0] if abs(normal[0]) < 0.5 * np.linalg.norm(normal) else [0, 1, 0]
        local = mi.ScalarTransform4f().look_at(center.tolist(), (center + normal).tolist(), up)
        result = {"type": "disk"}
        to_world = to_world @ np.array(local.scale(shape.get("radius", 1)).matrix)
    elif shape["type"] == "obj":
        flat = shape.get("normals", "file") == "flat"
        result = {"type": "obj", "filename": str((folder / shape["file"]).resolve()), "face_normals": flat}
    else:
        result = mesh_of(shape, folder, temporary)
    return {**result, "to_world": mi.ScalarTransform4f(to_world)}


def sides(shape):
    """The one-sided lights that Mitsuba has instead: a two-sided one, and close behind it another that looks back."""
    one_sided = {key: value for key, value in shape.items() if key != "two_sided"}
    if not shape.get("two_sided"):
        return [one_sided]
    if shape["type"] == "disk":
        back = {"normal": [-x for x in shape["normal"]]}
        normal = np.array(shape["normal"])
    else:
        assert shape["type"] == "quad" and not isinstance(shape["emission"], dict), "no back is known of it"
        back = {"vertices": shape["vertices"][::-1]}
        corner, following, _, last = np.array(shape["vertices"])
        normal = np.cross(following - corner, last - corner)
    apart = {"translate": (-1e-4 * normal / np.linalg.norm(normal)).tolist()}
    return [one_sided, {**one_sided, **back, "transform": [apart, *shape.get("transform", [])]}]


def shape_of(shape, scene, folder, temporary):
    result = geometry(shape, folder, temporary)
    smooth = not result.get("face_normals", True)
    if "material" in shape:
        material = scene["materials"][shape["material"]]
        outer = around(shape, scene) if material["type"] in ("dielectric", "interface") else None
        if outer and "ior" in outer:
            material = {"exterior_ior": outer["ior"], **material}
        result["bsdf"] = detailed(BSDFS[material["type"]](material, smooth), material)
        # Without media, a shape does not change that of a path; light does not pass the opaque ones.
        if material["type"] in BOUNDARIES:
            media = {"interior": medium(material), "exterior": medium(outer or scene.get("medium", {}))}
            result |= {side: inside for side, inside in media.items() if inside}
    else:
        result["bsdf"] = BLACK
    if "emission" in shape:
        radiance = colour(shape["emission"])
        if radiance["type"] == "bitmap":
            radiance = {"type": "candela_light_texture", "texture": radiance}
        result["emitter"] = {"type": "area", "radiance": radiance}
    return result


# --- Lights without a surface ---------------------------------------------------------------------------------------


def light_of(light):
    if light["type"] == "directional":
        return {"type": "directional", "direction": light["direction"], "irradiance": colour(light["irradiance"])}
    intensity = colour(light["intensity"])
    position = np.array(light["position"], dtype=float)
    if light["type"] == "point":
        return {"type": "point", "position": position.tolist(), "intensity": intensity}
    target = light["look_at"] if "look_at" in light else (position + light["direction"]).tolist()
    axis = target - position
    up = [1, 0, 0] if abs(axis[0]) < 0.5 * np.linalg.norm(axis) else [0, 1, 0]
    inner, outer = float(light.get("inner_angle", 0)), float(light.get("outer_angle", 45))
    # All of the falloff is in the texture: the light's own begins where that ends.
    return {"type": "spot", "to_world": mi.ScalarTransform4f().look_at(position.tolist(), target, up),
            "intensity": intensity, "cutoff_angle": outer, "beam_width": outer * (1 - 1e-5),
            "texture": {"type": "candela_spot_cone", "inner": inner, "outer": outer}}


# --- Camera and environment ------------------------------------------------------------------------------------------


def sensor(camera):
    look_at = mi.ScalarTransform4f().look_at(camera["position"], camera["look_at"], camera.get("up", [0, 1, 0]))
    film = {"type": "hdrfilm", "width": SIZE, "height": SIZE, "rfilter": {"type": "box"}, "component_format": "float32"}
    if "orthographic_height" in camera:
        # Mitsuba's film reaches from -1 to 1.
        half = camera["orthographic_height"] / 2
        return {"type": "orthographic", "to_world": look_at @ mi.ScalarTransform4f().scale([half, half, 1]),
                "near_clip": 1e-3, "film": {**film, "pixel_format": "rgb"}, "sampler": {"type": "independent"}}
    if "vertical_fov" in camera:
        fov = camera["vertical_fov"]
    else:
        fov = np.degrees(2 * np.arctan(camera["film_size"][1] / (2 * camera["focal_length"])))
    result = {"type": "perspective", "to_world": look_at, "fov": float(fov), "fov_axis": "y", "near_clip": 1e-3}
    lens = camera.get("lens", {"radius": 0})
    if lens["radius"] > 0:
        assert "blades" not in lens, "Mitsuba's aperture is a disk"
        result |= {"type": "thinlens", "aperture_radius": lens["radius"], "focus_distance": lens["focal_distance"]}
    return {**result, "film": {**film, "pixel_format": "rgb"}, "sampler": {"type": "independent"}}


def baked(texels, factor=4):
    """Mitsuba interpolates between points of which the first and last row are the poles; candela's map is constant over
    each texel. So this samples the constant texels at the points of a grid `factor` times finer; its columns begin at
    -Z, which is in the middle of candela's map. Points between two rows of texels get the mean of both."""
    height, width, _ = texels.shape
    columns = np.roll(np.repeat(texels, factor, axis=1), width * factor // 2, axis=1)
    at = np.arange(factor * height + 1) / factor
    above = np.clip(np.ceil(at).astype(int) - 1, 0, height - 1)
    below = np.clip(np.floor(at).astype(int), 0, height - 1)
    return (columns[above] + columns[below]) / 2


def environment_of(environment, folder):
    assert environment.get("visible", True), "Mitsuba would hide all lights"
    scale = environment.get("intensity", 1)
    if "radiance" in environment:
        return {"type": "constant", "radiance": colour([scale * c for c in rgb(environment["radiance"])])}
    texels = np.array(mi.Bitmap(str(folder / environment["file"])), dtype=np.float32)[..., :3]
    bitmap = mi.Bitmap(baked(texels).astype(np.float32))
    turn = mi.ScalarTransform4f(rotation(environment.get("rotation", 0), [0, 1, 0]))
    return {"type": "envmap", "bitmap": bitmap, "scale": float(scale), "to_world": turn}


# --- Pictures --------------------------------------------------------------------------------------------------------


def integrator(name, scene):
    media = [*scene["materials"].values(), scene.get("medium", {})]
    if any("absorption" in material or "scattering" in material for material in media):
        # Of the two integrators with media, `volpath` has fireflies, and the roulette of `volpathmis` loses 0.2 % of
        # the light: so this is the latter without roulette, and with more vertices than light survives.
        depth = MOST_VERTICES.get(name, 64)
        return {"type": "volpathmis", "max_depth": depth, "rr_depth": depth}
    depth = scene.get("integrator", {}).get("max_depth", "unlimited")
    # Mitsuba counts the light as a vertex, too.
    return {"type": "path", "max_depth": -1 if depth == "unlimited" else depth + 1}


def load(name, temporary):
    scene, folder = read_scene(name)
    FOLDER[0] = folder
    camera = next(iter(scene["cameras"].values()))
    result = {"type": "scene", "integrator": integrator(name, scene), "sensor": sensor(camera)}
    if around_all := medium(scene.get("medium", {})):
        result["sensor"]["medium"] = around_all
    if "environment" in scene:
        result["environment"] = environment_of(scene["environment"], folder)
    for i, shape in enumerate(side for shape in scene["shapes"] for side in sides(shape)):
        result[f"shape{i}"] = shape_of(shape, scene, folder, temporary)
    for i, light in enumerate(scene.get("lights", [])):
        result[f"light{i}"] = light_of(light)
    return mi.load_dict(result)


def render(name):
    """Mean and variance of the mean, SIZE x SIZE x 3 each."""
    with tempfile.TemporaryDirectory() as temporary:
        scene = load(name, Path(temporary))
        images = [np.array(mi.render(scene, spp=SPP[name], seed=seed), dtype=float) for seed in range(SEEDS)]
    return np.mean(images, axis=0), np.var(images, axis=0, ddof=1) / SEEDS


def write(name, mean, variance):
    channels = ["R", "G", "B", "Variance.R", "Variance.G", "Variance.B"]
    values = np.concatenate([mean, variance], axis=2).astype(np.float32)
    picture = mi.Bitmap(values, pixel_format=mi.Bitmap.PixelFormat.MultiChannel, channel_names=channels)
    picture.metadata()["renderer"] = f"Mitsuba {mi.__version__}, make_references.py"
    picture.metadata()["samples"] = f"{SEEDS} seeds x {SPP[name]} per pixel"
    picture.write(str(HERE / f"{name}.exr"))


def main(names):
    unknown = set(names) - set(SPP)
    if unknown:
        sys.exit(f"unknown scene {', '.join(sorted(unknown))} (known: {', '.join(SPP)})")
    reflection_models.check_albedos()
    principled_model.check_energy()
    for name in names or SPP:
        mean, variance = render(name)
        write(name, mean, variance)
        noise = np.median(np.sqrt(variance) / np.maximum(mean, 1e-9))
        print(f"{name}: mean {mean.mean():.4f}, median noise of a pixel {100 * noise:.2f} %", flush=True)


if __name__ == "__main__":
    main(sys.argv[1:])
