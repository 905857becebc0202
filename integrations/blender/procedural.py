# SPDX-License-Identifier: GPL-3.0-or-later
"""Procedural textures, with the values that Cycles has for them. A point is an array of shape (..., 3), a texture's value
one of shape (...), from 0 to 1 unless a function says otherwise."""
import collections
import functools
import hashlib
import threading

import numpy

_WORD = numpy.uint32

_KEPT = 256 << 20  # Bytes of results.
_results = collections.OrderedDict()  # Arrays, or tuples of them; the one that was used last is at the end.
_lock = threading.Lock()  # A viewport may read while another thread renders.


def _bytes(result):
    return sum(array.nbytes for array in (result if isinstance(result, tuple) else (result,)))


def _remembered(function):
    """Keeps what a texture was at the same points: each frame of an animation asks for it again. The function's first
    argument is a list of coordinates, the others can be hashed."""
    @functools.wraps(function)
    def known(coordinates, *settings):
        key = (function, settings, *((x.shape, hashlib.blake2b(numpy.ascontiguousarray(x)).digest()) for x in coordinates))
        with _lock:
            found = _results.pop(key, None)
        if found is None:
            found = function(coordinates, *settings)
        with _lock:
            _results[key] = found
            while len(_results) > 1 and sum(_bytes(result) for result in _results.values()) > _KEPT:
                _results.popitem(last=False)
        return found
    return known


def _turned(x, bits):
    return (x << _WORD(bits)) | (x >> _WORD(32 - bits))


def _hash(*words):
    """Jenkins' hash (lookup3, 2006) of one to four words: arrays of uint32."""
    start = _WORD(0xDEADBEEF + (len(words) << 2) + 13)
    none = numpy.zeros_like(words[0])
    a, b, c = (word + start for word in (*words, none, none)[:3])
    if len(words) == 4:
        for bits in (4, 6, 8, 16, 19, 4):
            a, c, b = b, (a - c) ^ _turned(c, bits), c + b
        a = a + words[3]
    for bits in (14, 11, 25, 16, 4, 14, 24):
        a, b, c = b, (c ^ b) - _turned(b, bits), a
    return b


def _random(*numbers):
    """From 0 to 1, by the bits of one to three numbers."""
    return _hash(*(numpy.asarray(number, numpy.float32).view(_WORD) for number in numbers)) / numpy.float32(0xFFFFFFFF)


def _slope(word, *offsets):
    """The scalar product of an offset [1 to 3 coordinates] and the gradient that a hash chooses."""
    if len(offsets) == 1:
        low = word & _WORD(15)
        size = (1 + (low & _WORD(7))).astype(numpy.float32)
        return numpy.where(low & _WORD(8), -size, size) * offsets[0]
    if len(offsets) == 2:
        low = word & _WORD(7)
        u, v = (numpy.where(low < 4, *pair) for pair in (offsets, offsets[::-1]))
        v = 2 * v
    else:
        low = word & _WORD(15)
        x, y, z = offsets
        u = numpy.where(low < 8, x, y)
        v = numpy.where(low < 4, y, numpy.where((low == 12) | (low == 14), x, z))
    return numpy.where(low & _WORD(1), -u, u) + numpy.where(low & _WORD(2), -v, v)


# What brings Perlin's noise of so many dimensions to the range from -1 to 1.
_PERLIN_SCALE = {1: 0.25, 2: 0.6616, 3: 0.982}


def perlin(*coordinates):
    """Perlin's noise (Improving Noise, 2002) from -1 to 1, of one to three coordinates."""
    cells = [numpy.floor(x) for x in coordinates]
    offsets = [x - cell for x, cell in zip(coordinates, cells)]
    words = [cell.astype(numpy.int64).astype(_WORD) for cell in cells]
    corners = [((), ())]
    for word, offset in zip(words, offsets):
        corners = [((*w, word + _WORD(i)), (*o, offset - i)) for i in (0, 1) for w, o in corners]
    values = [_slope(_hash(*w), *o) for w, o in corners]
    for offset in offsets:
        t = offset * offset * offset * (offset * (offset * 6 - 15) + 10)
        values = [a + t * (b - a) for a, b in zip(values[::2], values[1::2])]
    return _PERLIN_SCALE[len(coordinates)] * values[0]


