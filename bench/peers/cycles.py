"""Renders the scene of peers.py with Cycles: blender -b --factory-startup --python cycles.py -- JOB.json

The body is a mesh whose surface is smooth glass around a homogeneous volume, or (random_walk) one with Cycles' random
walk: mean free path and single-scattering albedo are those of the volume, by the inverse of the albedo's remapping
[Chiang2016, Wrenninge2017] that Cycles does, but light enters and leaves diffusely and without refraction.
"""

import json
import math
import os
import struct
import sys

import bpy
from mathutils import Matrix, Vector


def read_obj(path):
    positions, triangles = [], []
    with open(path, encoding="ascii") as file:
        for line in file:
            words = line.split()
            if words[0] == "v":
                positions.append(tuple(map(float, words[1:4])))
            else:
                triangles.append(tuple(int(word) - 1 for word in words[1:4]))
    return positions, triangles


def frame(back, up):
    """Of a camera or lamp, which looks along its own -z."""
    z = Vector(back).normalized()
    x = Vector(up).cross(z).normalized()
    return Matrix((x, z.cross(x), z)).transposed().to_4x4()


def remapped(albedo):
    """The single-scattering albedo that Cycles takes for that of a surface, for isotropic scattering."""
    blend = albedo ** 0.25
    return ((1 - blend) * 1.8260523782 * math.atan(5.11246590163 * albedo) ** 1.09686102424 +
            blend * 0.496310210422 * math.atan(4.2350090965 * albedo) ** 2.40602999408)


def surface_albedo(alpha):
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if remapped(middle) < alpha else (low, middle)
    return low


def glass(tree, job, output):
    surface = tree.nodes.new("ShaderNodeBsdfGlass")
    surface.distribution = "SHARP"
    surface.inputs["Roughness"].default_value = 0
    surface.inputs["IOR"].default_value = job["eta"]
    tree.links.new(surface.outputs[0], output.inputs["Surface"])
    # Colour times density is the coefficient of scattering; one less the colour, times density, that of absorption.
    scatter, absorb = tree.nodes.new("ShaderNodeVolumeScatter"), tree.nodes.new("ShaderNodeVolumeAbsorption")
    dense, dark = max(job["sigma_s"]), max(job["sigma_a"])
    scatter.inputs["Color"].default_value = (*(s / dense for s in job["sigma_s"]), 1)
    scatter.inputs["Density"].default_value = dense
    absorb.inputs["Color"].default_value = (*(1 - a / dark for a in job["sigma_a"]), 1)
    absorb.inputs["Density"].default_value = dark
    both = tree.nodes.new("ShaderNodeAddShader")
    tree.links.new(scatter.outputs[0], both.inputs[0])
    tree.links.new(absorb.outputs[0], both.inputs[1])
    tree.links.new(both.outputs[0], output.inputs["Volume"])


def random_walk(tree, job, output):
    surface = tree.nodes.new("ShaderNodeSubsurfaceScattering")
    surface.falloff = "RANDOM_WALK_FIXED_RADIUS"
    total = [a + s for a, s in zip(job["sigma_a"], job["sigma_s"])]
    surface.inputs["Color"].default_value = (*(surface_albedo(s / t) for s, t in zip(job["sigma_s"], total)), 1)
    # Cycles divides the radius by 4 pi.
    surface.inputs["Scale"].default_value = 1
    surface.inputs["Radius"].default_value = [4 * math.pi / t for t in total]
    tree.links.new(surface.outputs[0], output.inputs["Surface"])


def build(job, folder):
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scene = bpy.context.scene
    scene.world = None
    mesh = bpy.data.meshes.new("body")
    positions, triangles = read_obj(os.path.join(folder, job["mesh"]))
    mesh.from_pydata(positions, [], triangles)
    material = bpy.data.materials.new("body")
    material.use_nodes = True
    material.node_tree.nodes.clear()
    output = material.node_tree.nodes.new("ShaderNodeOutputMaterial")
    (random_walk if job["random_walk"] else glass)(material.node_tree, job, output)
    material.cycles.homogeneous_volume = True
    mesh.materials.append(material)
    scene.collection.objects.link(bpy.data.objects.new("body", mesh))

    sun = bpy.data.lights.new("sun", "SUN")
    sun.angle = math.radians(job["sun_deg"])
    # Cycles spreads the strength evenly over a flat disc at distance 1, so that a surface that faces it receives the
    # strength times the mean cosine; radiance grows towards the disc's edge, by a tenth.
    tangent = math.tan(sun.angle / 2)
    mean_cosine = 2 * (math.hypot(1, tangent) - 1) / tangent ** 2
    sun.energy = job["radiance"] * math.pi * math.sin(sun.angle / 2) ** 2 / mean_cosine
    sun.cycles.use_multiple_importance_sampling = True
    lamp = bpy.data.objects.new("sun", sun)
    lamp.matrix_world = frame(job["to_sun"], (0, 1, 0))
    scene.collection.objects.link(lamp)

    camera = bpy.data.objects.new("camera", bpy.data.cameras.new("camera"))
    camera.data.sensor_fit = "VERTICAL"
    camera.data.angle = math.radians(job["fov_deg"])
    camera.data.clip_end = 1e6
    camera.matrix_world = Matrix.Translation(job["eye"]) @ frame(job["eye"], (0, 1, 0))
    scene.collection.objects.link(camera)
    scene.camera = camera
    return scene


def render(scene, job):
    scene.render.engine = "CYCLES"
    scene.render.resolution_x = scene.render.resolution_y = job["size"]
    scene.render.resolution_percentage = 100
    scene.render.use_persistent_data = False
    scene.render.threads_mode, scene.render.threads = "FIXED", 1
    cycles = scene.cycles
    cycles.device = "CPU"
    cycles.samples, cycles.seed = job["samples"], job["seed"]
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    for bounces in ("max_bounces", "transmission_bounces", "volume_bounces", "glossy_bounces", "diffuse_bounces"):
        setattr(cycles, bounces, 1024)
    cycles.caustics_reflective = cycles.caustics_refractive = True
    cycles.blur_glossy = cycles.sample_clamp_direct = cycles.sample_clamp_indirect = 0
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode, settings.color_depth = "OPEN_EXR", "RGB", "32"
    scene.render.filepath = job["out"] + ".exr"
    bpy.ops.render.render(write_still=True)
    picture = bpy.data.images.load(scene.render.filepath)
    values = [value for i, value in enumerate(picture.pixels[:]) if i % 4 < 3]
    with open(job["out"], "wb") as file:
        file.write(b"PF\n%d %d\n-1\n" % tuple(picture.size))
        file.write(struct.pack(f"<{len(values)}f", *values))


path = sys.argv[sys.argv.index("--") + 1]
with open(path, encoding="ascii") as file:
    JOB = json.load(file)
render(build(JOB, os.path.dirname(os.path.abspath(path))), JOB)
