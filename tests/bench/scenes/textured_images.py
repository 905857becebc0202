"""Patterns of make_textured.py: arrays of n x n texels that repeat without a seam, and the PNG files made of them.

A pattern returns its height and its tint, from 0 to 1 each. Rows run from the top, as in files.
"""

import struct
import zlib

import numpy as np

KINDS = {1: 0, 3: 2, 4: 6}  # PNG's colour types, by the number of channels.


def chunk(name, data):
    return struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))


def write_png(path, image):
    """Bytes of the shape height x width x channels."""
    height, width, channels = image.shape
    rows = np.zeros((height, 1 + width * channels), np.uint8)  # The first byte of a row: no filter.
    rows[:, 1:] = image.reshape(height, -1)
    header = struct.pack(">IIBBBBB", width, height, 8, KINDS[channels], 0, 0, 0)
    data = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows.tobytes(), 1)) + chunk(b"IEND", b"")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + data)


def codes(values):
    return np.clip(np.rint(255 * values), 0, 255).astype(np.uint8)


def colors(tint, palette):
    """sRGB between the palette's colours, which lie at even distances."""
    stops = np.linspace(0, 1, len(palette))
    return np.stack([codes(np.interp(tint, stops, [color[i] / 255 for color in palette])) for i in range(3)], -1)


def numbers(tint, low, high):
    return codes(low + (high - low) * tint)[..., None]


def normals(height, depth):
    """A normal map of that height times `depth`, in widths of the image."""
    slope = 0.5 * depth * len(height)
    x = slope * (np.roll(height, 1, 1) - np.roll(height, -1, 1))
    y = slope * (np.roll(height, -1, 0) - np.roll(height, 1, 0))
    n = np.stack([x, y, np.ones_like(x)], -1)
    return codes(0.5 + 0.5 * n / np.linalg.norm(n, axis=-1, keepdims=True))


def grid(n):
    """u to the right and v upwards at the centres of texels."""
    at = ((np.arange(n) + 0.5) / n).astype(np.float32)
    return at[None, :], at[::-1, None]


def smooth(low, high, x):
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def noise(n, seed, low, high, fall=1.0, stretch=1.0):
    """Noise between the frequencies low and high [per image], whose amplitudes fall with the power `fall`; stretched
    along u. Mean 0, deviation 1."""
    white = np.fft.rfft2(np.random.default_rng(seed).standard_normal((n, n), np.float32))
    f = np.hypot(np.fft.rfftfreq(n, 1 / n)[None, :] * stretch, np.fft.fftfreq(n, 1 / n)[:, None])
    white *= np.where((f >= low) & (f <= high), np.maximum(f, 1) ** -fall, 0)
    values = np.fft.irfft2(white, (n, n)).astype(np.float32)
    return values / values.std()


def tiles(n, seed, columns, rows, shift, gap):
    """Which tile a texel belongs to as a random number, and 0 in the gaps between tiles to 1 inside."""
    u, v = grid(n)
    row = np.floor(v * rows).astype(int)
    x = u * columns + shift * row
    chance = np.random.default_rng(seed).random((rows, columns), np.float32)
    x_edge = 0.5 - np.abs(x % 1 - 0.5)
    y_edge = 0.5 - np.abs(v * rows % 1 - 0.5)
    distance = np.minimum(x_edge / columns, y_edge / rows)
    return chance[row, np.floor(x).astype(int) % columns], smooth(0.3 * gap, gap, distance)


def planks(n, seed, rows=8, columns=2):
    which, inside = tiles(n, seed, columns, rows, 0.37, 0.0015)
    _, v = grid(n)
    rings = 0.5 + 0.5 * np.sin(2 * np.pi * (3 * rows * v + 9 * which + 0.7 * noise(n, seed, 1, 200, 1.4, 12)))
    grain = noise(n, seed + 1, 30, n / 3, 0.3, 40)
    tint = inside * np.clip(0.25 + 0.35 * rings + 0.4 * which + 0.06 * grain, 0.08, 1)
    return 0.7 * inside + 0.2 * rings * inside + 0.03 * grain, tint


