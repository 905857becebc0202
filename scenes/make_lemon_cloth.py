#!/usr/bin/env python3
"""Makes the cloth of lemons.json: `python3 make_lemon_cloth.py` writes lemons/cloth.ply, in half a minute.

Linen falls on the table, is pushed together into folds, springs back, and hangs over the front edge, while the bowl and
a lemon hold it down. With one NumPy (Debian: python3-numpy) and processor, the file is the same each time.
Ref: Mueller et al. 2007, Position Based Dynamics.
"""

import numpy as np

from make_lemon_meshes import BOWL, FRONT, grid_faces, metres, unit, write_ply

WIDTH, LENGTH, SPACING = 0.30, 0.36, 0.005  # Across and along the cloth [m].
CENTER, TURN = (0.088, 0.14), 0.34  # x and z of its middle, and its rotation about +y [rad].
THICKNESS = 0.0018  # How far its points stay from things.
EDGE = 0.004  # Radius of the table's front edge.
STEPS, ITERATIONS, STEP = 360, 14, 1 / 150
PUSHED = 0.68  # The share of its width that is left.
GRAVITY = 3.0  # [m/s^2]: less than on earth, for cloth that does not stretch in as few iterations.
FRICTION = 0.3
BOWL_PLACE = (0.10, 0.0)  # x and z.
LEMON_PLACE, LEMON_RADIUS = (0.165, 0.165), 0.0325


# Steps between points that keep their distance, and how stiffly: threads, shear, bending.
PAIRS = [((1, 0), 1.0), ((0, 1), 1.0), ((1, 1), 0.5), ((1, -1), 0.5), ((2, 0), 0.12), ((0, 2), 0.12)]


def constraints(shape):
    """Pairs of grid points, their distance and stiffness, as groups in which no point occurs twice."""
    groups = []
    for (di, dj), stiffness in PAIRS:
        i = np.arange(shape[0] - di)
        j = np.arange(max(0, -dj), shape[1] - max(0, dj))
        span = di or dj
        for parity in range(2 * span):
            rows, columns = (i[i % (2 * span) == parity], j) if di else (i, j[j % (2 * span) == parity])
            pair = np.ix_(rows, columns), np.ix_(rows + di, columns + dj)
            groups.append((*pair, SPACING * np.hypot(di, dj), stiffness))
    return groups


def satisfy(points, groups):
    """Moves points towards the distances that they keep."""
    for a, b, rest, stiffness in groups:
        difference = points[b] - points[a]
        length = np.linalg.norm(difference, axis=-1, keepdims=True)
        move = (0.5 * stiffness) * (1 - rest / np.maximum(length, 1e-9)) * difference
        points[a] += move
        points[b] -= move


def bowl_underside():
    """Radii from the bowl's axis, increasing, and how high its outside is there."""
    profile = np.array(metres(BOWL)[2:11])
    return profile[:, 0], profile[:, 1]


def leave_table(points):
    """Moves points out of the table, a box whose front edge is rounded, and says which."""
    y, z = points[..., 1], points[..., 2]
    beyond, above, reach = z - (FRONT - EDGE), y + EDGE, EDGE + THICKNESS
    flat = (beyond <= 0) & (y < THICKNESS)
    y[flat] = THICKNESS
    front = (above <= 0) & (beyond > 0) & (beyond < reach)
    z[front] = FRONT + THICKNESS
    distance = np.hypot(beyond, above)
    edge = (beyond > 0) & (above > 0) & (distance < reach)
    scale = reach / np.maximum(distance, 1e-9)
    z[edge] = (FRONT - EDGE + beyond * scale)[edge]
    y[edge] = (-EDGE + above * scale)[edge]
    return flat | edge | front


def lie_under(points):
    """Moves points under the bowl and the lemon, which lie 2 mm above the table, and says which."""
    x, y, z = points[..., 0], points[..., 1], points[..., 2]
    r, heights = bowl_underside()
    limit = np.interp(np.hypot(x - BOWL_PLACE[0], z - BOWL_PLACE[1]), r, heights + 0.002, left=0.002, right=1)
    below = np.maximum(LEMON_RADIUS**2 - (x - LEMON_PLACE[0]) ** 2 - (z - LEMON_PLACE[1]) ** 2, 0)
    limit = np.where(below > 0, np.minimum(limit, LEMON_RADIUS + 0.002 - np.sqrt(below)), limit)
    under = y > limit
    y[under] = limit[under]
    return under


def collide(points, before):
    """Moves points out of things; those that touch one slide less than they would."""
    touching = leave_table(points) | lie_under(points)
    points[touching] -= FRICTION * (points - before)[touching] * [1, 0, 1]


def placed(across, along):
    """x and z of points of the cloth before it folds."""
    cos, sin = np.cos(TURN), np.sin(TURN)
    return CENTER[0] + cos * across + sin * along, CENTER[1] - sin * across + cos * along


def simulate():
    """The cloth's points at rest: rows along its length, from the back."""
    rows, columns = int(LENGTH / SPACING) + 1, int(WIDTH / SPACING) + 1
    along, across = np.linspace(-LENGTH / 2, LENGTH / 2, rows), np.linspace(-WIDTH / 2, WIDTH / 2, columns)
    t, s = np.meshgrid(along, across, indexing="ij")
    uneven = np.random.RandomState(2).random_sample(s.shape)
    height = 0.02 + 0.010 * np.sin(62 * s + 4 * t + 1.3) + 0.003 * np.sin(41 * s - 9 * t) + 0.0015 * uneven
    push = np.linspace(1, PUSHED, STEPS // 3)
    x, z = placed(s, t)
    points = np.stack([x, height, z], axis=-1)
    velocity = np.zeros_like(points)
    groups = constraints(points.shape[:2])
    for k in range(STEPS):
        before = points.copy()
        velocity[..., 1] -= GRAVITY * STEP
        points = points + velocity * STEP
        for _ in range(ITERATIONS):
            if k < len(push):  # Hands hold the long sides where they lie on the table, ...
                for column in (0, -1):
                    held = along < 0.02
                    x, z = placed(across[column] * push[k], along)
                    points[held, column, 0], points[held, column, 2] = x[held], z[held]
                held_back = points[0, :, ::2].copy()
            else:  # ... and then the back, lest all of it slide over the edge.
                points[0, :, ::2] = held_back
            satisfy(points, groups)
            collide(points, before)
        velocity = (points - before) / STEP * 0.985
    return points


if __name__ == "__main__":
    surface = simulate()
    rows, columns = surface.shape[:2]
    normals = unit(np.cross(np.gradient(surface, axis=0), np.gradient(surface, axis=1)))
    v, u = np.meshgrid(-np.arange(rows) * SPACING, np.arange(columns) * SPACING, indexing="ij")
    uvs = np.stack([u, v], axis=-1)  # In metres.
    faces = grid_faces(rows, columns)[:, ::-1]
    write_ply("cloth.ply", *(part.reshape(-1, part.shape[-1]) for part in (surface, normals, uvs)), faces)
