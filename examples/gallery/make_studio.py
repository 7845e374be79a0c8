#!/usr/bin/env python3
"""Writes studio.hdr: a photographer's studio as a latitude-longitude picture of 192 x 96 pixels.

    python3 examples/gallery/make_studio.py examples/gallery/studio.hdr

A dim room that is brighter above, a large warm soft box in front at the left, a narrow cool one behind at the right.
Directions are those of docs/light.md: the centre of the picture is -z, its right half +x, its top row +y.
"""
import math
import sys

WIDTH, HEIGHT = 192, 96


def unit(azimuth_deg, elevation_deg):
    """As the camera of a scene: about +y, from +z towards +x."""
    a, e = math.radians(azimuth_deg), math.radians(elevation_deg)
    return (math.sin(a) * math.cos(e), math.sin(e), math.cos(a) * math.cos(e))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def smooth(edge, blur, x):
    """1 well inside of `edge`, 0 outside; `blur` wide."""
    t = min(1.0, max(0.0, (edge - abs(x)) / blur + 0.5))
    return t * t * (3 - 2 * t)


def soft_box(direction, azimuth_deg, elevation_deg, half_width, half_height):
    """Coverage by a rectangle at distance 1 that faces the object."""
    axis = unit(azimuth_deg, elevation_deg)
    right = unit(azimuth_deg + 90, 0)
    up = unit(azimuth_deg, elevation_deg + 90)
    depth = dot(direction, axis)
    if depth <= 0.05:
        return 0.0
    return smooth(half_width, 0.1, dot(direction, right) / depth) * smooth(half_height, 0.1, dot(direction, up) / depth)


def radiance(direction):
    room = 0.10 + 0.16 * (0.5 + 0.5 * direction[1]) ** 2
    key = 9.0 * soft_box(direction, -25, 42, 0.45, 0.35)
    rim = 11.0 * soft_box(direction, 165, 25, 0.18, 0.6)
    return (room + key + 0.86 * rim, room + 0.94 * key + 0.95 * rim, 1.04 * room + 0.84 * key + rim)


def rgbe(color):
    """[Ward1991]: three mantissas and the exponent of the largest."""
    mantissa, exponent = math.frexp(max(color))
    return bytes([int(256 * c / 2.0**exponent) for c in color] + [exponent + 128])


def main():
    rows = bytearray()
    for y in range(HEIGHT):
        theta = math.pi * (y + 0.5) / HEIGHT
        for x in range(WIDTH):
            phi = 2 * math.pi * (x + 0.5) / WIDTH - math.pi
            rows += rgbe(radiance((math.sin(phi) * math.sin(theta), math.cos(theta), -math.cos(phi) * math.sin(theta))))
    with open(sys.argv[1], "wb") as file:
        file.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y %d +X %d\n" % (HEIGHT, WIDTH))
        file.write(rows)


if __name__ == "__main__":
    main()