def bricks(n, seed, columns=8, rows=16):
    which, inside = tiles(n, seed, columns, rows, 0.5, 0.008)
    rough = noise(n, seed, 8, n / 4, 1.0)
    tint = np.where(inside > 0.5, np.clip(0.35 + 0.5 * which + 0.07 * rough, 0.25, 1), 0.1 + 0.02 * rough)
    return 0.8 * inside + 0.05 * rough, tint


def weave(n, seed, threads=48, bands=6):
    u, v = grid(n)
    over = (np.floor(u * threads) + np.floor(v * threads)) % 2 > 0
    across, along = (np.abs(np.sin(np.pi * threads * at)) for at in (u, v))
    height = np.where(over, across * (0.5 + 0.5 * along), along * (0.5 + 0.5 * across))
    stripe = np.where(over, np.floor(u * bands) % 2, np.floor(v * bands) % 2)
    return height, np.clip(0.15 + 0.6 * stripe + 0.2 * height + 0.05 * noise(n, seed, 4, n / 4, 0.5), 0, 1)


def marble(n, seed):
    u, v = grid(n)
    turbulence = noise(n, seed, 1, n / 4, 2.2)
    veins = np.abs(np.sin(np.pi * (2 * u + 3 * v + 0.8 * turbulence)))
    return turbulence, np.clip(veins**0.6 + 0.04 * noise(n, seed + 1, 2, n / 3, 0.8), 0, 1)


def plaster(n, seed):
    height = noise(n, seed, 3, n / 4, 1.2)
    return 0.5 + 0.2 * height, np.clip(0.6 + 0.15 * noise(n, seed + 1, 1, 60, 1.5) + 0.08 * height, 0, 1)


def brushed(n, seed):
    lines = noise(n, seed, 20, n / 3, 0.4, 60)
    return 0.5 + 0.2 * lines, np.clip(0.5 + 0.2 * lines + 0.15 * noise(n, seed + 1, 1, 12), 0, 1)


def hammered(n, seed):
    dents = np.minimum(np.abs(noise(n, seed, 10, 18, 0)), 2) / 2
    return dents, np.clip(0.25 + 0.6 * dents + 0.05 * noise(n, seed + 1, 4, n / 4), 0, 1)


def spots(n, seed):
    inside = smooth(0.4, 0.6, noise(n, seed, 6, 14, 0))
    return inside, np.clip(0.15 + 0.65 * inside + 0.06 * noise(n, seed + 1, 4, n / 4), 0, 1)


def stripes(n, seed, count=12):
    _, v = grid(n)
    wave = 0.5 + 0.5 * np.sin(2 * np.pi * (count * v + 0.15 * noise(n, seed, 2, 20)))
    return wave, np.clip(smooth(0.35, 0.65, wave) * 0.7 + 0.15 + 0.05 * noise(n, seed + 1, 8, n / 4, 0.6), 0, 1)


def mosaic(n, seed):
    which, inside = tiles(n, seed, 24, 24, 0.5, 0.003)
    return inside, inside * (0.2 + 0.8 * which)


def leaf(n, seed, lobes):
    """A leaf that points upwards: height, tint, and opacity, which is cut between the lobes."""
    u, v = grid(n)
    x = np.abs(u - 0.5)
    teeth = 0.012 * np.abs(np.sin(40 * np.pi * v))
    width = 0.46 * np.sin(np.pi * np.clip(v, 0, 1) ** 0.8) ** 0.8 - teeth
    ribs = (v * 1.2 - x * 0.9) * 9
    cut = smooth(0.5, 0.8, x / np.maximum(width, 0.02)) * smooth(0.2, 0.7, np.cos(2 * np.pi * ribs)) * lobes
    opacity = smooth(-0.006, 0.006, width - 0.25 * cut - x)
    opacity = np.maximum(opacity, smooth(0.014, 0.008, x) * (v < 0.5))  # The stalk.
    veins = np.maximum(smooth(0.012, 0.003, x), 0.7 * smooth(0.85, 0.98, -np.cos(2 * np.pi * ribs)))
    tint = np.clip(0.4 + 0.12 * noise(n, seed, 2, n / 4, 1.1) + 0.4 * veins, 0, 1)
    return 0.5 - 0.4 * veins, tint, opacity
