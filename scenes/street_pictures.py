"""Pictures of make_street.py, as arrays of rows from the top: what shines, in linear light, and surfaces in sRGB.

Needs NumPy (Debian: python3-numpy).
"""

import math

import numpy as np

import street_meshes
import textures


def srgb(light):
    """Codes from 0 to 1 of light from 0 to 1."""
    light = np.clip(light, 0, 1)
    return np.where(light < 0.0031308, 12.92 * light, 1.055 * light ** (1 / 2.4) - 0.055)


def shade(image, mask, color):
    """Paints where mask is 1."""
    image += mask[..., None] * (np.asarray(color, float) - image)


def between(x, low, high, soft=0.01):
    return textures.smoothstep(low - soft, low + soft, x) * (1 - textures.smoothstep(high - soft, high + soft, x))


def lettering(text, width, height, upright=False, margin=0.16, thickness=0.07):
    """A mask of letters in a row, or one below the other."""
    x, y = textures.grid(width, height)
    x, y = x * width, y * height
    count = len(text)
    cell = (width, height / count) if upright else (width / count, height)
    mask = np.zeros_like(x)
    for i, letter in enumerate(text):
        corner = np.array([0, (count - 1 - i) * cell[1]] if upright else [i * cell[0], 0])
        inner = np.array(cell) * (1 - 2 * margin)
        if upright:
            inner[1] = min(inner[1], 1.3 * inner[0])
        corner = corner + (np.array(cell) - inner) / 2
        for line in street_meshes.strokes(letter):
            line = corner + line[:: 2 if len(line) > 24 else 1] * inner
            for a, b in zip(line[:-1], line[1:]):
                along = b - a
                t = np.clip(((x - a[0]) * along[0] + (y - a[1]) * along[1]) / max(along @ along, 1e-9), 0, 1)
                distance = np.hypot(x - a[0] - t * along[0], y - a[1] - t * along[1])
                mask = np.maximum(mask, np.clip(thickness * min(cell) - distance + 0.5, 0, 1))
    return mask


def room(seed, width=96, height=144):
    """What is seen through a lit window: a wall in the light of a lamp, curtains or a blind, and things."""
    random = np.random.RandomState(seed)
    u, v = textures.grid(width, height)
    warm = [[1.0, 0.62, 0.28], [1.0, 0.72, 0.42], [1.0, 0.50, 0.20], [0.85, 0.85, 0.75], [0.35, 0.55, 1.0]]
    tint = np.array(warm[random.choice(5, p=[0.36, 0.28, 0.2, 0.1, 0.06])])
    lamp = random.uniform(0.2, 0.8), random.uniform(0.55, 0.85)
    near = np.exp(-((u - lamp[0]) ** 2 + (0.7 * (v - lamp[1])) ** 2) / 0.16)
    image = (0.16 + 0.75 * near)[..., None] * tint
    for _ in range(random.randint(1, 4)):  # Furniture, pictures, heads of people.
        x, w, h = random.uniform(0.05, 0.8), random.uniform(0.08, 0.3), random.uniform(0.1, 0.42)
        shade(image, 0.8 * between(u, x, x + w) * between(v, -1, h), 0.18 * tint * random.uniform(0.3, 1, 3))
    x, w, y = random.uniform(0.1, 0.6), random.uniform(0.12, 0.3), random.uniform(0.5, 0.7)
    shade(image, between(u, x, x + w) * between(v, y, y + 0.15), tint * random.uniform(0.1, 0.7, 3))
    shape = np.hypot(u - lamp[0], 1.4 * (v - lamp[1]))
    shade(image, 1 - textures.smoothstep(0.09, 0.1, shape), np.minimum(2.2 * tint, 1))
    kind = random.randint(4)
    folds = 0.5 + 0.25 * np.sin(2 * math.pi * (random.uniform(7, 11) * u + 0.6 * np.sin(3 * v + 6 * u)))
    if kind == 0:  # A blind.
        slats = 0.45 + 0.4 * (np.sin(2 * math.pi * 22 * v) > -0.2)
        shade(image, between(v, random.uniform(0.1, 0.6), 2) * 0.85, (slats * (0.25 + 0.4 * near))[..., None] * tint)
    elif kind < 3:  # Curtains, open by a width.
        gap = random.uniform(0.0, 0.33)
        cloth = tint * random.uniform(0.35, 0.95, 3)
        edge = gap + 0.05 * np.sin(4 * v + seed)
        shade(
            image,
            0.9 * textures.smoothstep(edge, edge + 0.02, np.abs(u - 0.5)),
            (folds * (0.35 + 0.5 * near))[..., None] * cloth,
        )
    return image * (0.92 + 0.08 * textures.value_noise(u, v, (24, 36), seed))[..., None]


