"""Muslin cloth in Blender: any mesh simulated by the muslin program, played back by Blender's own Mesh Cache.

Runs as an extension (Blender 4.2 and later, blender_manifest.toml) and as an add-on (from 3.4, bl_info).
bake_state, point_cache, axes, scene_text, advice, worker and fabrics need no Blender."""

from . import operators, panels, preferences, properties, session

bl_info = {
    "name": "Muslin Cloth",
    "author": "muslin contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "Properties > Physics > Muslin Cloth",
    "description": "Simulates any mesh as cloth or soft solid with the muslin program",
    "category": "Physics",
}

MODULES = (properties, preferences, operators, panels, session)


def register():
    for module in MODULES:
        module.register()


def unregister():
    for module in reversed(MODULES):
        module.unregister()
