"""Models about images on surfaces: where they are looked up; alpha; colours of vertices."""

import math

import ktx
from gltf_file import CLAMP, LINEAR, MIRROR, NEAREST, REPEAT
from stage import DARK, chart, chart_colour, decoded, encoded, linear, model, picture, solid

GREEN, ORANGE, SKY = (60, 200, 80), (240, 150, 40), (70, 120, 190)
ALPHAS = (16, 48, 80, 112, 144, 176, 208, 240)


def transformed(s, t, offset=(0, 0), rotation=0, scale=(1, 1)):
    """What KHR_texture_transform makes of coordinates: scale, then a turn counter-clockwise as one sees it, offset."""
    c, n = math.cos(rotation), math.sin(rotation)
    u, v = scale[0] * s, scale[1] * t
    return c * u + n * v + offset[0], -n * u + c * v + offset[1]


def transform_info(stage, texture, **values):
    """A textureInfo with a transform that a reader must understand."""
    stage.file.required.add("KHR_texture_transform")
    item = {name: list(value) if isinstance(value, tuple) else value for name, value in values.items()}
    return {"index": texture, "extensions": {"KHR_texture_transform": item}}


@model("TextureTransformTest")
def texture_transform_test(stage):
    """In each pair, the left tile has KHR_texture_transform and the right one has coordinates that were transformed
    beforehand: both show the same part of the image. The transforms are offsets along u and v, turns
    counter-clockwise, scales, all at once, a mirror, and another set of coordinates."""
    texture = stage.file.texture(chart())
    cases = [
        ("offset u", {"offset": (0.25, 0)}),
        ("offset v", {"offset": (0, 0.25)}),
        ("rotation", {"rotation": math.pi / 2}),
        ("half turn", {"rotation": math.pi, "offset": (1, 1)}),
        ("oblique", {"rotation": 0.4, "offset": (0.1, 0.3)}),
        ("scale", {"scale": (2, 0.5)}),
        ("quadrant", {"rotation": math.pi / 2, "scale": (0.5, 0.5), "offset": (0, 1)}),
        ("all", {"rotation": 0.6, "scale": (1.5, 0.75), "offset": (-0.2, 0.4)}),
        ("mirror", {"scale": (1, -1), "offset": (0, 1)}),
        ("set", {"texCoord": 1, "scale": (2, 2)}),
    ]
    for left, right, values in stage.pairs(cases):
        mesh = stage.sheet(left)
        if "texCoord" in values:
            mesh.others["TEXCOORD_1"] = mesh.uvs
            mesh.uvs = [(0.0, 0.0)] * 4
        stage.put(mesh, stage.unlit(texture=transform_info(stage, texture, **values)))
        baked = {name: value for name, value in values.items() if name != "texCoord"}
        stage.tile(right, stage.unlit(texture=texture), uv=lambda s, t: transformed(s, t, **baked))
        plain = stage.sheet(right)
        assert any(abs(a - b) > 0.1 for p, q in zip(plain.uvs, stage.sheet(
            right, uv=lambda s, t: transformed(s, t, **baked)).uvs) for a, b in zip(p, q)), "a transform does something"
    stage.tolerate(3, 64)  # Turned texels have oblique edges.


