#!/usr/bin/env python3
"""Both mesh references beside volume path tracers: one view, one light, one thread, relative variance times CPU time.

    bench/peers/peers.py MESH.obj --searchlight build/release/bin/searchlight \\
        [--mitsuba PATH] [--tungsten PATH] [--blender PATH] [--materials marble,whole_milk,skin1] [--seconds 60]

None of the other programs is part of this project; those whose path is missing are left out. The scene of each is
written by this script: a body of 50 mm behind a smooth dielectric surface of index 1.3, isotropic scattering, a sun of 30
degrees (a disc of constant radiance that brings 1 to a surface that faces it), 128 x 128 pixels, box filter. A pilot finds
how many samples fill the time. Each program makes two pictures of different seeds; relative variance is half the mean
square of their difference in luminance over the square of the mean, over pixels that the body covers and in which
nothing is mirrored (a picture of a black body by Mitsuba or Tungsten says where). CPU seconds are user and system,
loading included. `--keep FOLDER` keeps scenes and pictures.
"""

import argparse
import json
import math
import os
import resource
import shutil
import struct
import subprocess
import tempfile

SIZE = 128
ETA = 1.3
FOV_DEG = 35
SUN_DEG = 30
LENGTH_MM = 50
DISTANCE_MM = 150
# 1/mm, from data/materials of [Jensen2001]; marble's index there is 1.5, and all have 1.3 here
MATERIALS = {
    "marble": ((0.0021, 0.0041, 0.0071), (2.19, 2.62, 3.00)),
    "whole_milk": ((0.0011, 0.0024, 0.014), (2.55, 3.21, 3.77)),
    "skin1": ((0.032, 0.17, 0.48), (0.74, 0.88, 1.01)),
}
# Mitsuba's roulette ends one path in twenty at each collision from the fifth on, whatever the albedo; without it marble
# has a fifth of the variance after the same time.
ROULETTE_DEPTH = 100000
BLACK = ((1000.0,) * 3, (0.0,) * 3)
HERE = os.path.dirname(os.path.abspath(__file__))
# Of the disc, where an irradiance of 1 comes from it to a surface that faces it.
RADIANCE = 1 / (math.pi * math.sin(math.radians(SUN_DEG / 2)) ** 2)
TO_SUN = (1 / math.sqrt(3),) * 3


def eye():
    azimuth, elevation = math.radians(30), math.radians(15)
    return [DISTANCE_MM * math.sin(azimuth) * math.cos(elevation), DISTANCE_MM * math.sin(elevation),
            DISTANCE_MM * math.cos(azimuth) * math.cos(elevation)]


def read_obj(path):
    positions, triangles = [], []
    with open(path, encoding="ascii", errors="replace") as file:
        for line in file:
            words = line.split()
            if words and words[0] == "v":
                positions.append([float(word) for word in words[1:4]])
            elif words and words[0] == "f":
                triangles.append([int(word.split("/")[0]) for word in words[1:4]])
    return positions, triangles


def write_body(path, folder):
    """Centred, LENGTH_MM long, as searchlight scales it."""
    positions, triangles = read_obj(path)
    low = [min(p[i] for p in positions) for i in range(3)]
    high = [max(p[i] for p in positions) for i in range(3)]
    scale = LENGTH_MM / max(b - a for a, b in zip(low, high))
    with open(os.path.join(folder, "body.obj"), "w", encoding="ascii") as file:
        for p in positions:
            file.write("v %.7g %.7g %.7g\n" % tuple(scale * (p[i] - (low[i] + high[i]) / 2) for i in range(3)))
        for t in triangles:
            file.write("f %d %d %d\n" % tuple(t))


def read_pfm(path):
    """Luminance, rows from the top."""
    with open(path, "rb") as file:
        colour = file.readline().strip() == b"PF"
        width, height = map(int, file.readline().split())
        order = "<" if float(file.readline()) < 0 else ">"
        channels = 3 if colour else 1
        values = struct.unpack(f"{order}{width * height * channels}f", file.read(4 * width * height * channels))
    pixels = []
    for y in reversed(range(height)):
        for x in range(width):
            rgb = values[(y * width + x) * channels:][:channels]
            pixels.append(0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2] if colour else rgb[0])
    return pixels


def cpu_seconds(command, folder):
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    done = subprocess.run(command, cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, check=False)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    if done.returncode != 0:
        raise SystemExit(f"{' '.join(command)} failed:\n{done.stdout.decode(errors='replace')[-2000:]}")
    return after.ru_utime - before.ru_utime + after.ru_stime - before.ru_stime


