"""Plays the part of `blender -b FILE --python SCRIPT` where Blender is the bpy module."""

import runpy
import sys

import bpy

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.wm.open_mainfile(filepath=sys.argv[1])
runpy.run_path(sys.argv[sys.argv.index("--python") + 1])
