"""Mesh and point cache files under scenes/meshes/, and sheets of squares."""
import pathlib
import struct

import numpy as np

MESHES = pathlib.Path(__file__).resolve().parent.parent / "scenes" / "meshes"


def write_obj(name, comment, positions, faces, uvs=None, groups=None, digits=9):
    """groups: {group name: face indices}; faces of no group come first."""
    lines = [f"# {comment}", f"o {name}"]
    lines += ["v " + " ".join(f"{c:.{digits}g}" for c in p) for p in positions]
    if uvs is not None:
        lines += ["vt " + " ".join(f"{c:.6g}" for c in t) for t in uvs]

    def face(f):
        return "f " + " ".join(f"{v + 1}/{v + 1}" if uvs is not None else f"{v + 1}" for v in f)

    grouped = {i for indices in (groups or {}).values() for i in indices}
    lines += [face(f) for i, f in enumerate(faces) if i not in grouped]
    for group, indices in (groups or {}).items():
        lines.append(f"g {group}")
        lines += [face(faces[i]) for i in indices]
    (MESHES / f"{name}.obj").write_text("\n".join(lines) + "\n")


def write_ply(name, comment, positions, faces, **attributes):
    """attributes: {name: numbers of the vertices}."""
    header = ["ply", "format ascii 1.0", f"comment {comment}", f"element vertex {len(positions)}"]
    header += [f"property float {axis}" for axis in ("x", "y", "z", *attributes)]
    header += [f"element face {len(faces)}", "property list uchar int vertex_indices", "end_header"]
    lines = [" ".join(f"{c:.6g}" for c in (*p, *(a[v] for a in attributes.values()))) for v, p in enumerate(positions)]
    lines += [f"{len(f)} " + " ".join(map(str, f)) for f in faces]
    (MESHES / f"{name}.ply").write_text("\n".join(header + lines) + "\n")


def write_pc2(name, frames):
    """frames: positions of every point, one array a sample."""
    header = struct.pack("<12siiffi", b"POINTCACHE2\0", 1, len(frames[0]), 0.0, 1.0, len(frames))
    (MESHES / f"{name}.pc2").write_bytes(header + np.asarray(frames, "<f4").tobytes())


def grid_faces(columns, rows):
    """Squares of a grid of (columns + 1) by (rows + 1) points, counted along the columns first."""
    def v(i, j):
        return i + j * (columns + 1)

    return [(v(i, j), v(i + 1, j), v(i + 1, j + 1), v(i, j + 1)) for j in range(rows) for i in range(columns)]


def grid_uvs(columns, rows):
    return [(i / columns, j / rows) for j in range(rows + 1) for i in range(columns + 1)]


def sheet(name, comment, width, height, columns, rows, level=False):
    """Upright from the origin in the plane z = 0; or level in the plane y = 0 about the origin, front up."""
    uvs = grid_uvs(columns, rows)
    if level:
        positions = [(width * (i / columns - 0.5), 0, height * (j / rows - 0.5))
                     for j in range(rows + 1) for i in range(columns + 1)]
        faces = [(a, d, c, b) for a, b, c, d in grid_faces(columns, rows)]
        uvs = [(u, 1 - v) for u, v in uvs]
    else:
        positions = [(width * i / columns, height * j / rows, 0) for j in range(rows + 1) for i in range(columns + 1)]
        faces = grid_faces(columns, rows)
    write_obj(name, comment, positions, faces, uvs)
