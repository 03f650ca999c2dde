"""Pickles of meshes and materials: what makes them anew. Scenes, simulations and diagnostics know their state."""

import copyreg
from collections.abc import Callable
from typing import Any

from muslin._muslin import Material, Mesh, parse_material
from muslin.tables import to_toml


def register() -> None:
    """Lets `copy` and `pickle` take meshes and materials."""
    copyreg.pickle(Mesh, _mesh_parts)
    copyreg.pickle(Material, _material_parts)


def _mesh(positions: Any, faces: Any, more: dict[str, Any]) -> Mesh:
    return Mesh(positions, faces, **more)


def _mesh_parts(mesh: Mesh) -> tuple[Callable[..., Mesh], tuple[Any, ...]]:
    faces = {name: list(members) for name, members in mesh.face_groups.items()}
    more: dict[str, Any] = {
        "name": mesh.name,
        "face_groups": faces,
        "materials": {name: list(members) for name, members in mesh.materials.items()},
        "groups": {name: list(members) for name, members in mesh.groups.items() if name not in faces},
    }
    if len(mesh.corner_uvs):
        more |= {"uvs": mesh.uvs.copy(), "corner_uvs": mesh.corner_uvs.copy()}
    return _mesh, (mesh.positions.copy(), mesh.faces, more)


def _material(text: str, name: str) -> Material:
    return parse_material(text, name)


def _material_parts(material: Material) -> tuple[Callable[..., Material], tuple[str, str]]:
    tables: dict[str, Any] = {
        "name": material.name,
        "description": material.description,
        "source": material.source,
        "guesses": material.guesses,
    }
    tables |= {"lattice": material.lattice, "shell": material.shell | material.curves, "reference": material.reference}
    return _material, (to_toml({key: table for key, table in tables.items() if table}), material.name)
