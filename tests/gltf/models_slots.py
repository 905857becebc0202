"""A model with a transform on every texture that a material may have."""

from models_normals import bump_map
from models_textures import transform_info, transformed
from stage import model, picture

TURNED = {"offset": (0.3, 0.45), "rotation": 0.5, "scale": (0.6, 0.8)}
MOVED = {"offset": (0.25, 0.6), "scale": (1.5, 0.5)}  # Of normal maps: a turn would turn the tangents, or not.


def patches(column, row):
    """Blocks whose red, green, blue and alpha are large at different places."""
    return tuple(255 if (column * weight + row * 3) % 8 < 4 else 40 for weight in (1, 2, 5, 3))


# Label, which texture, what is made of a textureInfo.
SLOTS = [
    ("base colour", "patches", lambda info: {"colour": (1, 1, 1), "base": {"baseColorTexture": info}}),
    ("rough metal", "patches", lambda info: {"colour": (0.9, 0.7, 0.4), "metallic": 1, "roughness": 0.7,
                                             "base": {"metallicRoughnessTexture": info}}),
    ("normal", "bump", lambda info: {"normalTexture": info}),
    ("emission", "patches", lambda info: {"emissiveFactor": [0.5, 0.5, 0.5], "emissiveTexture": info}),
    ("coat", "patches", lambda info: {"roughness": 1, "extensions": {"clearcoat": {
        "clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.4, "clearcoatTexture": info}}}),
    ("coat rough", "patches", lambda info: {"roughness": 1, "extensions": {"clearcoat": {
        "clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.6, "clearcoatRoughnessTexture": info}}}),
    ("coat normal", "bump", lambda info: {"colour": (0.05, 0.05, 0.05), "roughness": 1, "extensions": {"clearcoat": {
        "clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.5, "clearcoatNormalTexture": info}}}),
    ("sheen", "patches", lambda info: {"colour": (0.05, 0.05, 0.05), "extensions": {"sheen": {
        "sheenColorFactor": [1, 1, 1], "sheenRoughnessFactor": 0.6, "sheenColorTexture": info}}}),
    ("sheen rough", "patches", lambda info: {"colour": (0.05, 0.05, 0.05), "extensions": {"sheen": {
        "sheenColorFactor": [1, 1, 1], "sheenRoughnessFactor": 1, "sheenRoughnessTexture": info}}}),
    ("specular", "patches", lambda info: {"colour": (0.02, 0.02, 0.02), "roughness": 0.4, "extensions": {
        "ior": {"ior": 2}, "specular": {"specularTexture": info}}}),
    ("spec colour", "patches", lambda info: {"colour": (0.02, 0.02, 0.02), "roughness": 0.4, "extensions": {
        "ior": {"ior": 2}, "specular": {"specularColorTexture": info}}}),
    ("film", "patches", lambda info: {"metallic": 1, "roughness": 0.4, "extensions": {"iridescence": {
        "iridescenceFactor": 1, "iridescenceIor": 1.8, "iridescenceTexture": info}}}),
    ("thickness", "patches", lambda info: {"metallic": 1, "roughness": 0.4, "extensions": {"iridescence": {
        "iridescenceFactor": 1, "iridescenceIor": 1.8, "iridescenceThicknessTexture": info}}}),
    ("anisotropy", "patches", lambda info: {"metallic": 1, "roughness": 0.4, "extensions": {"anisotropy": {
        "anisotropyStrength": 0.8, "anisotropyTexture": info}}}),
    ("transmission", "patches", lambda info: {"colour": (1, 0.6, 0.3), "extensions": {
        "ior": {"ior": 1}, "transmission": {"transmissionFactor": 1, "transmissionTexture": info}}}),
    ("through", "patches", lambda info: {"colour": (0.9, 0.9, 0.9), "extensions": {"diffuse_transmission": {
        "diffuseTransmissionFactor": 0.9, "diffuseTransmissionTexture": info}}}),
    ("col through", "patches", lambda info: {"colour": (0.1, 0.1, 0.1), "extensions": {"diffuse_transmission": {
        "diffuseTransmissionFactor": 1, "diffuseTransmissionColorTexture": info}}}),
]


@model("TextureTransformMultiTest")
def texture_transform_multi_test(stage):
    """Every texture of a material may have a transform of its own. In each pair, the left tile has one on the texture
    that its label names, the right one has coordinates that were transformed beforehand."""
    textures = {"patches": stage.file.texture(picture(8, 8, patches, 4)), "bump": bump_map(stage)}
    stage.sun((-0.15, 0.25, 0.95), 2)
    stage.sun((0.3, 0.9, -0.3), 4)  # From behind, for what passes.
    for left, right, name, material in stage.pairs(SLOTS):
        values = MOVED if name == "bump" else TURNED
        stage.tile(left, stage.surface(**material(transform_info(stage, textures[name], **values))))
        stage.tile(right, stage.surface(**material({"index": textures[name]})),
                   uv=lambda s, t: transformed(s, t, **values))
        if name != "bump":
            stage.canvas.fill((left[0], left[1], right[2], right[3]), (150, 150, 150))
    stage.tolerate(8, 256)