@model("TextureSettingsTest", ("glTF-Binary", "glTF", "glTF-Embedded"))
def texture_settings_test(stage):
    """Wrap modes: in each pair, the left tile reaches beyond the image and the right one shows one large image of what
    one must see there. Filters: the left tile is made by the sampler, the right one by vertices' colours or by
    hand. Sides: a tick shows and no cross, since surfaces are there from behind only if they are double-sided."""
    four = [[(230, 60, 50), (60, 200, 80)], [(50, 90, 220), (240, 220, 80)]]
    small = picture(2, 2, lambda x, y: four[y][x])
    index = {REPEAT: lambda i: i % 2, MIRROR: lambda i: (i % 4) if i % 4 < 2 else 3 - i % 4,
             CLAMP: lambda i: min(max(i, 0), 1)}
    names = {REPEAT: "repeat", MIRROR: "mirror", CLAMP: "clamp"}
    cases = [(f"{names[s]} {names[t]}", "wrap", (s, t)) for s in index for t in index]
    cases += [("nearest", "nearest", None), ("linear", "linear", None), ("sides", "sides", None)]
    for left, right, kind, wrap in stage.pairs(cases, equal=False):
        if kind == "wrap":  # From -1 to 3 along both: four images beside each other, eight texels.
            stage.tile(left, stage.unlit(texture=stage.file.texture(small, NEAREST, wrap)),
                       uv=lambda s, t: (4 * s - 1, 4 * t - 1))
            large = picture(8, 8, lambda x, y: four[index[wrap[1]](y - 2)][index[wrap[0]](x - 2)])
            stage.tile(right, stage.unlit(texture=stage.file.texture(large)))
            stage.equal(left, right)
        elif kind == "nearest":
            step = picture(2, 1, lambda x, y: (255, 255, 255) if x else (0, 0, 0))
            stage.tile(left, stage.unlit(texture=stage.file.texture(step, NEAREST, (CLAMP, CLAMP))))
            stage.canvas.fill(right, (0, 0, 0))
            stage.canvas.fill(((right[0] + right[2]) / 2, *right[1:]), (255, 255, 255))
            stage.equal(left, right)
        elif kind == "linear":  # Between the texels' centres, where light and not its code must grow evenly.
            dark = decoded(90)
            step = picture(2, 1, lambda x, y: (255, 255, 255) if x else (90, 90, 90))
            stage.tile(left, stage.unlit(texture=stage.file.texture(step, LINEAR, (CLAMP, CLAMP))),
                       uv=lambda s, t: (0.25 + s / 2, t))
            stage.tile(right, stage.unlit(), colour=lambda s, t: (dark + (1 - dark) * s,) * 3)
            ramp = left, right
        else:
            cross = stage.unlit((0.8, 0.02, 0.02))
            both = stage.unlit(linear(GREEN), doubleSided=True)
            for rect, material, below in ((left, cross, True), (right, both, False)):
                stage.canvas.mark(rect, below)
                mesh = stage.sheet(rect, -0.5)
                mesh.indices = mesh.indices[::-1]
                mesh.normals = [(0, 0, -1)] * 4
                stage.put(mesh, material)
            stage.expect([left[0] + 20, left[1] + 34, left[0] + 36, left[1] + 39], DARK, 0)  # Not the red sheet.
            stage.expect(right, GREEN)
    stage.check(tolerance=6, spp=256)  # Of four texels, one may be taken at random.
    stage.equal(*ramp)
    stage.shown(ramp[0])


@model("MultiUVTest")
def multi_uv_test(stage):
    """A material may look up one image by the first set of coordinates and another one by the second. In each pair,
    the left tile does so in one way, and the right one, with its sets exchanged, in the other."""
    # The glow has no symmetry either.
    colour, glow = stage.file.texture(chart()), stage.file.texture(
        picture(4, 4, lambda x, y: (200, 140, 60) if (x + y) % 2 and x > y else (0, 0, 0)))
    quarter, turned = (lambda s, t: (s / 2, t / 2)), (lambda s, t: (1 - t, s))
    stage.sun()
    cases = [("colour 0 glow 1", 0, 1, quarter, turned), ("colour 1 glow 0", 1, 0, quarter, turned),
             ("both 1", 1, 1, turned, turned), ("both 0", 0, 0, quarter, quarter)]
    for left, right, first, second, base_uv, glow_uv in stage.pairs(cases):
        for rect, a, b in ((left, first, second), (right, 1 - first, 1 - second)):
            mesh = stage.sheet(rect)
            wanted = {a: stage.sheet(rect, uv=base_uv).uvs, b: stage.sheet(rect, uv=glow_uv).uvs}
            other = [(0.05, 0.05)] * 4
            mesh.uvs = wanted.get(0, other)
            mesh.others["TEXCOORD_1"] = wanted.get(1, other)
            stage.put(mesh, stage.surface((1, 1, 1), base={"baseColorTexture": {"index": colour, "texCoord": a}},
                                          emissiveFactor=[1, 1, 1], emissiveTexture={"index": glow, "texCoord": b}))
    stage.tolerate(4, 64)


