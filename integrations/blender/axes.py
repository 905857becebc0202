# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's space, with +Z up, and candela's, with +Y up."""
import numpy

# From Blender's world space to candela's, for columns: x stays, z becomes y, and y becomes -z.
TO_CANDELA = numpy.array([[1, 0, 0, 0], [0, 0, 1, 0], [0, -1, 0, 0], [0, 0, 0, 1]], numpy.float64)


def placed(matrix):
    """(4, 4): from the space of an object, which has this matrix_world, to candela's world."""
    return TO_CANDELA @ numpy.array(matrix, numpy.float64)


def to_candela(vector):
    """(3,): the point or direction in candela's world."""
    x, y, z = (float(coordinate) for coordinate in vector)
    return [x, z, -y]


def to_blender(vectors):
    """(..., 3): directions or points of candela's world in Blender's."""
    return numpy.stack([vectors[..., 0], -vectors[..., 2], vectors[..., 1]], -1)
