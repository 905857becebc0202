"""Models of lights and of surfaces that emit."""

import math

import matrices
import shapes
from stage import METRE, chart, chart_colour, encoded, linear, model, picture

MATT = {"specular": {"specularFactor": 0}}
WHITE = 0.5  # Reflectance of walls.


class Cells:
    """Niches whose black sides keep the light of each from the others: a wall at z = 0, open towards the camera."""

    def __init__(self, stage, columns, rows, width, height, depth=4.0):
        self.stage = stage
        self.rects = stage.grid(columns, rows, width, height)
        self.wall, black = stage.surface((WHITE,) * 3, extensions=MATT), stage.unlit((0, 0, 0), doubleSided=True)
        for rect in self.rects:
            x0, y0, x1, y1 = stage.corners(rect)
            stage.tile(rect, self.wall, n=1)
            sides = shapes.box((x0, y0, -0.01), (x1, y1, depth))
            sides.indices = [i for face in (0, 1, 2, 3) for i in sides.indices[6 * face:6 * face + 6]]
            stage.put(sides.flat(), black)

    def middle(self, i, half=2):
        rect = self.rects[i]
        x, y = (rect[0] + rect[2]) // 2, (rect[1] + rect[3]) // 2
        return [x - half, y - half, x + half, y + half]


def wall_code(irradiance, colour=(1, 1, 1)):
    return [encoded(irradiance * WHITE / math.pi * c) for c in colour]


@model("LightsPunctualLamp")
def lights_punctual_lamp(stage):
    """Point lights and spots before walls, each in a niche of its own. A spot is as bright as a point within its inner
    cone, black beyond its outer one, and turned and moved by its node, whose scale changes neither cone nor brightness.
    From the upper left: point; blue point; spot with a sharp edge; soft spot; spot aimed to the upper right; the sharp
    spot in a scaled node."""
    cells = Cells(stage, 3, 2, 96, 96)
    intensity, height = 2.2, 1.0
    sharp = {"innerConeAngle": 0.4, "outerConeAngle": 0.41}
    blue = (0.1, 0.3, 1)
    labels = ("point", "blue", "sharp spot", "soft spot", "aimed", "scaled")
    spot = {"type": "spot", "spot": sharp}
    lights = [{"type": "point"}, {"type": "point", "color": list(blue)}, spot,
              {"type": "spot", "spot": {"outerConeAngle": 0.6}}, spot, spot]
    for i, (rect, label, light) in enumerate(zip(cells.rects, labels, lights)):
        stage.label(rect, label)
        x, y = stage.centre(rect)
        extension = stage.file.light(intensity=intensity, **light)
        if label == "scaled":
            parent = stage.file.node(translation=[x, y, height / 2], scale=[2, 2, 2])
            stage.file.node(parent, translation=[0, 0, height / 4], extensions=extension)
        else:
            turned = {"rotation": matrices.towards((0.4, 0.4, -height))} if label == "aimed" else {}
            stage.file.node(translation=[x, y, height], extensions=extension, **turned)
    irradiance = intensity / height ** 2
    for i in (0, 2, 5):
        stage.expect(cells.middle(i), wall_code(irradiance), 0)
    stage.expect(cells.middle(1), wall_code(irradiance, blue), 0)
    stage.equal(cells.rects[2], cells.rects[5], 2)
    inner = int(METRE * height * math.tan(sharp["innerConeAngle"]) * 0.7)  # A square within the circle.
    stage.equal(cells.middle(0, inner), cells.middle(2, inner), 0)
    for rect in cells.rects[2:4]:
        stage.expect([rect[0] + 1, rect[1] + 1, rect[0] + 8, rect[1] + 8], (0, 0, 0), 0)
    # Where the aimed spot meets the wall: its distance and its angle count.
    rect = cells.rects[4]
    x, y = (rect[0] + rect[2]) // 2 + round(0.4 * METRE), (rect[1] + rect[3]) // 2 - round(0.4 * METRE)
    length = math.sqrt(height ** 2 + 2 * 0.4 ** 2)
    cosine = height / length
    stage.expect([x - 2, y - 2, x + 2, y + 2], wall_code(intensity / length ** 2 * cosine), 0)
    stage.expect([rect[0] + 1, rect[3] - 9, rect[0] + 9, rect[3] - 1], (0, 0, 0), 0)
    stage.tolerate(10, 512)  # One of six lights is taken at random.


