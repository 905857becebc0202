# SPDX-License-Identifier: GPL-3.0-or-later
"""The points of a mesh that the texels of an image stand for, where a texture is computed in space. Each triangle has half a
square of texels, the larger the triangle the more of them."""
import numpy

_SMALLEST = 8  # Texels along the edge of a square.
_SIDES = (512, 1024, 2048)  # Texels along the edge of the image.
_EDGE = 4  # Texels of a square's edge that are beyond the triangles: what bilinear look-ups touch of one is its own.


class TooManyTriangles(Exception):
    pass


def _squares(areas, least):
    """The side of the image [texels], at least this; the order of the triangles by their squares, two in each; and the
    squares' edges, the larger ones first: powers of two."""
    order = numpy.argsort(-areas, kind="stable")
    lengths = numpy.sqrt(2 * areas[order][::2])
    side = next((side for side in _SIDES if side >= least and len(lengths) * _SMALLEST ** 2 <= side * side), None)
    if side is None:
        raise TooManyTriangles
    scale = 2 * side / max(lengths[0], 1e-30)
    while True:
        edges = 2 ** numpy.floor(numpy.log2(numpy.clip(lengths * scale + _EDGE, _SMALLEST, side))).astype(int)
        if (edges ** 2).sum() <= side * side:
            return side, order, edges
        scale *= 0.8


def _deinterleaved(numbers):
    """The even bits of numbers below 2^24."""
    return sum((numbers >> 2 * bit & 1) << bit for bit in range(12))


class Surface:
    """Texels and triangles. `uvs`: (triangles, 3, 2), where in the image each triangle is."""

    def __init__(self, positions, least):
        """positions: (triangles, 3, 3), of the corners; least: how many texels the image's side has at least."""
        edges = positions[:, 1:] - positions[:, :1]
        areas = 0.5 * numpy.linalg.norm(numpy.cross(edges[:, 0], edges[:, 1]), axis=-1)
        self.side, order, sizes = _squares(areas, least)
        # Squares of falling sizes, one behind the other along Morton's curve, leave no gap.
        starts = numpy.concatenate([[0], numpy.cumsum(sizes ** 2)[:-1]])
        lows = numpy.stack([_deinterleaved(starts), _deinterleaved(starts >> 1)], -1)
        self.uvs = numpy.zeros((len(positions), 3, 2), numpy.float32)
        self._triangle = numpy.zeros((self.side, self.side), numpy.int32)
        self._weights = numpy.zeros((self.side, self.side, 3), numpy.float32)
        self._weights[..., 0] = 1
        for size in numpy.unique(sizes):
            self._fill(int(size), lows[sizes == size], order, numpy.flatnonzero(sizes == size))

    def _fill(self, size, lows, order, squares):
        leg = size - _EDGE
        grid = numpy.arange(size) + 0.5
        x, y = numpy.meshgrid(grid, grid)
        for half in (0, 1):
            present = 2 * squares + half < len(order)
            triangles, low = order[2 * squares[present] + half], lows[present]
            corners = numpy.array([(1, 1), (1 + leg, 1), (1, 1 + leg)])
            inside = x + y < size
            u, v = (x - 1) / leg, (y - 1) / leg
            if half == 1:
                corners, inside = size - corners, ~inside
                u, v = (size - 1 - x) / leg, (size - 1 - y) / leg
            self.uvs[triangles] = (low[:, None] + corners) / self.side
            ys, xs = numpy.nonzero(inside)
            rows, columns = low[:, 1:] + ys, low[:, :1] + xs
            self._triangle[rows, columns] = triangles[:, None]
            self._weights[rows, columns] = numpy.stack([1 - u - v, u, v], -1)[inside]

    def of(self, corners):
        """(side, side, N), rows from the top: what values at the corners [(triangles, 3, N)] are at the texels."""
        values = sum(corners[self._triangle, i] * self._weights[..., i, None] for i in range(3))
        return values[::-1].astype(numpy.float32)


class Points:
    """What is known at the texels of a Surface: (side, side, 3) each, linear colours (side, side, 4)."""

    def __init__(self, least, positions, normals, colors, uvs, uv_of_render, center, half):
        """least: as of a Surface. positions, normals: (triangles, 3, 3), colors: (triangles, 3, 4) or None, of the corners.
        uvs: a function that gives (triangles, 3, 2) or None for a name. uv_of_render: that of the coordinates that are used
        where none are named, or None. center, half: of the box that Generated coordinates go by."""
        self._surface = Surface(positions, least)
        self._positions = positions
        self._normals = normals
        self._colors = colors
        self._uvs = uvs
        self._uv_of_render = uv_of_render
        self._center = center
        self._half = half

    @property
    def side(self):
        return self._surface.side

    @property
    def uvs(self):
        """(triangles, 3, 2): where in the image each triangle is."""
        return self._surface.uvs

    @property
    def object(self):
        return self._surface.of(self._positions)

    @property
    def generated(self):
        """From 0 to 1 in the box."""
        return (self.object - self._center) * numpy.divide(0.5, self._half, out=numpy.zeros(3), where=self._half != 0) + 0.5

    @property
    def normal(self):
        n = self._surface.of(self._normals)
        return n / numpy.maximum(numpy.linalg.norm(n, axis=-1, keepdims=True), 1e-30)

    @property
    def colors(self):
        """None without any."""
        return None if self._colors is None else self._surface.of(self._colors)

    def uv(self, name=None):
        """Texture coordinates, of which the third is 0; all are 0 where there are none of this name."""
        found = self._uvs(name or self._uv_of_render) if name or self._uv_of_render else None
        if found is None:
            return numpy.zeros((self.side, self.side, 3), numpy.float32)
        values = self._surface.of(found)
        return numpy.concatenate([values, numpy.zeros_like(values[..., :1])], -1)