def atlas(pictures, columns):
    rows = [np.hstack(pictures[i : i + columns]) for i in range(0, len(pictures), columns)]
    return np.vstack(rows)


def shop(seed, width=448, height=256):
    """The inside of a shop: lamps, shelves of goods, a counter."""
    random = np.random.RandomState(seed)
    u, v = textures.grid(width, height)
    tint = np.array(
        [[1.0, 0.76, 0.46], [1.0, 0.86, 0.64], [0.8, 0.93, 1.0], [1.0, 0.66, 0.4], [1.0, 0.72, 0.72]][seed % 5]
    )
    lamps = (np.arange(4) + random.uniform(0.3, 0.7)) / 4
    glow = sum(np.exp(-(((u - x) / 0.16) ** 2) - ((v - 0.9) / 0.5) ** 2) for x in lamps)
    image = (0.2 + 0.34 * glow)[..., None] * tint * [1, 0.95, 0.88]
    hues = random.uniform(0.1, 1.0, (6, 3))
    for shelf in np.arange(0.3, 0.8, 0.125):  # Of goods, each of its own width, height and colour.
        x = 0.02
        while x < 0.97:
            w, h = random.uniform(0.012, 0.04), random.uniform(0.045, 0.1)
            color = (0.35 + 0.55 * random.uniform()) * hues[random.randint(6)] * tint
            light = 0.35 + 0.6 * glow
            if random.uniform() < 0.86:
                shade(
                    image, between(u, x, x + w, 0.002) * between(v, shelf, shelf + h, 0.004), light[..., None] * color
                )
            x += w + random.uniform(0.002, 0.01)
        shade(image, between(v, shelf - 0.014, shelf, 0.003), (0.2 + 0.2 * glow)[..., None] * tint * [0.5, 0.36, 0.25])
    for x in (0.0, 0.34, 0.66, 1.0):
        shade(image, between(u, x - 0.006, x + 0.006, 0.002) * between(v, 0.2, 0.85), tint * [0.12, 0.09, 0.07])
    counter = between(v, -1, 0.22, 0.006)
    grain = textures.fractal_noise(u, v, (4, 40), seed)
    shade(image, counter, ((0.12 + 0.22 * grain) * (0.5 + 0.4 * glow))[..., None] * tint * [0.8, 0.5, 0.3])
    for x in lamps:
        shade(image, between(u, x - 0.002, x + 0.002, 0.001) * between(v, 0.9, 2), (0.02, 0.02, 0.02))
        shade(image, np.hypot((u - x) * width / height, 1.3 * (v - 0.87)) < 0.045, np.minimum(1.6 * tint, 1))
    return image