def mitsuba(program, medium, folder, samples, seed, out):
    # The disc is 10 m away: from all of the body it is the same within 0.2 degrees. The sampler of version 0.6 has no
    # seed: pass this property to the constructor of its Random.
    absorption, scattering = (", ".join(map(repr, values)) for values in medium)
    far = 1e4
    at = [far * c for c in TO_SUN]
    text = f"""<scene version="0.6.0">
  <integrator type="volpath"><integer name="maxDepth" value="-1"/>
    <integer name="rrDepth" value="{ROULETTE_DEPTH}"/></integrator>
  <sensor type="perspective">
    <float name="fov" value="{FOV_DEG}"/><string name="fovAxis" value="y"/>
    <float name="nearClip" value="1"/><float name="farClip" value="1e6"/>
    <transform name="toWorld"><lookat origin="{', '.join(map(repr, eye()))}" target="0, 0, 0" up="0, 1, 0"/></transform>
    <sampler type="independent"><integer name="sampleCount" value="{samples}"/>
      <integer name="seed" value="{seed}"/></sampler>
    <film type="hdrfilm"><integer name="width" value="{SIZE}"/><integer name="height" value="{SIZE}"/>
      <string name="fileFormat" value="pfm"/><string name="pixelFormat" value="rgb"/><boolean name="banner" value="false"/>
      <rfilter type="box"/></film>
  </sensor>
  <shape type="obj"><string name="filename" value="body.obj"/><boolean name="faceNormals" value="true"/>
    <bsdf type="dielectric"><float name="intIOR" value="{ETA}"/><float name="extIOR" value="1"/></bsdf>
    <medium name="interior" type="homogeneous">
      <rgb name="sigmaA" value="{absorption}"/><rgb name="sigmaS" value="{scattering}"/><phase type="isotropic"/></medium>
  </shape>
  <shape type="disk">
    <transform name="toWorld"><scale value="{far * math.tan(math.radians(SUN_DEG / 2))!r}"/>
      <lookat origin="{', '.join(map(repr, at))}" target="0, 0, 0" up="0, 1, 0"/></transform>
    <emitter type="area"><rgb name="radiance" value="{RADIANCE!r}"/></emitter>
  </shape>
</scene>
"""
    with open(os.path.join(folder, "mitsuba.xml"), "w", encoding="ascii") as file:
        file.write(text)
    return cpu_seconds([program, "-p", "1", "-q", "-o", out, "mitsuba.xml"], folder)


def tungsten(program, medium, folder, samples, seed, out, asks_lights=False):
    y = TO_SUN
    x = (1 / math.sqrt(2), -1 / math.sqrt(2), 0)
    z = (x[1] * y[2] - x[2] * y[1], x[2] * y[0] - x[0] * y[2], x[0] * y[1] - x[1] * y[0])
    turn = [value for row in zip(x, y, z) for value in (*row, 0)] + [0, 0, 0, 1]
    scene = {
        "media": [{"name": "body", "type": "homogeneous", "phase_function": {"type": "isotropic"},
                   "sigma_a": medium[0], "sigma_s": medium[1]}],
        "bsdfs": [{"name": "glass", "type": "dielectric", "ior": ETA, "albedo": 1}],
        "primitives": [
            {"type": "mesh", "file": "body.obj", "smooth": False, "backface_culling": False, "recompute_normals": False,
             "bsdf": "glass", "int_medium": "body"},
            {"type": "infinite_sphere_cap", "cap_angle": SUN_DEG / 2, "transform": turn, "emission": RADIANCE,
             "bsdf": {"type": "null"}}],
        "camera": {"tonemap": "linear", "type": "pinhole", "fov": FOV_DEG, "resolution": [SIZE, SIZE],
                   "reconstruction_filter": "box",
                   "transform": {"position": eye(), "look_at": [0, 0, 0], "up": [0, 1, 0]}},
        "integrator": {"type": "path_tracer", "min_bounces": 0, "max_bounces": 100000, "enable_light_sampling": True,
                       "enable_volume_light_sampling": asks_lights},
        "renderer": {"hdr_output_file": out, "overwrite_output_files": True, "spp": samples, "spp_step": samples,
                     "stratified_sampler": False, "adaptive_sampling": False, "scene_bvh": True}}
    with open(os.path.join(folder, "tungsten.json"), "w", encoding="ascii") as file:
        json.dump(scene, file)
    return cpu_seconds([program, "-t", "1", "-s", str(seed), "tungsten.json"], folder)


def cycles(program, medium, folder, samples, seed, out, random_walk=False):
    job = {"mesh": "body.obj", "sigma_a": medium[0], "sigma_s": medium[1], "eta": ETA, "random_walk": random_walk,
           "to_sun": TO_SUN, "sun_deg": SUN_DEG, "radiance": RADIANCE, "eye": eye(), "fov_deg": FOV_DEG, "size": SIZE,
           "samples": samples, "seed": seed, "out": os.path.join(folder, out)}
    with open(os.path.join(folder, "cycles.json"), "w", encoding="ascii") as file:
        json.dump(job, file)
    return cpu_seconds([program, "-b", "--factory-startup", "-t", "1", "--python-exit-code", "1", "--python",
                        os.path.join(HERE, "cycles.py"), "--", "cycles.json"], folder)


