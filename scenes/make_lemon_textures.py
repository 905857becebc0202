#!/usr/bin/env python3
"""Makes the textures of lemons.json: `python3 make_lemon_textures.py` writes PNG files into lemons/.

They are the same each time. Needs NumPy (Debian: python3-numpy). Colours are sRGB, all else is linear.
"""

from pathlib import Path

import numpy as np

from textures import (
    cells_noise,
    fractal_noise,
    grid,
    mix,
    normals,
    ramp,
    smoothstep,
    value_noise,
    write_png,
    write_ramp,
)

FOLDER = Path(__file__).parent / "lemons"


def save(name, image, step=1):
    write_png(FOLDER / name, image, step)


def board(x, z, seed):
    """How dark wood is, from 0 to 1, at x along the grain and z across it [m]: one board, sawn from a log."""
    random = np.random.RandomState(seed)
    pith, depth, slope = random.uniform(-0.04, 0.11), random.uniform(0.03, 0.07), random.uniform(-0.07, 0.07)
    u, v = x / 0.9, z / 0.15
    bend = 0.022 * (fractal_noise(u, v, (3, 2), seed + 1, 2) - 0.5)
    below = depth + slope * (x - 0.45) + 0.02 * (fractal_noise(u, v, (2, 1), seed + 3, 2) - 0.5)
    radius = np.hypot(z - pith + bend, below)
    rings = radius / 0.0052 + 1.4 * fractal_noise(u, v, (2, 1), seed + 5, 3)
    phase = rings - np.floor(rings)
    late = smoothstep(0.25, 0.92, phase) * (1 - smoothstep(0.93, 1.0, phase))
    strength = 0.4 + 0.6 * value_noise(rings / 16, v * 0, (16, 1), seed + 9)
    fibre = fractal_noise(u, v, (14, 96), seed + 11, 2)
    tone = fractal_noise(u, v, (3, 4), seed + 15, 3)
    return 0.12 + 0.42 * late * strength + 0.3 * (fibre - 0.5) + 0.5 * (tone - 0.5) + random.uniform(0, 0.16)


def pores(u, v, seed):
    """Short dark lines along the grain, from 0 to 1."""
    return smoothstep(0.86, 0.98, value_noise(u, v, (64, 320), seed))


def wood():
    """Three boards of 0.9 m by 0.15 m, one above the other."""
    u, v = grid(1024, 512)
    row = np.floor(v * 3).astype(int)
    dark = np.zeros_like(u)
    for i in range(3):
        dark = np.where(row == i, board(u * 0.9, (v * 3 - i) * 0.15, 100 + 40 * i), dark)
    holes = pores(u, v, 7)
    dark = dark + 0.3 * holes
    stops = [(0, (0.63, 0.45, 0.29)), (0.35, (0.51, 0.33, 0.19)), (0.7, (0.36, 0.21, 0.115)), (1, (0.2, 0.11, 0.06))]
    write_ramp(FOLDER / "wood.png", dark, stops)
    wear = fractal_noise(u, v, (9, 5), 31, 4)
    gloss = 0.25 + 1.1 * (wear - 0.3) - 0.3 * dark - 0.35 * holes
    save("wood-gloss.png", np.clip(gloss[::2, ::2], 0.04, 1), 8)


TILES = 8  # Along each side of the image; a tile is 75 mm wide.