@model("VertexColorTest")
def vertex_color_test(stage):
    """Colours of vertices are linear and multiply the material's: in each pair, the left tile has them, as floats,
    bytes or shorts, alone, with a factor, with an image, with alpha; the right one has the product as its factor, or a
    picture of it."""
    texture = stage.file.texture(chart())
    colour = (0.2, 0.8, 0.4)

    def constant(component, largest, alpha=None):
        values = [*colour] + ([] if alpha is None else [alpha])
        return [tuple(round(largest * c) if largest > 1 else c for c in values)] * 4, component, largest > 1

    cases = [
        ("float", constant("f32", 1), {}, {}),
        ("byte", constant("u8", 255), {}, {}),
        ("short", constant("u16", 65535), {}, {}),
        ("float 4", constant("f32", 1, 1), {}, {}),
        ("byte 4", constant("u8", 255, 1), {}, {}),
        ("short 4", constant("u16", 65535, 1), {}, {}),
        ("factor", constant("u8", 255), {"colour": (0.5, 0.5, 1)}, {}),
        ("image", constant("f32", 1), {"texture": texture}, {"texture": texture}),
        ("mask", constant("f32", 1, 0.3), {"alphaMode": "MASK"}, None),
        ("mask 4", constant("u8", 255, 0.8), {"alphaMode": "MASK", "alpha": 0.75}, {}),
        ("gradient", None, {}, {}),
        ("lit", constant("u16", 65535), "lit", "lit"),
    ]
    stage.sun()
    for left, right, colours, properties, reference in stage.pairs(cases):
        mesh = stage.sheet(left)
        factor = (1, 1, 1) if properties == "lit" else properties.get("colour", (1, 1, 1))
        product = [a * b for a, b in zip(colour, factor)]
        if colours is None:  # Even growth of light; compared with a picture of 40 columns.
            mesh.colours = [(0, 1, 0), (1, 0, 0), (0, 1, 0), (1, 0, 0)]
            stage.put(mesh, stage.unlit())
            width = right[2] - right[0]
            for x in range(width):
                s = (x + 0.5) / width
                stage.canvas.fill((right[0] + x, right[1], right[0] + x + 1, right[3]), (encoded(s), encoded(1 - s), 0))
            continue
        mesh.others["COLOR_0"] = colours
        if properties == "lit":
            stage.put(mesh, stage.surface((1, 1, 1)))
            stage.tile(right, stage.surface(product))
            continue
        stage.put(mesh, stage.unlit(**properties))
        if reference is not None:
            stage.tile(right, stage.unlit(product, **reference))
        else:  # The mask leaves nothing.
            stage.canvas.fill((left[0], left[1], right[2], right[3]), SKY)


@model("AlphaBlendModeTest")
def alpha_blend_mode_test(stage):
    """Opaque surfaces ignore alpha; masks are there where alpha is at least the cutoff (0.5 unless said otherwise), as
    a whole where the factor is the cutoff, and nowhere above 1; blended surfaces let 1 - alpha of the light pass. In
    each pair, the right tile is painted on the backdrop as the left one must look, over the same sky."""
    ramp = stage.file.texture(picture(8, 1, lambda x, y: (*ORANGE, ALPHAS[x]), 4))
    cases = [
        ("opaque", {"texture": ramp}, lambda a: 1),
        ("opaque factor", {"texture": ramp, "alpha": 0.25}, lambda a: 1),
        ("mask", {"texture": ramp, "alphaMode": "MASK"}, lambda a: a >= 0.5),
        ("cutoff 0.25", {"texture": ramp, "alphaMode": "MASK", "alphaCutoff": 0.25}, lambda a: a >= 0.25),
        ("cutoff 0.75", {"texture": ramp, "alphaMode": "MASK", "alphaCutoff": 0.75}, lambda a: a >= 0.75),
        ("mask factor", {"texture": ramp, "alphaMode": "MASK", "alpha": 0.6}, lambda a: 0.6 * a >= 0.5),
        ("cutoff is alpha", {"alphaMode": "MASK", "alpha": 0.5}, lambda a: 1),
        ("cutoff 1.01", {"alphaMode": "MASK", "alphaCutoff": 1.01}, lambda a: 0),
        ("cutoff 0", {"alphaMode": "MASK", "alpha": 0, "alphaCutoff": 0}, lambda a: 1),
        ("blend", {"texture": ramp, "alphaMode": "BLEND"}, lambda a: a),
        ("blend factor", {"texture": ramp, "alphaMode": "BLEND", "alpha": 0.5}, lambda a: 0.5 * a),
        ("blend 0.5", {"alphaMode": "BLEND", "alpha": 0.5}, lambda a: 0.5),
    ]
    for left, right, properties, coverage in stage.pairs(cases):
        if "texture" in properties:
            material = stage.unlit(**properties)
        else:
            material = stage.unlit(linear(ORANGE), **properties)
        stage.tile(left, material)
        stage.canvas.fill(left, SKY)
        for column, alpha in enumerate(ALPHAS):
            c = float(coverage(alpha / 255))
            mixed = [encoded(c * decoded(a) + (1 - c) * decoded(b)) for a, b in zip(ORANGE, SKY)]
            step = (right[2] - right[0]) // 8
            stage.canvas.fill((right[0] + step * column, right[1], right[0] + step * (column + 1), right[3]), mixed)
    stage.tolerate(8, 256)  # Whether a ray passes is decided at random.


