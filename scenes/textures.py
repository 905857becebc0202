"""What scripts that make textures share: noise that repeats at the edges, normals of heights, PNG files.

Needs NumPy (Debian: python3-numpy).
"""

import struct
import zlib

import numpy as np


def grid(width, height):
    """u and v of the centres of pixels, from the lower left corner, in rows from the top."""
    u = (np.arange(width) + 0.5) / width
    v = 1 - (np.arange(height) + 0.5) / height
    return np.meshgrid(u, v)


def smoothstep(low, high, x):
    t = np.clip((x - low) / (high - low), 0, 1)
    return t * t * (3 - 2 * t)


def value_noise(u, v, cells, seed):
    """Noise from 0 to 1 of period 1 in u and v, with cells = (along u, along v) random values."""
    lattice = np.random.RandomState(seed).random_sample((cells[1], cells[0]))
    x, y = u * cells[0], v * cells[1]
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    s, t = x - i, y - j
    s, t = s**3 * (s * (6 * s - 15) + 10), t**3 * (t * (6 * t - 15) + 10)

    def at(di, dj):
        return lattice[(j + dj) % cells[1], (i + di) % cells[0]]

    low = at(0, 0) + s * (at(1, 0) - at(0, 0))
    high = at(0, 1) + s * (at(1, 1) - at(0, 1))
    return low + t * (high - low)


def fractal_noise(u, v, cells, seed, octaves=4):
    """Octaves of noise, each of twice the frequency and half the strength; from 0 to 1, 0.5 on average."""
    total, weight = 0.0, 0.0
    for octave in range(octaves):
        scale = 2**octave
        total = total + value_noise(u, v, (cells[0] * scale, cells[1] * scale), seed + octave) / scale
        weight += 1 / scale
    return total / weight


def cells_noise(u, v, cells, seed, jitter=0.8):
    """Distances to the nearest and the second nearest of one random point per cell, in cells, and the nearest's cell.

    Ref: Worley 1996, A Cellular Texture Basis Function.
    """
    random = np.random.RandomState(seed)
    offsets = 0.5 + jitter * (random.random_sample((2, cells[1], cells[0])) - 0.5)
    x, y = u * cells[0], v * cells[1]
    i, j = np.floor(x).astype(int), np.floor(y).astype(int)
    first, second = np.full(x.shape, 9.0), np.full(x.shape, 9.0)
    nearest = np.zeros(x.shape, dtype=int)
    for dj in (-1, 0, 1):
        for di in (-1, 0, 1):
            ci, cj = (i + di) % cells[0], (j + dj) % cells[1]
            distance = np.hypot(i + di + offsets[0, cj, ci] - x, j + dj + offsets[1, cj, ci] - y)
            nearest = np.where(distance < first, cj * cells[0] + ci, nearest)
            second = np.minimum(second, np.maximum(first, distance))
            first = np.minimum(first, distance)
    return first, second, nearest


def normals(height, size):
    """The normal map of heights [m] that repeat over size = (width, height) [m]; the blue is that of unit normals."""
    rows, columns = height.shape
    du = (np.roll(height, -1, 1) - np.roll(height, 1, 1)) * columns / (2 * size[0])
    dv = (np.roll(height, 1, 0) - np.roll(height, -1, 0)) * rows / (2 * size[1])
    n = np.stack([-du, -dv, np.ones_like(du)], axis=-1)
    return 0.5 + 0.5 * n / np.linalg.norm(n, axis=-1, keepdims=True)


def ramp(t, stops):
    """Colours of t in 0 to 1 between stops (t, (r, g, b))."""
    places = [stop[0] for stop in stops]
    return np.stack([np.interp(t, places, [stop[1][c] for stop in stops]) for c in range(3)], axis=-1)


def mix(a, b, t):
    """Colours at t from 0 to 1 between a and b; t has an axis for the channels."""
    return a + t * (np.asarray(b) - a)


def chunk(kind, data):
    """A chunk of a PNG file."""
    body = kind + data
    return struct.pack(">I", len(data)) + body + struct.pack(">I", zlib.crc32(body))


def filtered(pixels):
    """The rows of bytes, each by the one of PNG's filters whose differences are smallest."""
    rows = pixels.reshape(pixels.shape[0], -1).astype(np.int16)
    step = pixels.shape[2]
    above = np.vstack([np.zeros_like(rows[:1]), rows[:-1]])
    left, corner = np.zeros_like(rows), np.zeros_like(rows)
    left[:, step:], corner[:, step:] = rows[:, :-step], above[:, :-step]
    guess = left + above - corner
    errors = [abs(guess - near) for near in (left, above, corner)]
    not_left = np.where(errors[1] <= errors[2], above, corner)
    paeth = np.where((errors[0] <= errors[1]) & (errors[0] <= errors[2]), left, not_left)
    choices = np.stack([(rows - guess) % 256 for guess in (0, left, above, (left + above) // 2, paeth)])
    cost = np.where(choices < 128, choices, 256 - choices).sum(axis=2)
    best = cost.argmin(axis=0)
    return b"".join(bytes([k]) + choices[k, row].astype(np.uint8).tobytes() for row, k in enumerate(best))


def write_png(path, image, step=1):
    """Writes numbers from 0 to 1 as 8 bits: rows of pixels from the top, of 1, 3 or 4 channels.

    Values that do not need precision use less space in steps of more than 1 code.
    """
    codes = np.round(np.clip(image, 0, 1) * 255 / step) * step
    pixels = np.minimum(codes, 255).astype(np.uint8)
    pixels = pixels[..., None] if pixels.ndim == 2 else pixels
    colour_type = {1: 0, 3: 2, 4: 6}[pixels.shape[2]]
    header = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, colour_type, 0, 0, 0)
    data = chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(filtered(pixels), 9)) + chunk(b"IEND", b"")
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + data)


def write_ramp(path, t, stops):
    """Writes colours between stops as PNG with a palette of 64: one byte for a pixel."""
    levels = 64
    palette = np.round(255 * np.clip(ramp(np.arange(levels) / (levels - 1), stops), 0, 1)).astype(np.uint8)
    pixels = np.round(np.clip(t, 0, 1) * (levels - 1)).astype(np.uint8)[..., None]
    header = struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 3, 0, 0, 0)
    data = chunk(b"IHDR", header) + chunk(b"PLTE", palette.tobytes())
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    path.write_bytes(b"\x89PNG\r\n\x1a\n" + data + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))