def _split(point):
    return point[..., 0], point[..., 1], point[..., 2]


def fractal(coordinates, detail, roughness, lacunarity, normalize):
    """Octaves of Perlin's noise: `detail` more than one, each `lacunarity` times as fine and `roughness` times as strong.
    From 0 to 1 if it is normalized, else around 0."""
    def level(total, strength):
        return total * (0.5 / strength) + 0.5 if normalize else total

    total, strength, scale, amplitude = 0.0, 0.0, 1.0, 1.0
    for _ in range(int(detail) + 1):
        total = total + perlin(*(x * numpy.float32(scale) for x in coordinates)) * numpy.float32(amplitude)
        strength += amplitude
        amplitude *= roughness
        scale *= lacunarity
    share = detail - int(detail)
    if share == 0:
        return level(total, strength)
    more = total + perlin(*(x * numpy.float32(scale) for x in coordinates)) * numpy.float32(amplitude)
    return level(total, strength) * (1 - share) + level(more, strength + amplitude) * share


def _shift(seed, count):
    """Where another noise of so many dimensions is read."""
    if count == 1:
        return [100 + 100 * _random(numpy.full(1, seed))]
    return [100 + 100 * _random(numpy.full(1, seed), numpy.full(1, i)) for i in range(count)]


@_remembered
def noise(coordinates, detail, roughness, lacunarity, distortion, normalize, is_color=False):
    """Of one to three coordinates. is_color: (..., 3), the value and two more, of other places."""
    count = len(coordinates)
    if distortion != 0:
        moves = [perlin(*(x + s for x, s in zip(coordinates, _shift(i, count)))) for i in range(count)]
        coordinates = [x + move * numpy.float32(distortion) for x, move in zip(coordinates, moves)]
    value = fractal(coordinates, detail, roughness, lacunarity, normalize)
    if not is_color:
        return value
    others = [[x + s for x, s in zip(coordinates, _shift(seed, count))] for seed in (count, count + 1)]
    return numpy.stack([value, *(fractal(at, detail, roughness, lacunarity, normalize) for at in others)], -1)


def _into_cells(point):
    """Off the borders of cells, on which rounding would decide."""
    return (point + numpy.float32(1e-6)) * numpy.float32(0.999999)


def checker(point):
    """1 and 0 in cubes of size 1."""
    return (numpy.floor(_into_cells(point)).sum(-1) % 2 == 1).astype(numpy.float32)


def gradient(point, kind):
    """kind: as Blender names it."""
    x, y, _ = _split(point)
    if kind == "LINEAR":
        value = x
    elif kind == "QUADRATIC":
        value = numpy.maximum(x, 0) ** 2
    elif kind == "EASING":
        t = numpy.clip(x, 0, 1)
        value = t * t * (3 - 2 * t)
    elif kind == "DIAGONAL":
        value = (x + y) / 2
    elif kind == "RADIAL":
        value = numpy.arctan2(y, x) / (2 * numpy.pi) + 0.5
    else:
        value = numpy.maximum(0.999999 - numpy.sqrt((point * point).sum(-1)), 0)
        if kind == "QUADRATIC_SPHERE":
            value = value ** 2
    return numpy.clip(value, 0, 1)


_MAGIC = (("y", numpy.cos, -1, (1, -1, 1)), ("x", numpy.cos, 1, (1, -1, -1)), ("z", numpy.sin, 1, (-1, -1, -1)),
          ("x", numpy.cos, -1, (-1, 1, -1)), ("y", numpy.sin, -1, (-1, 1, 1)), ("y", numpy.cos, -1, (-1, 1, 1)),
          ("x", numpy.cos, 1, (1, 1, 1)), ("z", numpy.sin, 1, (1, 1, -1)), ("x", numpy.cos, -1, (-1, -1, 1)),
          ("y", numpy.sin, -1, (1, -1, 1)))