def tiles():
    """Glazed tiles, cut and set by hand: no two have one colour, or lie quite in one plane."""
    u, v = grid(512, 512)
    x, y = u * TILES, v * TILES
    i, j = np.floor(x).astype(int) % TILES, np.floor(y).astype(int) % TILES
    random = np.random.RandomState(5)
    tone, tilt_u, tilt_v, turn = (random.uniform(-1, 1, (TILES, TILES))[j, i] for _ in range(4))
    s, t = x - np.floor(x) - 0.5, y - np.floor(y) - 0.5
    s, t = s + 0.02 * turn * t, t - 0.02 * turn * s
    ragged = 0.012 * (fractal_noise(u, v, (64, 64), 71, 2) - 0.5)
    inside = 0.475 - np.maximum(abs(s), abs(t)) + ragged
    glazed = smoothstep(0.0, 0.025, inside)
    pool = fractal_noise(u, v, (20, 20), 61, 4)
    glaze = 0.45 + 0.30 * tone + 0.6 * (pool - 0.5) - 0.25 * (1 - smoothstep(0, 0.1, inside))
    chip = smoothstep(0.88, 0.91, value_noise(u, v, (52, 52), 91)) * (1 - smoothstep(0.03, 0.09, inside)) * glazed
    colour = ramp(
        glaze, [(0, (0.02, 0.12, 0.13)), (0.4, (0.035, 0.24, 0.25)), (0.75, (0.09, 0.36, 0.34)), (1, (0.24, 0.5, 0.44))]
    )
    grout = 0.14 + 0.14 * fractal_noise(u, v, (60, 60), 81, 2)
    colour = mix(grout[..., None] * [1, 0.95, 0.87], colour, glazed[..., None])
    colour = mix(colour, [0.56, 0.42, 0.32], chip[..., None])
    save("tiles.png", colour, 4)
    hand = 0.0010 * fractal_noise(u, v, (24, 24), 51, 2) + 0.0005 * smoothstep(-0.02, 0.09, inside)
    tilted = 0.075 * (tilt_u * 0.035 * s + tilt_v * 0.035 * t) * smoothstep(0, 0.01, inside)
    save("tiles-normal.png", normals(hand + tilted, (0.6, 0.6)), 2)
    save("tiles-gloss.png", np.clip(glazed - chip, 0.02, 1)[::2, ::2], 8)


THREADS = 64  # Along each side of the image of the cloth's colours; the normal map has 16.


def weave(u, v, threads):
    """Linen: which thread is on top (true: along v), how high it is, and how far each pixel is from its middle."""
    x, y = u * threads, v * threads
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    s, t = x - i - 0.5, y - j - 0.5
    warp = (i + j) % 2 == 0
    across, along = np.where(warp, s, t), np.where(warp, t, s)
    height = np.cos(np.pi * along) * np.sqrt(np.maximum(1 - (across / 0.47) ** 2, 0))
    return warp, height, i, j


def cloth():
    """Undyed linen with blue stripes both ways, a checked tea towel."""
    u, v = grid(512, 512)
    warp, height, i, j = weave(u, v, THREADS)
    thread = np.where(warp, i, j)
    blue = ((thread % 64 >= 6) & (thread % 64 < 16)) | ((thread % 64 >= 19) & (thread % 64 < 21))
    yarn = np.where(
        warp,
        np.random.RandomState(3).random_sample(THREADS)[i % THREADS],
        np.random.RandomState(4).random_sample(THREADS)[j % THREADS],
    )
    light = 0.62 + 0.38 * np.round(3 * height) / 3
    undyed, dyed = np.array([0.86, 0.82, 0.74]), np.array([0.17, 0.29, 0.47])
    colour = np.where(blue[..., None], dyed, undyed) * (light * (0.93 + 0.07 * np.round(yarn * 2) / 2))[..., None]
    save("linen.png", colour, 8)
    u, v = grid(128, 128)
    save("linen-normal.png", normals(0.0005 * weave(u, v, 16)[1], (0.04, 0.04)), 2)


