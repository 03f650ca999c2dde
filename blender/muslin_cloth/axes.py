"""Converts from Blender's world (z up, scene units) to muslin's (y up, metres) and back. Needs no Blender.

    x_muslin = s · (x, z, −y)          s: metres per scene unit

a turn of −90° about x, so right-handed stays right-handed. Without a unit scale only digits change places and
a sign: nothing is rounded.
"""

import numpy as np

TURN = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])


def turned(vectors, scale=1.0):
    """Vectors of Blender's world in muslin's axes, times `scale`; (n, 3) or (3,)."""
    v = np.asarray(vectors, float)
    return np.stack([v[..., 0], v[..., 2], -v[..., 1]], -1) * scale


def to_muslin(local, matrix, scale):
    """Points of an object (n, 3) placed by its world matrix (4, 4), in metres and y up."""
    m = np.asarray(matrix, float)
    return turned(np.asarray(local, float) @ m[:3, :3].T + m[:3, 3], scale)


def to_local(points, matrix, scale):
    """The inverse of to_muslin; numpy.linalg.LinAlgError if the matrix is flat."""
    p = np.asarray(points, float) / scale
    world = np.stack([p[:, 0], -p[:, 2], p[:, 1]], -1)
    m = np.asarray(matrix, float)
    return (world - m[:3, 3]) @ np.linalg.inv(m[:3, :3]).T
