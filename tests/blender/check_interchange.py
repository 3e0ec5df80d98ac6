# SPDX-License-Identifier: Apache-2.0
"""Opens frames that gischt wrote as a sequence in Blender and compares grids, places and sizes.

blender -b --factory-startup --python check_interchange.py -- DIR, DIR from write_frames.

A Volume object loads the sequence; names, types and transforms are read from it. Then Cycles renders
each grid as an emission without absorption, from the front and from above, with an orthographic
camera: the sum of the picture is the grid's integral over space, its centre of gravity the grid's
centre. Prints RESULT lines; the exit status is 1 when a number is wrong.
"""
import json
import math
import os
import sys

import bpy
import numpy

PIXELS = 96
VIEW = 8.0  # width of the picture in metres
TARGET = (3.5, -0.5, 1.75)
failures = []


def check(what, is_right, detail=""):
    print(f"RESULT {'ok  ' if is_right else 'FAIL'} {what} {detail}".rstrip())
    if not is_right:
        failures.append(what)


def emission_material(grid):
    material = bpy.data.materials.new(grid)
    material.use_nodes = True
    tree = material.node_tree
    tree.nodes.clear()
    attribute = tree.nodes.new("ShaderNodeAttribute")
    attribute.attribute_name = grid
    emission = tree.nodes.new("ShaderNodeEmission")
    output = tree.nodes.new("ShaderNodeOutputMaterial")
    color = "Color" if grid == "velocity" else "Fac"
    socket = "Color" if grid == "velocity" else "Strength"
    tree.links.new(attribute.outputs[color], emission.inputs[socket])
    tree.links.new(emission.outputs[0], output.inputs["Volume"])
    return material


def set_up(directory, prefix):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    volume = bpy.data.volumes.new("frames")
    volume.filepath = os.path.join(directory, prefix + "_0001.vdb")
    volume.is_sequence = True
    volume.frame_duration = 3
    volume.frame_start = 1
    volume.render.space = "WORLD"
    scene.collection.objects.link(bpy.data.objects.new("frames", volume))
    camera = bpy.data.cameras.new("camera")
    camera.type = "ORTHO"
    camera.ortho_scale = VIEW
    camera.clip_end = 100
    scene.camera = bpy.data.objects.new("camera", camera)
    scene.collection.objects.link(scene.camera)
    scene.world = bpy.data.worlds.new("black")
    scene.world.use_nodes = True
    scene.world.node_tree.nodes["Background"].inputs[1].default_value = 0
    scene.render.engine = "CYCLES"
    scene.cycles.samples = 16
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    scene.cycles.volume_step_rate = 0.5
    scene.cycles.pixel_filter_type = "BOX"
    scene.cycles.filter_width = 1
    scene.render.resolution_x = scene.render.resolution_y = PIXELS
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"
    scene.view_settings.view_transform = "Raw"
    return scene, volume


def render(scene, directory, from_above):
    x, y, z = TARGET
    scene.camera.location = (x, y, z + 20) if from_above else (x, y - 20, z)
    scene.camera.rotation_euler = (0, 0, 0) if from_above else (math.pi / 2, 0, 0)
    scene.render.filepath = os.path.join(directory, "view.exr")
    bpy.ops.render.render(write_still=True)
    image = bpy.data.images.load(scene.render.filepath)
    pixels = numpy.array(image.pixels[:], dtype=numpy.float64).reshape(PIXELS, PIXELS, 4)[:, :, :3]
    bpy.data.images.remove(image)
    return pixels


def moments(picture):
    """Integral over the picture, and its centre relative to the picture's middle, in metres."""
    step = VIEW / PIXELS
    place = (numpy.arange(PIXELS) + 0.5) * step - VIEW / 2
    total = picture.sum()
    across = (picture.sum(axis=0) * place).sum() / total
    up = (picture.sum(axis=1) * place).sum() / total
    return total * step * step, across, up