def magic(point, depth, distortion):
    """(..., 3)"""
    px, py, pz = _split(point)
    v = {"x": numpy.sin((px + py + pz) * 5), "y": numpy.cos((py - px - pz) * 5), "z": -numpy.cos((pz - px - py) * 5)}
    if depth > 0:
        v = {name: value * distortion for name, value in v.items()}
    for name, function, sign, (a, b, c) in _MAGIC[:depth]:
        v[name] = sign * function(a * v["x"] + b * v["y"] + c * v["z"]) * distortion
    scale = 2 * distortion if distortion != 0 else 1
    return 0.5 - numpy.stack([v["x"], v["y"], v["z"]], -1) / scale


def wave(point, kind, direction, profile, phase, distortion, detail, detail_scale, detail_roughness):
    """kind, direction, profile: as Blender names them."""
    point = _into_cells(point)
    x, y, z = _split(point)
    if kind == "BANDS":
        n = {"X": x * 20, "Y": y * 20, "Z": z * 20, "DIAGONAL": (x + y + z) * 10}[direction]
    else:
        kept = {"X": (0, 1, 1), "Y": (1, 0, 1), "Z": (1, 1, 0), "SPHERICAL": (1, 1, 1)}[direction]
        n = numpy.sqrt((point * point * numpy.array(kept, numpy.float32)).sum(-1)) * 20
    n = n + phase
    if distortion != 0:
        at = [c * numpy.float32(detail_scale) for c in (x, y, z)]
        n = n + distortion * (2 * fractal(at, detail, detail_roughness, 2.0, True) - 1)
    if profile == "SIN":
        return 0.5 + 0.5 * numpy.sin(n - numpy.pi / 2)
    n = n / (2 * numpy.pi)
    return n - numpy.floor(n) if profile == "SAW" else numpy.abs(n - numpy.floor(n + 0.5)) * 2


def _brick_noise(n):
    n = (n + 1013) & 0x7FFFFFFF
    n = (n >> 13) ^ n
    with numpy.errstate(over="ignore"):
        return ((n * (n * n * 60493 + 19990303) + 1376312589) & 0x7FFFFFFF) / numpy.float32(1 << 31)


def brick(point, mortar_size, mortar_smooth, bias, width, height, offset, offset_frequency, squash, squash_frequency):
    """Two values: how much a point is mortar, and which share a brick has of the second colour."""
    x, y, _ = _split(point)
    row = numpy.floor(y / height).astype(numpy.int64)
    widths = numpy.where(row % squash_frequency == 0, width * squash, width)
    moved = x + numpy.where(row % offset_frequency == 0, widths * offset, 0)
    column = numpy.floor(moved / widths).astype(numpy.int64)
    left, low = moved - widths * column, y - height * row
    tint = numpy.clip(_brick_noise((row << 16) + (column & 0xFFFF)) + bias, 0, 1)
    distance = numpy.minimum(numpy.minimum(left, low), numpy.minimum(widths - left, height - low))
    inside = distance < mortar_size
    if mortar_smooth == 0:
        return inside.astype(numpy.float32), tint
    t = numpy.clip((1 - distance / max(mortar_size, 1e-30)) / mortar_smooth, 0, 1)
    return numpy.where(inside, t * t * (3 - 2 * t), 0), tint


def white_noise(*coordinates):
    """Of one to three coordinates."""
    return _random(*coordinates)


def _pcg(*words):
    """PCG's hash of two or three words, arrays of int32 (Jarzynski, Olano, Hash Functions for GPU Rendering, 2020)."""
    factor, count = numpy.int32(1664525), len(words)
    v = [word * factor + numpy.int32(1013904223) for word in words]
    for end in (False, True):
        for i in range(count):
            v[i] = v[i] + (v[1 - i] * factor if count == 2 else v[(i + 1) % 3] * v[(i + 2) % 3])
        if not end:
            v = [word ^ (word >> 16) for word in v]
    return [(word & 0x7FFFFFFF).astype(numpy.float32) / numpy.float32(0x7FFFFFFF) for word in v]