@model("PointLightIntensityTest")
def point_light_intensity_test(stage):
    """Irradiance falls with the square of the distance: the middle of all walls is as bright, under lights of 1, 4 and
    9 times the intensity at 0.5, 1 and 1.5 m (above), and two lights are as bright as one of twice the intensity
    (below: half of it, two of them, one)."""
    cells = Cells(stage, 3, 2, 96, 96)
    lit = [[(0.6, 0.5)], [(2.4, 1.0)], [(5.4, 1.5)], [(1.2, 1.0)], [(1.2, 1.0)] * 2, [(2.4, 1.0)]]
    for i, (rect, lights) in enumerate(zip(cells.rects, lit)):
        x, y = stage.centre(rect)
        stage.label(rect, f"{len(lights)} of {lights[0][0]} at {lights[0][1]}")
        for intensity, height in lights:
            stage.file.node(translation=[x, y, height], extensions=stage.file.light(type="point", intensity=intensity))
        stage.expect(cells.middle(i), wall_code(sum(k / h ** 2 for k, h in lights)), 0)
    stage.equal(cells.rects[4], cells.rects[5], 2)
    stage.equal(cells.rects[1], cells.rects[5], 2)
    stage.tolerate(10, 512)  # One of seven lights is taken at random.


@model("DirectionalLight")
def directional_light(stage):
    """A directional light shines along -Z of its node, and only the node's rotation matters. Sheets that are turned
    away from it darken with the cosine: the right tile of each pair is painted in the brightness of the left one."""
    file = stage.file
    stage.backdrop_z = -50.0  # So that tilted sheets do not see it.
    direction = (0.3, 0.4, 0.866)
    above = matrices.turn((0, 1, 0), 35)
    parent = file.node(rotation=above, scale=[3, 3, 3], translation=[5, -2, -7])
    # The child's turn, so that both together look along -direction.
    inner = matrices.direction(matrices.inverse(matrices.rotation(above)), [-c for c in direction])
    light = file.light(type="directional", intensity=math.pi * 1.2, color=[1, 0.8, 0.6])
    file.node(parent, rotation=matrices.towards(inner), extensions=light)
    n = matrices.unit(direction)
    material = stage.surface((0.7, 0.7, 0.7), extensions=MATT)
    for left, right, axis, angle in stage.pairs([
            ("flat", (1, 0, 0), 0), ("x 30", (1, 0, 0), 30), ("x m30", (1, 0, 0), -30), ("y 30", (0, 1, 0), 30),
            ("y m30", (0, 1, 0), -30), ("y m60", (0, 1, 0), -60)]):
        x, y = stage.centre(left)
        half = (left[2] - left[0]) / 2 / METRE
        turned = matrices.rotation(matrices.turn(axis, angle))
        normal = matrices.direction(turned, (0, 0, 1))
        narrow = math.cos(math.radians(angle))  # So that it fills the square all the same.
        wide = half / narrow
        a, b = (half, wide) if axis[0] else (wide, half)
        mesh = shapes.sheet(-a, -b, a, b).moved(matrices.product(matrices.translation(x, y), turned))
        stage.put(mesh, material)
        cosine = max(0, sum(p * q for p, q in zip(n, normal)))
        stage.canvas.fill(right, [encoded(0.7 * 1.2 * cosine * c) for c in (1, 0.8, 0.6)])
    stage.tolerate(6, 64)


# Of a cube map's faces as OpenGL defines them: what goes to the right and downwards, before the images are mirrored.
FACES = {"px": ((0, 0, -1), (0, -1, 0)), "nx": ((0, 0, 1), (0, -1, 0)), "py": ((1, 0, 0), (0, 0, 1)),
         "ny": ((1, 0, 0), (0, 0, -1)), "pz": ((1, 0, 0), (0, -1, 0)), "nz": ((-1, 0, 0), (0, -1, 0))}
FACE_COLOURS = ((240, 60, 60), (60, 220, 220), (70, 230, 60), (220, 70, 220), (70, 90, 240), (230, 220, 60))
QUARTERS = ((1.0, 0.75), (0.5, 0.25))  # How bright those of a face are: rows, of the image that is stored.


def quarter_code(face, right, down):
    return [round(QUARTERS[down][right] * c) for c in FACE_COLOURS[face]]


