"""4x4 matrices of column vectors, as lists of rows, and quaternions [x, y, z, w], as glTF has them."""

import math

IDENTITY = [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]]


def product(*matrices):
    """The product of matrices, of which the last is applied first."""
    result = IDENTITY
    for matrix in matrices:
        result = [[sum(row[k] * matrix[k][j] for k in range(4)) for j in range(4)] for row in result]
    return result


def translation(x, y, z=0):
    return [[1, 0, 0, x], [0, 1, 0, y], [0, 0, 1, z], [0, 0, 0, 1]]


def scaling(x, y, z=1):
    return [[x, 0, 0, 0], [0, y, 0, 0], [0, 0, z, 0], [0, 0, 0, 1]]


def unit(vector):
    length = math.sqrt(sum(c * c for c in vector))
    return [c / length for c in vector]


def turn(axis, degrees):
    """The quaternion of a turn about an axis, counter-clockwise when it points at the viewer."""
    half = math.radians(degrees) / 2
    return [c * math.sin(half) for c in unit(axis)] + [math.cos(half)]


def rotation(quaternion):
    """The matrix of a unit quaternion."""
    x, y, z, w = quaternion
    return [
        [1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w), 0],
        [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w), 0],
        [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y), 0],
        [0, 0, 0, 1],
    ]


def transform(translate=(0, 0, 0), rotate=(0, 0, 0, 1), scale=(1, 1, 1)):
    """The matrix of a node's translation, rotation and scale."""
    return product(translation(*translate), rotation(rotate), scaling(*scale))


def towards(direction):
    """The quaternion that turns -Z, along which lights and cameras look, into a direction, by the shortest way."""
    x, y, z = unit(direction)
    if z > 0.999999:
        return [0, 1, 0, 0]
    return unit([y, -x, 0, 1 - z])


def point(matrix, p):
    return tuple(sum(row[k] * p[k] for k in range(3)) + row[3] for row in matrix[:3])


def direction(matrix, d):
    return tuple(sum(row[k] * d[k] for k in range(3)) for row in matrix[:3])


def inverse(matrix):
    """The inverse, by Gauss and Jordan."""
    rows = [list(map(float, row)) + [float(i == j) for j in range(4)] for i, row in enumerate(matrix)]
    for i in range(4):
        best = max(range(i, 4), key=lambda r: abs(rows[r][i]))
        rows[i], rows[best] = rows[best], rows[i]
        rows[i] = [v / rows[i][i] for v in rows[i]]
        for j in range(4):
            if j != i:
                rows[j] = [a - rows[j][i] * b for a, b in zip(rows[j], rows[i])]
    return [row[4:] for row in rows]


def column_major(matrix):
    """The sixteen numbers of glTF."""
    return [matrix[row][column] for column in range(4) for row in range(4)]


def normal(matrix, n):
    """A normal under a matrix: by the transposed inverse, of length 1, and on the same side of the surface."""
    inverted = inverse(matrix)
    return tuple(unit([sum(inverted[k][i] * n[k] for k in range(3)) for i in range(3)]))