def measure(scene, directory, grid):
    """Integral, centre (x, y, z), and ratios of the channels."""
    bpy.data.volumes["frames"].materials.clear()
    bpy.data.volumes["frames"].materials.append(emission_material(grid))
    front, above = render(scene, directory, False), render(scene, directory, True)
    integral, x, z = moments(front[:, :, 0])
    _, _, y = moments(above[:, :, 0])
    ratios = front.sum(axis=(0, 1)) / front[:, :, 0].sum()
    return integral, (TARGET[0] + x, TARGET[1] + y, TARGET[2] + z), ratios


def check_grids(volume, frame, expected):
    h = expected["voxel_size"]
    wanted = expected["frames"][frame - 1]
    check(f"frame {frame} file", volume.grids.frame_filepath.endswith(f"frame_{frame:04d}.vdb"))
    check(f"frame {frame} grids", sorted(g.name for g in volume.grids) == sorted(wanted))
    for grid in volume.grids:
        grid.load()
        channels = wanted[grid.name]["channels"]
        kind = "FLOAT" if channels == 1 else "VECTOR_FLOAT"
        check(f"frame {frame} {grid.name} type", grid.data_type == kind and grid.channels == channels,
              grid.data_type)
        matrix = numpy.array(grid.matrix_object)
        right = numpy.diag([h, h, h, 1.0])
        right[:3, 3] = expected["first_center"]
        if abs(matrix[3, :3]).max() > 0:  # some versions give the transpose
            matrix = matrix.T
        check(f"frame {frame} {grid.name} size", numpy.allclose(matrix[:3, :3], right[:3, :3]))
        has_place = numpy.allclose(matrix[:3, 3], right[:3, 3])
        check(f"frame {frame} {grid.name} place", has_place, str(matrix[:3, 3]))


def check_pictures(scene, directory, frame, grid, wanted, shift, voxel):
    integral, center, ratios = measure(scene, directory, grid)
    off = (numpy.array(center) - wanted["center"]) / voxel
    name = f"frame {frame} {grid} in Cycles"
    check(name + " integral", abs(integral / wanted["integral"] - 1) < 0.02,
          f"{integral:.4f} of {wanted['integral']:.4f}")
    # A tenth of a voxel is five times the noise of 16 samples.
    check(name + " centre", abs(off - shift).max() < 0.1,
          "off by " + " ".join(f"{o:+.3f}" for o in off) + f" voxels, {shift:+.1f} foreseen")
    if grid == "velocity":
        check(name + " direction", numpy.allclose(ratios, [1, 2, 3], rtol=0.02), str(ratios))


def main():
    directory = sys.argv[sys.argv.index("--") + 1]
    with open(os.path.join(directory, "expected.json")) as file:
        expected = json.load(file)
    voxel = expected["voxel_size"]
    # Blender loads transforms as they are, and Cycles puts index i at (i + 1/2) of them: half a voxel
    # above the place that OpenVDB gives the sample. Frames with corner transforms are right there.
    scene, volume = set_up(directory, "frame")
    for frame in (1, 2, 3):
        scene.frame_set(frame)
        volume.grids.load()
        check_grids(volume, frame, expected)
    for frame, grid in ((1, "density"), (3, "density"), (2, "temperature"), (2, "velocity")):
        scene.frame_set(frame)
        wanted = expected["frames"][frame - 1][grid]
        check_pictures(scene, directory, frame, grid, wanted, 0.5, voxel)
    scene, volume = set_up(directory, "corner")
    scene.frame_set(2)
    wanted = expected["frames"][1]["density"]
    check_pictures(scene, directory, 2, "density", wanted, 0.0, voxel)
    print(f"RESULT {'FAIL' if failures else 'ok  '} {len(failures)} wrong")
    return 1 if failures else 0


if __name__ == "__main__":
    status = 1
    try:
        status = main()
    finally:
        sys.stdout.flush()
        os._exit(status)