def jug():
    """Stoneware, dipped into glaze with its foot in the hand: bare clay below a line where the glaze ran."""
    u, v = grid(512, 512)
    drops = fractal_noise(u, v * 0, (9, 1), 21, 3)
    edge = 0.172 + 0.10 * (drops - 0.5) + 0.02 * (fractal_noise(u, v, (24, 24), 25, 2) - 0.5)
    thick = smoothstep(0.0, 0.018, v - edge)
    bead = np.exp(-(((v - edge - 0.016) / 0.010) ** 2))
    grain = fractal_noise(u, v, (64, 64), 33, 3)
    first, _, cell = cells_noise(u, v, (46, 46), 41)
    iron = np.random.RandomState(42).random_sample(46 * 46)[cell] < 0.16
    speck = iron * (1 - smoothstep(0.08, 0.24, first))
    clay = ramp(grain, [(0, (0.42, 0.27, 0.18)), (1, (0.62, 0.44, 0.31))])
    clay = mix(clay, [0.2, 0.12, 0.08], (0.8 * speck)[..., None])
    run = fractal_noise(u, v, (20, 3), 45, 3)
    cream = ramp(run, [(0.2, (0.76, 0.70, 0.58)), (0.8, (0.89, 0.86, 0.79))])
    brown = np.clip(0.55 * speck + 0.65 * (1 - smoothstep(0.002, 0.045, v - edge)), 0, 1)
    cream = mix(cream, [0.52, 0.38, 0.24], brown[..., None])
    save("jug.png", mix(clay, cream, thick[..., None]), 4)
    save("jug-gloss.png", np.clip(thick, 0.03, 1)[::2, ::2], 4)
    rings = 0.00012 * np.sin(2 * np.pi * (44 * v + 0.8 * fractal_noise(u, v, (2, 4), 47, 2)))
    height = rings * (1 - 0.55 * thick) + 0.00012 * (grain - 0.5) * (1 - thick) + 0.0004 * thick + 0.0004 * bead
    height = height + 0.0003 * fractal_noise(u, v, (6, 5), 49, 1)
    save("jug-normal.png", normals(height, (0.34, 0.34))[::2, ::2], 1)


def copper():
    """The marks of a round hammer side by side, and the tarnish between them."""
    u, v = grid(256, 256)
    first, second, cell = cells_noise(u, v, (8, 8), 11, 0.6)
    save("copper-normal.png", normals(0.0011 * np.minimum(first, 0.75) ** 2 * 2, (0.08, 0.08)), 2)
    worn = fractal_noise(u, v, (6, 6), 13, 4)
    rough = 0.14 + 0.12 * (1 - smoothstep(0.02, 0.3, second - first)) + 0.3 * (worn - 0.4)
    save("copper-rough.png", np.clip(rough, 0.08, 1), 4)
    dark = np.clip(0.55 * (1 - smoothstep(0.0, 0.35, second - first)) + 0.9 * (worn - 0.5), 0, 1)
    stops = [(0, (0.97, 0.73, 0.60)), (0.5, (0.90, 0.61, 0.46)), (1, (0.70, 0.43, 0.31))]
    write_ramp(FOLDER / "copper.png", dark, stops)


def fingerprint(u, v, place, angle, size, seed):
    """Ridges on an oval around a place, from 0 to 1."""
    x, y = (u - place[0]) / size[0], (v - place[1]) / size[1]
    x, y = np.cos(angle) * x + np.sin(angle) * y, np.cos(angle) * y - np.sin(angle) * x
    radius = np.hypot(x, 0.75 * y)
    bent = np.hypot(x, 0.55 * (y + 0.35) + 0.25 * x * x) + 0.08 * fractal_noise(u, v, (20, 20), seed, 2)
    ridges = smoothstep(0.25, 0.75, 0.5 + 0.5 * np.sin(2 * np.pi * 8.5 * bent))
    touch = smoothstep(0.3, 0.55, fractal_noise(u, v, (26, 26), seed + 5, 3) + 0.25 * (1 - radius))
    return ridges * touch * (1 - smoothstep(0.75, 1.0, radius))


PRINTS = [  # The place and the angle [rad] of each finger.
    *[((0.14, 0.36), 0.5), ((0.235, 0.42), 0.2), ((0.33, 0.37), -0.1), ((0.5, 0.30), -0.5)],
    *[((0.62, 0.40), 0.4), ((0.70, 0.33), 0.1), ((0.83, 0.38), -0.3), ((0.96, 0.31), 0.4)],
]