def _random_in_cells(cells, count, by_pcg):
    """`count` numbers from 0 to 1 for each cell: two or three arrays of int32. by_pcg: as since Blender 5.0."""
    if by_pcg:
        return _pcg(*cells) if count == len(cells) else _pcg(*cells, numpy.zeros_like(cells[0]))
    numbers = [cell.astype(numpy.float32) for cell in cells]
    return [_random(*numbers, *([numpy.full_like(numbers[0], i)] if i else [])) for i in range(count)]


_METRICS = {
    "EUCLIDEAN": lambda v, e: numpy.sqrt((v * v).sum(-1)),
    "MANHATTAN": lambda v, e: numpy.abs(v).sum(-1),
    "CHEBYCHEV": lambda v, e: numpy.abs(v).max(-1),
    "MINKOWSKI": lambda v, e: (numpy.abs(v) ** e).sum(-1) ** (1 / e),
}


class _Cells:
    """The cell of each place, and the points of the cells around it."""

    def __init__(self, coordinates, randomness, by_pcg):
        """coordinates: two or three arrays."""
        floors = [numpy.floor(x) for x in coordinates]
        self.cells = [floor.astype(numpy.int32) for floor in floors]
        self._local = numpy.stack([x - floor for x, floor in zip(coordinates, floors)], -1)
        self._randomness = numpy.float32(randomness)
        self._by_pcg = by_pcg

    def around(self):
        """For each cell: its offset, and where its point is from the place, (..., N)."""
        for offset in numpy.ndindex(*[3] * len(self.cells)):
            offset = numpy.array(offset[::-1], numpy.int32) - 1
            cells = [cell + o for cell, o in zip(self.cells, offset)]
            moved = numpy.stack(_random_in_cells(cells, len(cells), self._by_pcg), -1) * self._randomness
            yield offset, offset.astype(numpy.float32) + moved - self._local


@_remembered
def voronoi(coordinates, is_second, metric, exponent, randomness, normalize, by_pcg):
    """The distance to the nearest of the points of Worley's cells, or the second, and (..., 3) random colours of its cell.
    Of two or three coordinates. metric: as Blender names it. by_pcg: as since Blender 5.0."""
    distance = _METRICS[metric]
    cells = _Cells(coordinates, randomness, by_pcg)
    shape = coordinates[0].shape
    nearest = [(numpy.full(shape, numpy.inf, numpy.float32), numpy.zeros((*shape, len(coordinates)), numpy.int32))] * 2
    for offset, way in cells.around():
        found = distance(way, exponent)
        (first, at_first), (second, at_second) = nearest
        is_first, is_next = found < first, found < second
        second = numpy.where(is_first, first, numpy.where(is_next, found, second))
        at_second = numpy.where(is_first[..., None], at_first, numpy.where(is_next[..., None], offset, at_second))
        nearest = [(numpy.where(is_first, found, first), numpy.where(is_first[..., None], offset, at_first)),
                   (second, at_second)]
    value, at = nearest[is_second]
    colors = _random_in_cells([cell + at[..., i] for i, cell in enumerate(cells.cells)], 3, by_pcg)
    if normalize:
        longest = distance(numpy.full(len(coordinates), 0.5 + 0.5 * randomness), exponent)
        value = value / (longest * (2 if is_second else 1))
    return value, numpy.stack(colors, -1)


@_remembered
def voronoi_edge(coordinates, randomness, normalize, by_pcg):
    """The distance to the nearest edge between Worley's cells."""
    cells = _Cells(coordinates, randomness, by_pcg)
    nearest = numpy.full((*coordinates[0].shape, len(coordinates)), 1e9, numpy.float32)
    for _, way in cells.around():
        nearest = numpy.where(((way * way).sum(-1) < (nearest * nearest).sum(-1))[..., None], way, nearest)
    edge = numpy.full(coordinates[0].shape, numpy.inf, numpy.float32)
    for _, way in cells.around():
        across = way - nearest
        length = numpy.sqrt((across * across).sum(-1))
        found = ((nearest + way) * across).sum(-1) / (2 * numpy.maximum(length, 1e-30))
        edge = numpy.where((length > 0.01) & (found < edge), found, edge)
    return edge / (0.5 + 0.5 * randomness) if normalize else edge