def searchlight(program, medium, folder, samples, seed, out, radiance=False):
    triple = lambda values: ",".join(map(repr, values))
    command = [program, "reference", "mesh", "body.obj", "--scale", str(LENGTH_MM), "--sigma-a", triple(medium[0]),
               "--sigma-s", triple(medium[1]), "--eta", str(ETA), "--light", "dir:1,1,1", "--sun-angle", str(SUN_DEG),
               "--camera", f"30,15,{DISTANCE_MM / LENGTH_MM}", "--fov", str(FOV_DEG), "--size", f"{SIZE}x{SIZE}",
               "--threads", "1", "--seed", str(seed), "-o", out]
    if radiance:
        command += ["--radiance", "--walks", str(samples * SIZE * SIZE)]
    else:
        command += ["--walks", str(samples * 1000)]
    return cpu_seconds(command, folder)


def programs_of(options):
    found = {}
    if options.mitsuba:
        found["Mitsuba 0.6, volpath"] = (mitsuba, options.mitsuba, {}, 16)
    if options.tungsten:
        found["Tungsten, path tracer"] = (tungsten, options.tungsten, {}, 16)
    if options.blender:
        found["Cycles, volume in glass"] = (cycles, options.blender, {}, 8)
        found["Cycles, random walk"] = (cycles, options.blender, {"random_walk": True}, 8)
    found["radiance reference"] = (searchlight, options.searchlight, {"radiance": True}, 32)
    found["exitance reference"] = (searchlight, options.searchlight, {}, 100)
    return {name: entry for name, entry in found.items() if options.only in name}


def mirrored(options, folder):
    """Pixels in which a black body mirrors the sun."""
    if options.mitsuba:
        mitsuba(options.mitsuba, BLACK, folder, 256, 1, "mirrored.pfm")
    elif options.tungsten:
        tungsten(options.tungsten, BLACK, folder, 256, 1, "mirrored.pfm")
    else:
        return [False] * (SIZE * SIZE)
    return [value > 0 for value in read_pfm(os.path.join(folder, "mirrored.pfm"))]


def covered(options, folder):
    searchlight(options.searchlight, MATERIALS["marble"], folder, 300, 1, "covered.pfm")
    lit = [value > 0 for value in read_pfm(os.path.join(folder, "covered.pfm"))]
    around = [dy * SIZE + dx for dy in (-1, 0, 1) for dx in (-1, 0, 1)]
    return [all(0 <= i + d < len(lit) and lit[i + d] for d in around) for i in range(len(lit))]


def measure(name, entry, medium, folder, tag, seconds):
    render, program, extra, first = entry
    out = [f"{tag}-{seed}.pfm" for seed in (1, 2)]
    # Twice: a short run says little of the speed of a long one.
    start = render(program, medium, folder, 1, 3, "pilot.pfm", **extra)
    samples = first
    for _ in range(2):
        spent = max(render(program, medium, folder, samples, 3, "pilot.pfm", **extra) - start, 0.01)
        more = max(1.0, (seconds / 10 - start) / spent)
        if more == 1:
            break
        samples = int(samples * more)
    spent = max(render(program, medium, folder, samples, 3, "pilot.pfm", **extra) - start, 0.01)
    samples = max(1, int(samples * (seconds - start) / spent))
    spent = [render(program, medium, folder, samples, seed, out[seed - 1], **extra) for seed in (1, 2)]
    return samples, sum(spent) / 2, [read_pfm(os.path.join(folder, path)) for path in out]


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mesh")
    parser.add_argument("--searchlight", default="build/release/bin/searchlight")
    for name in ("mitsuba", "tungsten", "blender"):
        parser.add_argument(f"--{name}")
    parser.add_argument("--materials", default="marble,whole_milk,skin1")
    parser.add_argument("--seconds", type=float, default=60, help="CPU time of each picture")
    parser.add_argument("--only", default="", help="the programs whose name holds this")
    parser.add_argument("--keep", help="a folder for scenes and pictures")
    options = parser.parse_args()
    for name in ("searchlight", "mitsuba", "tungsten", "blender"):
        if path := getattr(options, name):
            setattr(options, name, os.path.abspath(shutil.which(path) or path))
    with tempfile.TemporaryDirectory() as scratch:
        folder = os.path.abspath(options.keep or scratch)
        os.makedirs(folder, exist_ok=True)
        write_body(options.mesh, folder)
        shines = mirrored(options, folder)
        use = [i for i, inside in enumerate(covered(options, folder)) if inside and not shines[i]]
        print(f"{len(use)} pixels")
        print(f"{'':14}{'':26}{'samples':>8}{'CPU s':>8}{'mean':>9}{'noise %':>9}{'var x s':>10}{'brightest':>10}")
        for material in options.materials.split(","):
            for name, entry in programs_of(options).items():
                tag = f"{material}-{name.replace(',', '').replace(' ', '_')}"
                samples, seconds, (a, b) = measure(name, entry, MATERIALS[material], folder, tag, options.seconds)
                mean = sum(a[i] + b[i] for i in use) / 2 / len(use)
                variance = sum((a[i] - b[i]) ** 2 for i in use) / 2 / len(use) / mean ** 2
                brightest = max(max(a[i], b[i]) for i in use) / mean
                print(f"{material:14}{name:26}{samples:8}{seconds:8.1f}{mean:9.4f}{100 * math.sqrt(variance):9.2f}"
                      f"{variance * seconds:10.3g}{brightest:10.2f}", flush=True)


if __name__ == "__main__":
    main()