def silver():
    """The roughness of polished silver that was held: smudges, fingerprints and fine scratches."""
    u, v = grid(768, 512)
    rough = 0.07 + 0.22 * smoothstep(0.45, 0.75, fractal_noise(u, v, (6, 5), 3, 4))
    scratch = smoothstep(0.93, 0.98, value_noise(u, v + 0.02 * np.sin(2 * np.pi * u), (10, 380), 8))
    rough = rough + 0.12 * scratch
    for k, (place, angle) in enumerate(PRINTS):
        rough = rough + 0.55 * fingerprint(u, v, place, angle, (0.042, 0.068), 70 + 7 * k)
    save("silver-rough.png", rough, 16)


def peel():
    """The oil glands in a lemon's peel."""
    u, v = grid(128, 128)
    first, _, _ = cells_noise(u, v, (14, 14), 17)
    height = -0.00028 * (1 - smoothstep(0.0, 0.42, first)) + 0.0003 * fractal_noise(u, v, (5, 5), 19, 2)
    save("peel-normal.png", normals(height, (0.025, 0.025)), 2)


def cut_lemon():
    """The cut face of a lemon, in the circle that a disk shows."""
    u, v = grid(384, 384)
    x, y = 2 * u - 1, 2 * v - 1
    radius, angle = np.hypot(x, y), np.arctan2(y, x)
    segments = 9
    turned = angle / (2 * np.pi) * segments + 0.25 * (value_noise(u, v, (5, 5), 25) - 0.5)
    wall = abs(turned - np.floor(turned) - 0.5)  # 0 in the middle of a segment, 0.5 at its wall.
    width = (0.5 - wall) * radius * 2 * np.pi / segments
    rounded = radius - 0.03 * (1 - (2 * wall) ** 4)
    pulp = smoothstep(0.010, 0.026, width) * smoothstep(0.08, 0.13, radius) * (1 - smoothstep(0.815, 0.845, rounded))
    along = radius * 0.5 + 0.13 * np.floor(turned * 5) % 1
    vesicle = fractal_noise((turned % segments) / segments, along, (72, 9), 29, 3)
    stops = [(0.2, (0.80, 0.62, 0.13)), (0.55, (0.93, 0.82, 0.36)), (0.9, (0.98, 0.93, 0.66))]
    flesh = ramp(vesicle + 0.12 * (radius - 0.5), stops)
    pith = mix(np.array([0.95, 0.92, 0.78]), [0.97, 0.86, 0.45], smoothstep(0.90, 0.955, radius)[..., None])
    pith = mix(pith, [0.94, 0.72, 0.08], smoothstep(0.945, 0.97, radius)[..., None])
    save("slice.png", mix(pith, flesh, pulp[..., None]), 4)
    save("slice-normal.png", normals(0.0012 * pulp * (0.6 + vesicle), (0.06, 0.06))[::2, ::2], 2)


def leaf():
    """A leaf of laurel, its tip at the top; the alpha is 0 around it."""
    u, v = grid(128, 256)
    s, t = 2 * u - 1, (v - 0.03) / 0.94
    inside = np.clip(t, 0, 1)
    half = 0.92 * np.sin(np.pi * inside**0.85) ** 0.9 * (1 - 0.25 * inside)
    half = half + 0.035 * (1 - smoothstep(0.0, 0.12, inside))
    half = half + 0.03 * (fractal_noise(u * 0, v, (1, 14), 3, 2) - 0.5) * smoothstep(0.1, 0.3, inside)
    alpha = ((abs(s) < half) & (t > 0) & (t < 1)).astype(float)
    outward = abs(s) / np.maximum(half, 1e-3)
    vein = np.exp(-((s / 0.035) ** 2)) * (1 - 0.5 * inside)
    comb = 13 * (t - 0.42 * abs(s)) + 0.35 * (s > 0)
    side = np.exp(-(((comb - np.round(comb)) / 0.09) ** 2)) * (1 - smoothstep(0.6, 1, outward))
    mottle = fractal_noise(u, v, (6, 10), 13, 4)
    colour = ramp(mottle, [(0.2, (0.20, 0.34, 0.13)), (0.8, (0.36, 0.50, 0.20))])
    colour = mix(colour, [0.62, 0.68, 0.36], np.clip(0.8 * vein + 0.35 * side, 0, 1)[..., None])
    colour = mix(colour, [0.45, 0.40, 0.16], (0.6 * smoothstep(0.85, 1.0, outward))[..., None])
    save("leaf.png", np.dstack([np.round(colour * 64) / 64, alpha]))