@model("EnvironmentTest")
def environment_test(stage):
    """Mirrors that are tilted so that each shows a quarter of a face of the cube map that lights the scene: faces, how
    they lie and the turn of the whole are as specified. What lies behind the mirrors is not shown: a face, and half of
    four."""
    file = stage.file
    stage.backdrop_z = -50.0  # So that mirrors do not see it.
    file.used.add("EXT_lights_image_based")
    images = []
    for face in range(6):
        images.append(file.image(picture(32, 32, lambda x, y: quarter_code(face, x // 16, y // 16))))
    turn = matrices.turn((0, 1, 0), 90)
    file.json.setdefault("extensions", {})["EXT_lights_image_based"] = {"lights": [{
        "rotation": list(turn), "intensity": 1, "irradianceCoefficients": [[0, 0, 0]] * 9, "specularImageSize": 32,
        "specularImages": [images]}]}
    file.json["scenes"][0]["extensions"] = {"EXT_lights_image_based": {"light": 0}}
    mirror = stage.surface((1, 1, 1), metallic=1, roughness=0)
    axes = {"px": (1, 0, 0), "nx": (-1, 0, 0), "py": (0, 1, 0), "ny": (0, -1, 0), "pz": (0, 0, 1), "nz": (0, 0, -1)}
    rotation = matrices.rotation(turn)
    cases = []
    for face, (name, (right, down)) in enumerate(FACES.items()):
        for across, below in ((-1, -1), (1, -1), (-1, 1), (1, 1)):
            inside = [a + 0.5 * across * r + 0.5 * below * d for a, r, d in zip(axes[name], right, down)]
            seen = matrices.unit(matrices.direction(rotation, inside))
            if seen[2] < 0:
                continue
            # Mirrored images: what lies to the left is stored to the right.
            colour = quarter_code(face, 0 if across > 0 else 1, 1 if below > 0 else 0)
            cases.append((f"{name} {'ul ur ll lr'.split()[2 * (below > 0) + (across < 0)]}", seen, colour))
    for rect, (label, seen, colour) in zip(stage.grid(4, 3, 52, 44), cases):
        stage.label(rect, label)
        nx, ny, nz = matrices.unit([seen[0], seen[1], seen[2] + 1])
        x, y = stage.centre(rect)
        x0, y0, x1, y1 = stage.corners(rect)
        mesh = shapes.sheet(x0, y0, x1, y1, normal=lambda s, t: (nx, ny, nz))
        # The more it looks towards the camera the nearer to it, so that no mirror shows another one.
        z = 8 * seen[2]
        mesh.positions = [(px, py, z - (nx * (px - x) + ny * (py - y)) / nz) for px, py, _ in mesh.positions]
        stage.put(mesh, mirror)
        stage.expect(rect, colour)


@model("EmissiveStrengthTest")
def emissive_strength_test(stage):
    """Emission is factor times image times strength. In each pair, the right tile is painted in the product. Strengths
    above 1 light what is near: the last tile, a matt wall that a strip lights from above, is bright at its top."""
    texture = stage.file.texture(chart())
    black = (0, 0, 0)

    def glow(factor, strength=None, texture=None, base=black):
        extensions = {**MATT, **({} if strength is None else {"emissive_strength": {"emissiveStrength": strength}})}
        more = {} if texture is None else {"emissiveTexture": {"index": texture}}
        return stage.surface(base, extensions=extensions, emissiveFactor=list(factor), **more)

    orange = (0.8, 0.4, 0.1)
    cases = [("factor", glow(orange), orange), ("strength 0", glow(orange, 0), (0, 0, 0)),
             ("strength 0.5", glow(orange, 0.5), [c / 2 for c in orange]),
             ("strength 5", glow((0.1, 0.2, 0.02), 5), (0.5, 1, 0.1)),
             ("image", glow((1, 1, 1), None, texture), 1), ("product", glow((0.1, 0.1, 0.1), 4, texture), 0.4),
             ("no factor", stage.file.material(MATT | {"emissive_strength": {"emissiveStrength": 7}}, emissiveTexture={
                 "index": texture}, pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0}), 0)]
    for left, right, material, shown in stage.pairs(cases):
        stage.tile(left, material)
        side = (right[2] - right[0]) // 8
        for row in range(8):
            for column in range(8):
                colour = shown if not isinstance(shown, (int, float)) else [
                    shown * c for c in linear(chart_colour(column, row))]
                x, y = right[0] + column * side, right[1] + row * side
                stage.canvas.fill((x, y, x + side, y + side), [encoded(c) for c in colour])
    wall = [130, 185, 300, 235]
    stage.tile(wall, stage.surface((0.7, 0.7, 0.7), extensions=MATT))
    x0, _, x1, y1 = stage.corners(wall)
    lamp = shapes.sheet(x0, -0.1, x1, 0.1).moved(matrices.product(
        matrices.translation(0, y1, 0.12), matrices.rotation(matrices.turn((1, 0, 0), 90))))
    stage.put(lamp, glow((1, 1, 1), 6))
    left, right = wall[0] + 40, wall[2] - 40
    stage.differ([left, wall[1] + 4, right, wall[1] + 14], [left, wall[3] - 14, right, wall[3] - 4])
    stage.tolerate(3, 64)