def lantern(seed, color, width=192, height=96):
    """Paper around a flame: ribs, a band of signs."""
    u, v = textures.grid(width, height)
    light = 0.35 + 0.65 * np.exp(-(((v - 0.42) / 0.28) ** 2))
    ribs = 0.72 + 0.28 * np.abs(np.sin(math.pi * 12 * v)) ** 0.5
    paper = 0.85 + 0.15 * textures.fractal_noise(u, v, (16, 8), seed)
    image = (light * ribs * paper)[..., None] * np.array(color)
    ends = 1 - between(v, 0.07, 0.93, 0.004)
    shade(image, ends, (0.004, 0.003, 0.003))
    text = np.tile(lettering(["candle", "moon", "bowl"][seed % 3 :][:1], width // 4, height, margin=0.27), 4)
    shade(image, 0.93 * text, (0.03, 0.005, 0.003))
    return image


def panel(text, paper, ink, width, height, upright):
    """A box of light with letters on it."""
    u, v = textures.grid(width, height)
    tubes = 0.75 + 0.25 * np.cos(2 * math.pi * 2 * (v if width > height else u)) ** 2
    image = tubes[..., None] * np.array(paper, float)
    side = np.minimum(np.minimum(u, 1 - u) * width, np.minimum(v, 1 - v) * height)
    shade(image, (side < 3).astype(float), 0.1 * np.array(ink))
    shade(image, between(side, 6, 9, 0.5), np.array(ink))
    shade(image, lettering(text, width, height, upright, thickness=0.085), np.array(ink))
    return image


def screen(seed, width=384, height=256):
    """An advertisement: a sun behind hills over water; or a wave of colours; in rows of diodes."""
    u, v = textures.grid(width, height)
    if seed == 0:
        image = textures.ramp(
            v, [(0, (0.05, 0.0, 0.15)), (0.4, (0.9, 0.1, 0.35)), (0.6, (0.4, 0.05, 0.5)), (1, (0.02, 0.02, 0.2))]
        )
        distance = np.hypot((u - 0.5) * 1.5, v - 0.55)
        bands = (np.sin(2 * math.pi * 26 * v) > 1.6 - 4 * v) | (v > 0.6)
        shade(image, (distance < 0.27) * bands * 1.0, np.stack([0 * v + 1, 0.25 + 0.7 * v, 0.15 * v], axis=-1))
        hills = (
            0.36 + 0.13 * np.abs(textures.fractal_noise(u, 0 * v + 0.5, (7, 1), 5) - 0.5) * 4 * np.abs(u - 0.5) ** 0.5
        )
        shade(image, (v < hills) * 1.0, (0.02, 0.0, 0.06))
        lines = (np.abs(np.sin(2.2 / np.maximum(0.38 - v, 0.01))) > 0.93) | (
            np.abs((u - 0.5) / np.maximum(0.5 - v, 0.02) * 4 % 1 - 0.5) > 0.46
        )
        shade(image, 0.8 * lines * (v < 0.33), (0.1, 0.8, 1.0))
    else:
        wave = textures.fractal_noise(u, v, (3, 2), 70 + seed)
        image = 0.5 + 0.5 * np.cos(
            2 * math.pi * (wave[..., None] * 1.7 + u[..., None] * 0.6 + np.array([0.0, 0.33, 0.6]) + 0.3 * seed)
        )
        image = image**2.2
        shade(image, lettering(["candle"], width, height, margin=0.2, thickness=0.04), (1, 1, 1))
    diodes = 0.82 + 0.18 * np.abs(np.sin(math.pi * 96 * u) * np.sin(math.pi * 64 * v))
    return image * diodes[..., None]


def tower(seed, columns=20, rows=44, texels=6):
    """Windows of a tower far away, most of them dark."""
    random = np.random.RandomState(seed)
    lit = random.uniform(size=(rows, columns)) < 0.27 + 0.2 * (random.uniform(size=(rows, 1)) < 0.2)
    tints = np.array([[1.0, 0.7, 0.36], [1.0, 0.84, 0.6], [0.75, 0.88, 1.0]])[
        random.choice(3, (rows, columns), p=[0.5, 0.3, 0.2])
    ]
    light = (lit * random.uniform(0.2, 1, (rows, columns)) ** 1.6)[..., None] * tints
    image = np.kron(light, np.ones((texels, texels, 1)))
    y, x = np.indices(image.shape[:2]) % texels
    return image * ((x > 0) & (x < texels - 1) & (y > 1))[..., None]


def bricks(seed, rows=16, columns=6, size=512):
    """A wall of bricks in one period: the tint of each, dark in the joints."""
    u, v = textures.grid(size, size)
    random = np.random.RandomState(seed)
    row = np.floor(v * rows).astype(int)
    x = u * columns + 0.5 * (row % 2)
    tint = random.uniform(0.55, 1.0, (rows, columns))[row % rows, np.floor(x).astype(int) % columns]
    edge = np.minimum((0.5 - np.abs(x % 1 - 0.5)) / columns, (0.5 - np.abs(v * rows % 1 - 0.5)) / rows)
    inside = textures.smoothstep(0.002, 0.005, edge)
    stain = 0.6 + 0.8 * textures.fractal_noise(u, v, (4, 3), seed)
    grain = 0.85 + 0.3 * textures.fractal_noise(u, v, (32, 32), seed + 9)
    return np.clip((0.42 + inside * (tint - 0.42)) * stain * grain, 0, 1)


def plaster(seed, size=512):
    u, v = textures.grid(size, size)
    streaks = textures.fractal_noise(u, v, (24, 2), seed)
    cloud = textures.fractal_noise(u, v, (3, 3), seed + 5, 6)
    return np.clip(0.45 + 0.35 * cloud + 0.2 * streaks, 0, 1)


def slabs(seed, size=512, count=4):
    """Slabs of a pavement: their tint, and how wet they are."""
    u, v = textures.grid(size, size)
    row = np.floor(v * count).astype(int)
    x = u * count + 0.5 * (row % 2)
    tint = np.random.RandomState(seed).uniform(0.75, 1, (count, count))[row, np.floor(x).astype(int) % count]
    edge = np.minimum(0.5 - np.abs(x % 1 - 0.5), 0.5 - np.abs(v * count % 1 - 0.5))
    grain = 0.75 + 0.5 * textures.fractal_noise(u, v, (24, 24), seed + 1, 4)
    return np.clip(tint * grain * (0.4 + 0.6 * textures.smoothstep(0.01, 0.03, edge)), 0, 1)


def noise_at(x, z, seed, octaves=4):
    """Noise of places [m], whose coarsest features are a metre wide; it repeats after 256 m."""
    return textures.fractal_noise(x / 256 + 0.5, z / 256 + 0.5, (256, 256), seed, octaves)
