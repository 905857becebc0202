"""Models about directions on surfaces: normal maps, tangents, anisotropy."""

import math

import matrices
from gltf_file import LINEAR
from shapes import bump
from stage import model, picture, solid

MAP = 64  # Pixels along each side of normal maps.


def normal_code(n):
    return tuple(round(127.5 + 127.5 * c) for c in n)


def bump_map(stage, change=lambda n: n):
    """A texture of the bump's normals, which function `change` may turn."""
    return stage.file.texture(picture(MAP, MAP, lambda x, y: normal_code(
        change(bump((x + 0.5) / MAP, (y + 0.5) / MAP)))), LINEAR)


def turned_uv(quarter, mirrored):
    """Coordinates turned by quarters, then mirrored: functions of (s, t), and the tangent that they have."""
    def uv(s, t):
        x, y = s - 0.5, t - 0.5
        for _ in range(quarter):
            x, y = -y, x
        return (0.5 - x if mirrored else 0.5 + x), 0.5 + y

    u00, u10 = uv(0.5, 0.5), uv(1, 0.5)
    u01 = uv(0.5, 0)
    x, y = u10[0] - u00[0], u01[0] - u00[0]  # How u grows to the right, and upwards.
    tangent = matrices.unit([x, y, 0])
    return uv, (*tangent, -1.0 if mirrored else 1.0)


LIGHT = (-0.55, 0.6, 0.58)
CLAY = (0.8, 0.6, 0.45)


def lit_from_upper_left(stage, rect):
    """The bump's side towards the light is bright, the other one dark."""
    third = (rect[2] - rect[0]) // 3
    stage.differ([rect[0], rect[1], rect[0] + third, rect[1] + third],
                 [rect[2] - third, rect[3] - third, rect[2], rect[3]])


@model("NormalTangentTest")
def normal_tangent_test(stage):
    """Without tangents, those of MikkTSpace are taken. The left tile of each pair has a normal map under coordinates
    that are turned, and mirrored; the right one has the same normals at its vertices. All bumps bulge, and are
    bright towards the light, up on the left."""
    texture = bump_map(stage)
    stage.sun(LIGHT)
    plain, mapped = stage.surface(CLAY), stage.surface(CLAY, normalTexture={"index": texture})
    cases = [(f"{'mirror ' if mirrored else ''}{90 * quarter}", quarter, mirrored)
             for mirrored in (False, True) for quarter in range(4)]
    cases += [("scale 0.5", None, 0.5)]
    for left, right, quarter, mirrored in stage.pairs(cases):
        if quarter is None:
            flatter = stage.surface(CLAY, normalTexture={"index": texture, "scale": mirrored})
            stage.tile(left, flatter)
            stage.tile(right, plain, n=32, normal=lambda s, t: matrices.unit(
                [c * k for c, k in zip(bump(s, t), (mirrored, mirrored, 1))]))
        else:
            stage.tile(left, mapped, uv=turned_uv(quarter, mirrored)[0])
            stage.tile(right, plain, n=32, normal=bump)
        lit_from_upper_left(stage, left)
    stage.flat_terminator()
    stage.tolerate(5, 64)


@model("NormalTangentMirrorTest")
def normal_tangent_mirror_test(stage):
    """Tangents that a file gives are taken as they are. In the first pairs they fit coordinates that are turned and
    mirrored; in the last ones they do not, and the normal map makes up for that. The right tile of each pair has the
    same normals at its vertices. All bumps bulge, and are bright towards the light, up on the left."""
    stage.sun(LIGHT)
    plain = stage.surface(CLAY)
    texture = bump_map(stage)
    mapped = stage.surface(CLAY, normalTexture={"index": texture})
    cases = [(f"{'mirror ' if mirrored else ''}{90 * quarter}", quarter, mirrored)
             for mirrored in (False, True) for quarter in range(4)]
    # Tangents along +Y under plain coordinates: of a bump's normal (x, y), they ask for (y, -x).
    cases += [("tangent up", (0, 1, 0, 1), lambda n: (n[1], -n[0], n[2])),
              ("tangent left", (-1, 0, 0, 1), lambda n: (-n[0], -n[1], n[2])),
              ("sign", (1, 0, 0, -1), lambda n: (n[0], -n[1], n[2]))]
    for left, right, first, second in stage.pairs(cases):
        if isinstance(first, tuple):
            material = stage.surface(CLAY, normalTexture={"index": bump_map(stage, second)})
            stage.tile(left, material, tangent=lambda s, t: first)
        else:
            uv, tangent = turned_uv(first, second)
            stage.tile(left, mapped, uv=uv, tangent=lambda s, t: tangent)
        stage.tile(right, plain, n=32, normal=bump)
        lit_from_upper_left(stage, left)
    stage.flat_terminator()
    stage.tolerate(5, 64)