@model("TextureEncodingTest")
def texture_encoding_test(stage):
    """Images of colours are encoded as sRGB says, and those of numbers are linear: in each pair, the left tile has a
    value from an image, the right one from a factor. Codes of 128 are 0.216 as colour and 0.502 as number."""
    grey = stage.file.texture(solid(128, 128, 128))
    number, colour = 128 / 255, decoded(128)
    black = {"base": {}, "colour": (0.02, 0.02, 0.02)}
    stage.sun((0.1, 0.3, 1), 1)
    cases = [
        ("base colour", {"colour": (1, 1, 1), "base": {"baseColorTexture": {"index": grey}}}, {"colour": [colour] * 3}),
        ("emission", {**black, "emissiveFactor": [1, 1, 1], "emissiveTexture": {"index": grey}},
         {**black, "emissiveFactor": [colour] * 3}),
        ("roughness", {"metallic": 0, "base": {"metallicRoughnessTexture": {"index": grey}}}, {"roughness": number}),
        ("metalness", {"metallic": 1, "base": {"metallicRoughnessTexture": {"index": grey}}},
         {"metallic": number, "roughness": number}),
        ("specular colour", {"roughness": 0.4, "extensions": {"specular": {"specularColorTexture": {"index": grey}}}},
         {"roughness": 0.4, "extensions": {"specular": {"specularColorFactor": [colour] * 3}}}),
        ("sheen colour", {"extensions": {"sheen": {"sheenColorFactor": [1, 1, 1], "sheenRoughnessFactor": 0.5,
                                                   "sheenColorTexture": {"index": grey}}}},
         {"extensions": {"sheen": {"sheenColorFactor": [colour] * 3, "sheenRoughnessFactor": 0.5}}}),
    ]
    for left, right, with_image, with_factor in stage.pairs(cases):
        stage.tile(left, stage.surface(**with_image))
        stage.tile(right, stage.surface(**with_factor))
    stage.tolerate(3, 64)


@model("TextureBasisuTest")
def texture_basisu_test(stage):
    """In each pair, the image of the left tile is a KTX 2 file of Basis Universal, and that of the right one is a PNG file
    with the same pixels: plain, under Zstandard, cut within blocks, with alpha, of numbers and not colours."""
    def faded(column, row):
        return (*chart_colour(column, row), ALPHAS[column])

    def rough(column, row):
        return (0, 255 - 30 * row, 10 * column)

    def unlit(**properties):
        return lambda texture: stage.unlit(texture=texture, **properties)

    def metal(texture):
        return stage.surface((1, 1, 1), metallic=1, base={"metallicRoughnessTexture": {"index": texture}})

    mask, linear = {"alphaMode": "MASK"}, {"transfer": ktx.LINEAR_TRANSFER}
    cases = [
        ("plain", (32, 32), 3, chart_colour, {}, unlit()),
        ("zstandard", (32, 32), 3, chart_colour, {"scheme": ktx.ZSTANDARD}, unlit()),
        ("cut", (30, 25), 3, chart_colour, {}, unlit()),
        ("alpha", (32, 32), 4, faded, {}, unlit(**mask)),
        ("alpha unread", (32, 32), 4, faded, {"scheme": ktx.ZSTANDARD}, unlit()),
        ("numbers", (32, 32), 3, rough, linear, metal),
        ("numbers srgb", (32, 32), 3, rough, {}, metal),  # The slot decides, as for PNG files.
    ]
    stage.sun()
    for left, right, size, channels, function, options, material in stage.pairs(cases):
        stage.tile(left, material(stage.file.texture(ktx.write(*size, function, channels, **options))))
        pixels = picture(*size, lambda x, y, f=function: f(x // 4, y // 4), channels)
        stage.tile(right, material(stage.file.texture(pixels)))
    stage.tolerate(2, 16)


@model("UnlitTest")
def unlit_test(stage):
    """Unlit surfaces show their colour in any light, here that of a blue sun: the painted squares on the right have the
    same colours. Only the last pair is lit, and blue."""
    texture = stage.file.texture(chart())
    stage.sun(colour=(0.05, 0.1, 1))
    cases = [("factor", {"colour": linear(ORANGE)}), ("image", {"texture": texture}),
             ("product", {"texture": texture, "colour": (0.25, 0.5, 1)}), ("vertices", {})]
    for left, right, properties in stage.pairs(cases):
        if properties:
            stage.tile(left, stage.unlit(**properties))
        else:
            stage.tile(left, stage.unlit((1, 0.5, 1)), colour=lambda s, t: (0.5, 0.5, 0.25))
        side = (right[2] - right[0]) // 8
        for row in range(8):
            for column in range(8):
                if "texture" in properties:
                    shown = [encoded(decoded(c) * f) for c, f in zip(chart_colour(column, row),
                                                                     properties.get("colour", (1, 1, 1)))]
                else:
                    shown = ORANGE if properties else [encoded(c) for c in (0.5, 0.25, 0.25)]
                x, y = right[0] + column * side, right[1] + row * side
                stage.canvas.fill((x, y, x + side, y + side), shown)
    lit = [40, 212, 140, 236]
    stage.tile(lit, stage.surface((1, 1, 1)))
    stage.tile([180, 212, 280, 236], stage.surface((1, 1, 1)))
    stage.equal(lit, [180, 212, 280, 236])
    stage.differ(lit, [40, 20, 140, 44])