BLADES = [  # Of the bamboo: u and v of the stalk, angle [rad], length.
    *[(0.24, 0.25, 0.9, 0.34), (0.25, 0.34, 2.5, 0.2), (0.27, 0.52, 0.7, 0.40)],
    *[(0.28, 0.6, 2.2, 0.22), (0.30, 0.78, 1.1, 0.30), (0.29, 0.74, 0.1, 0.3)],
]


def bamboo(u, v):
    """The shadow of a twig on a panel twice as high as it is wide."""
    shadow = np.exp(-(((u - 0.22 - 0.10 * v) / 0.012) ** 4))
    for x, y, angle, length in BLADES:
        px, py = u - x, (v - y) * 2
        along = (np.cos(angle) * px + np.sin(angle) * py) / length
        beside = (np.cos(angle) * py - np.sin(angle) * px) / length
        width = 0.13 * np.sin(np.pi * np.clip(along, 0, 1)) ** 0.7
        outside = abs(beside) + 0.2 * ((along < 0) | (along > 1))
        shadow = np.maximum(shadow, 1 - smoothstep(width - 0.03, width + 0.03, outside))
    return shadow


def lantern():
    """A panel of paper before a bulb: its fibres, and the shadow of a twig behind it."""
    u, v = grid(256, 512)
    glow = np.exp(-(((u - 0.5) / 0.40) ** 2) - ((v - 0.40) / 0.30) ** 2)
    fibre = abs(fractal_noise(u + 0.15 * v, v, (10, 20), 5, 3) - 0.5)
    paper = (0.16 + 0.84 * glow) * (0.86 + 0.14 * smoothstep(0.0, 0.05, fibre))
    paper = paper * (0.9 + 0.2 * (fractal_noise(u, v, (8, 16), 9, 4) - 0.5))
    light = paper * (1 - 0.62 * bamboo(u, v))
    colour = light[..., None] ** [1, 1.3, 1.8] * [1.0, 0.70, 0.36]
    save("lantern.png", np.maximum(colour, 0) ** (1 / 2.2), 2)


def window():
    """What a window shows: bright clouds above hazy trees, behind bars."""
    u, v = grid(192, 256)
    cloud = fractal_noise(u, v, (3, 4), 15, 5)
    sky = mix(np.array([0.62, 0.76, 1.0]), [1, 0.98, 0.95], smoothstep(0.35, 0.65, cloud)[..., None])
    sky = sky * (0.75 + 0.25 * v[..., None])
    tops = 0.30 + 0.14 * (fractal_noise(u, v * 0, (6, 1), 25, 5) - 0.5)
    trees = 1 - smoothstep(-0.02, 0.03, v - tops)
    view = mix(sky, [0.10, 0.13, 0.10], (0.9 * trees)[..., None])
    s, t = u * 2 % 1, v * 3 % 1
    pane = smoothstep(0.045, 0.065, np.minimum(s, 1 - s)) * smoothstep(0.045, 0.065, np.minimum(t, 1 - t))
    save("window.png", np.maximum(view * pane[..., None], 0.0) ** (1 / 2.2), 4)


if __name__ == "__main__":
    FOLDER.mkdir(exist_ok=True)
    for make in (wood, tiles, cloth, jug, copper, silver, peel, cut_lemon, leaf, lantern, window):
        make()