SILVER = (0.9, 0.9, 0.88)


def brushed(stage, strength, rotation=None, texture=None, metallic=1, roughness=0.35):
    values = {"anisotropyStrength": strength}
    if rotation is not None:
        values["anisotropyRotation"] = rotation
    if texture is not None:
        values["anisotropyTexture"] = {"index": stage.file.texture(solid(*texture))}
    return stage.surface(SILVER, metallic, roughness, {"anisotropy": values})


def anisotropy_code(degrees, strength=1.0):
    """The code of a direction, counter-clockwise from the tangent, and the strength."""
    x, y = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return tuple(round(255 * c) for c in ((x + 1) / 2, (y + 1) / 2, strength))


def across(n, degrees):
    """A tangent of a normal: along +X as far as possible, then turned counter-clockwise about the normal."""
    along = matrices.unit([1 - n[0] * n[0], -n[0] * n[1], -n[0] * n[2]])
    up = (n[1] * along[2] - n[2] * along[1], n[2] * along[0] - n[0] * along[2], n[0] * along[1] - n[1] * along[0])
    c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
    return (*(c * a + s * b for a, b in zip(along, up)), 1.0)


def brushed_bump(stage, rect, material, degrees=0):
    """A bump with normals and tangents at its vertices."""
    def normal(s, t):
        return bump(s, t, 30)

    stage.tile(rect, material, n=32, normal=normal, tangent=lambda s, t: across(normal(s, t), degrees))


@model("AnisotropyRotationTest")
def anisotropy_rotation_test(stage):
    """The direction of anisotropy is turned counter-clockwise from the tangent, by a factor, by an image, or by both:
    it is as if the tangents were turned. In each pair, the right tile has turned tangents. Highlights run in
    other directions where the angle is another one."""
    stage.sun((-0.2, 0.3, 0.93), 0.5)
    cases = []
    for degrees in (0, 45, 90, 135):
        cases.append((f"factor {degrees}", degrees, math.radians(degrees), None))
        if degrees % 90 == 0:
            cases.append((f"image {degrees}", degrees, None, anisotropy_code(degrees)))
    cases += [("sum 90", 90, math.radians(30), anisotropy_code(60)), ("image 270", 270, None, anisotropy_code(270)),
              ("factor 300", 300, math.radians(300), None)]
    for left, right, degrees, rotation, texture in stage.pairs(cases):
        brushed_bump(stage, left, brushed(stage, 0.8, rotation, texture))
        brushed_bump(stage, right, brushed(stage, 0.8), degrees)
    first, third = stage.checks[-1]["equal"][0][0], stage.checks[-1]["equal"][3][0]
    stage.differ(first, third)
    stage.tolerate(8, 256)


@model("AnisotropyStrengthTest")
def anisotropy_strength_test(stage):
    """Strength stretches highlights along the tangent; it comes from a factor (left tiles) or from the blue of an image
    (right tiles). At 0, it is as if the extension were not there. The upper row is metal, the lower one plastic."""
    stage.sun((-0.2, 0.3, 0.93), 0.5)
    for left, right, metallic, code in stage.pairs(
            [(f"{'metal' if metallic else 'plastic'} {code / 255:.1f}", metallic, code)
             for metallic in (1, 0) for code in (0, 77, 153, 204, 255)]):
        reference = (stage.surface(SILVER, metallic, 0.35) if code == 0 else
                     brushed(stage, 1, None, (255, 128, code), metallic))
        brushed_bump(stage, left, brushed(stage, code / 255, None, None, metallic))
        brushed_bump(stage, right, reference)
    equal = stage.checks[-1]["equal"]
    stage.differ(equal[0][0], equal[4][0])
    stage.tolerate(8, 256)
