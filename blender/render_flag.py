"""A silk flag in the wind, baked by the add-on and rendered by Cycles on the CPU: the picture of docs/guide/blender.md.

blender -b --factory-startup --python-exit-code 3 --python blender/render_flag.py -- OUT.png [SAMPLES]"""

import math
import pathlib
import sys
import tempfile

HERE = pathlib.Path(__file__).resolve().parent
sys.path.insert(0, str(HERE / "tests"))

import bpy

import host

FRAME = 66
LENGTH, HEIGHT, MAST = 1.8, 1.2, 3.4  # [m]


def flag():
    """Held by its hoist at five eyelets."""
    columns, rows = 54, 36
    vertices = [(LENGTH * i / columns, 0.0, MAST - 0.15 - HEIGHT + HEIGHT * j / rows)
                for j in range(rows + 1) for i in range(columns + 1)]
    at = lambda i, j: j * (columns + 1) + i
    faces = [(at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)) for j in range(rows) for i in range(columns)]
    eyelets = [at(0, j) for j in (0, 9, 18, 27, 36)]
    obj = host.mesh_object("Flag", vertices, faces, eyelets)
    for polygon in obj.data.polygons:
        polygon.use_smooth = True
    return host.cloth(obj, fabric="silk")


def wind(name, speed, degrees):
    bpy.ops.object.effector_add(type="WIND")
    field = bpy.context.object
    field.name = name
    field.rotation_euler = (0, math.pi / 2, math.radians(degrees))  # along x, turned about z
    field.field.strength = speed
    field.field.noise, field.field.seed = 0.25, 3


def material(name, colour, roughness, sheen=0.0, stripes=None):
    made = bpy.data.materials.new(name)
    made.use_nodes = True
    nodes, links = made.node_tree.nodes, made.node_tree.links
    shader = nodes["Principled BSDF"]
    shader.inputs["Base Color"].default_value = (*colour, 1)
    shader.inputs["Roughness"].default_value = roughness
    for socket in ("Sheen", "Sheen Weight"):
        if socket in shader.inputs:
            shader.inputs[socket].default_value = sheen
    if stripes:
        uv = nodes.new("ShaderNodeUVMap")
        split = nodes.new("ShaderNodeSeparateXYZ")
        scale = nodes.new("ShaderNodeMapRange")
        ramp = nodes.new("ShaderNodeValToRGB")
        bottom = MAST - 0.15 - HEIGHT
        scale.inputs["From Min"].default_value, scale.inputs["From Max"].default_value = bottom, bottom + HEIGHT
        ramp.color_ramp.interpolation = "CONSTANT"
        elements = ramp.color_ramp.elements
        while len(elements) < len(stripes):
            elements.new(0.5)
        for i, stripe in enumerate(stripes):
            elements[i].position = i / len(stripes)
            elements[i].color = (*stripe, 1)
        links.new(uv.outputs["UV"], split.inputs[0])
        links.new(split.outputs["Y"], scale.inputs["Value"])
        links.new(scale.outputs[0], ramp.inputs["Fac"])
        links.new(ramp.outputs["Color"], shader.inputs["Base Color"])
        # Thin cloth lets a third of the light through.
        through, mix = nodes.new("ShaderNodeBsdfTranslucent"), nodes.new("ShaderNodeMixShader")
        mix.inputs["Fac"].default_value = 0.35
        links.new(ramp.outputs["Color"], through.inputs["Color"])
        links.new(shader.outputs[0], mix.inputs[1])
        links.new(through.outputs[0], mix.inputs[2])
        links.new(mix.outputs[0], nodes["Material Output"].inputs["Surface"])
    return made


def surroundings():
    bpy.ops.mesh.primitive_cylinder_add(radius=0.03, depth=MAST, location=(-0.035, 0, MAST / 2), vertices=48)
    mast = bpy.context.object
    mast.data.materials.append(material("Mast", (0.75, 0.75, 0.73), 0.35))
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.06, location=(-0.035, 0, MAST + 0.03), segments=48, ring_count=24)
    knob = bpy.context.object
    knob.data.materials.append(material("Knob", (0.8, 0.55, 0.15), 0.25))
    for obj in (mast, knob):
        for polygon in obj.data.polygons:
            polygon.use_smooth = True
    bpy.ops.mesh.primitive_plane_add(size=400)
    bpy.context.object.data.materials.append(material("Ground", (0.10, 0.12, 0.05), 0.9))

    world = bpy.data.worlds.new("Sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes = world.node_tree.nodes
    sky = nodes.new("ShaderNodeTexSky")
    sky.sky_type = "NISHITA"
    sky.sun_elevation, sky.sun_rotation = math.radians(32), math.radians(150)
    sky.sun_intensity = 0.35
    nodes["Background"].inputs["Strength"].default_value = 0.1
    world.node_tree.links.new(sky.outputs[0], nodes["Background"].inputs[0])

    bpy.ops.object.camera_add(location=(1.05, -4.4, 1.9), rotation=(math.radians(98), 0, math.radians(3)))
    bpy.context.object.data.lens = 50
    bpy.context.scene.camera = bpy.context.object


def main():
    words = sys.argv[sys.argv.index("--") + 1:]
    out, samples = str(pathlib.Path(words[0]).resolve()), int(words[1]) if len(words) > 1 else 64
    bpy.ops.wm.read_factory_settings(use_empty=True)
    host.enable()
    scene = bpy.context.scene
    scene.frame_start, scene.frame_end = 1, FRAME
    with tempfile.TemporaryDirectory(prefix="muslin.") as folder:
        bpy.ops.wm.save_as_mainfile(filepath=folder + "/flag.blend")
        obj = flag()
        wind("Wind", 5.0, -18)
        bpy.ops.muslin.bake()
        obj.data.materials.append(material("Silk", (0.6, 0.05, 0.05), 0.5, 0.4,
                                           stripes=((0.01, 0.07, 0.12), (0.8, 0.74, 0.6), (0.5, 0.08, 0.03))))
        fine = obj.modifiers.new("Subdivision", "SUBSURF")
        fine.levels = fine.render_levels = 2
        surroundings()
        scene.render.engine = "CYCLES"
        scene.cycles.device, scene.cycles.samples = "CPU", samples
        scene.cycles.use_denoising = False  # Debian builds Blender without the denoiser
        scene.cycles.max_bounces = 6
        scene.render.resolution_x, scene.render.resolution_y = 960, 640
        scene.view_settings.view_transform = "Filmic"
        scene.view_settings.look = "Medium High Contrast"
        scene.render.filepath = out
        scene.frame_set(FRAME)
        bpy.ops.render.render(write_still=True)


main()
