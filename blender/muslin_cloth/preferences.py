"""Preferences: the path of the muslin program."""

import bpy
from bpy.props import IntProperty, StringProperty

from . import fabrics, worker


def preferences():
    addon = bpy.context.preferences.addons.get(__package__)
    return addon.preferences if addon else None


def find_program():
    found = preferences()
    fabrics.program = worker.find_program(bpy.path.abspath(found.program) if found and found.program else "")
    return fabrics.program


def threads():
    found = preferences()
    return found.threads if found else 0


def changed(_preferences, _context):
    find_program()


class MuslinPreferences(bpy.types.AddonPreferences):
    bl_idname = __package__

    program: StringProperty(
        name="Program", subtype="FILE_PATH", update=changed,
        description="The muslin program; empty: the one beside the add-on, or on the PATH")
    threads: IntProperty(name="Threads", min=0, description="0: one per core. Results do not depend on the number")

    def draw(self, _context):
        layout = self.layout
        layout.prop(self, "program")
        layout.prop(self, "threads")
        found = find_program()
        layout.label(text=f"Found: {found}" if found else "The program muslin was not found",
                     icon="CHECKMARK" if found else "ERROR")


def register():
    bpy.utils.register_class(MuslinPreferences)
    find_program()


def unregister():
    bpy.utils.unregister_class(MuslinPreferences)
