"""A model with a transform on every texture that a material may have."""

from models_normals import bump_map
from models_textures import transform_info, transformed
from stage import model, picture

TURNED = {"offset": (0.3, 0.45), "rotation": 0.5, "scale": (0.6, 0.8)}
MOVED = {"offset": (0.25, 0.6), "scale": (1.5, 0.5)}  # Where tangents count: baked, a turn would turn them, too.


def patches(column, row):
    """Blocks whose red, green, blue and alpha are large at different places."""
    return tuple(255 if (column * weight + row * 3) % 8 < 4 else 40 for weight in (1, 2, 5, 3))


DULL, BLACK, WHITE = (0.15, 0.15, 0.15), (0.03, 0.03, 0.03), [1, 1, 1]
METAL = {"colour": DULL, "metallic": 1, "roughness": 0.5}
GLOSSY = {"colour": BLACK, "roughness": 0.4}
IOR_2 = {"ior": {"ior": 2}}
# Label, image, texture (of an extension after its name), the material, and what its extension has besides.
SLOTS = [
    ("base colour", "patches", "baseColorTexture", {"colour": (1, 1, 1)}, None),
    ("rough metal", "patches", "metallicRoughnessTexture", {"colour": (0.9, 0.7, 0.4), "metallic": 1}, None),
    ("normal", "bump", "normalTexture", {}, None),
    ("emission", "patches", "emissiveTexture", {"colour": BLACK, "emissiveFactor": [0.5, 0.5, 0.5]}, None),
    ("coat", "patches", "clearcoat clearcoatTexture", {"colour": BLACK},
     {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.4}),
    ("coat rough", "patches", "clearcoat clearcoatRoughnessTexture", {"colour": BLACK},
     {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.6}),
    ("coat normal", "bump", "clearcoat clearcoatNormalTexture", {"colour": BLACK},
     {"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.5}),
    ("sheen", "patches", "sheen sheenColorTexture", {"colour": BLACK},
     {"sheenColorFactor": WHITE, "sheenRoughnessFactor": 0.6}),
    ("sheen rough", "patches", "sheen sheenRoughnessTexture", {"colour": BLACK},
     {"sheenColorFactor": WHITE, "sheenRoughnessFactor": 1}),
    ("specular", "patches", "specular specularTexture", {**GLOSSY, "extensions": IOR_2}, {}),
    ("spec colour", "patches", "specular specularColorTexture", {**GLOSSY, "extensions": IOR_2}, {}),
    ("film", "patches", "iridescence iridescenceTexture", METAL, {"iridescenceFactor": 1, "iridescenceIor": 1.8}),
    ("thickness", "patches", "iridescence iridescenceThicknessTexture", METAL,
     {"iridescenceFactor": 1, "iridescenceIor": 1.8}),
    ("anisotropy", "patches", "anisotropy anisotropyTexture", METAL, {"anisotropyStrength": 0.8}),
    ("transmission", "patches", "transmission transmissionTexture",
     {"colour": (1, 0.6, 0.3), "extensions": {"ior": {"ior": 1}}}, {"transmissionFactor": 1}),
    ("through", "patches", "diffuse_transmission diffuseTransmissionTexture", {"colour": (0.9, 0.9, 0.9)},
     {"diffuseTransmissionFactor": 0.9}),
    ("col through", "patches", "diffuse_transmission diffuseTransmissionColorTexture", {"colour": DULL},
     {"diffuseTransmissionFactor": 1}),
]


def with_texture(stage, where, properties, factors, info):
    """The material of a slot with this textureInfo."""
    if factors is not None:
        extension, name = where.split()
        extensions = {**properties.get("extensions", {}), extension: {**factors, name: info}}
        return stage.surface(**{**properties, "extensions": extensions})
    if where in ("baseColorTexture", "metallicRoughnessTexture"):
        return stage.surface(**properties, base={where: info})
    return stage.surface(**properties, **{where: info})


@model("TextureTransformMultiTest")
def texture_transform_multi_test(stage):
    """Every texture of a material may have a transform of its own. In each pair, the left tile has one on the texture
    that its label names, the right one has coordinates that were transformed beforehand."""
    textures = {"patches": stage.file.texture(picture(8, 8, patches, 4)), "bump": bump_map(stage)}
    stage.sun((-0.15, 0.25, 0.95), 1.5)
    stage.sun((0.9, 0.2, 0.35), 5)  # For sheen.
    stage.sun((0.3, 0.9, -0.3), 4)  # From behind, for what passes.
    stage.backdrop_z = -50.0  # Out of the sun's way.
    for left, right, name, *slot in stage.pairs(SLOTS):
        values = MOVED if name == "bump" or "anisotropy" in slot[0] else TURNED
        stage.tile(left, with_texture(stage, *slot, transform_info(stage, textures[name], **values)))
        stage.tile(right, with_texture(stage, *slot, {"index": textures[name]}),
                   uv=lambda s, t: transformed(s, t, **values))
        stage.canvas.fill((left[0], left[1], right[2], right[3]), (150, 150, 150))
    stage.tolerate(8, 256)
