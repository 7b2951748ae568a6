#!/usr/bin/env python3
"""Writes garden.obj, textures/leaves.png and textures/wire.png, the same bytes every time."""
import math
import os
import struct
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
random_state = 1


def random():
    global random_state
    random_state = random_state * 1664525 + 1013904223 & 0xFFFFFFFF
    return random_state / 2**32


def write_png(name, side, colour_type, pixel):
    rows = b"".join(b"\0" + b"".join(bytes(pixel(x, y)) for x in range(side)) for y in range(side))

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    with open(os.path.join(HERE, "textures", name), "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", struct.pack(">IIBBBBB", side, side, 8, colour_type, 0, 0, 0)))
        file.write(chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b""))


def leaves_png():
    """A twig with leaves; alpha is where they are."""
    side, leaves = 96, []
    for i in range(9):
        angle = math.pi * (0.12 + 0.76 * (i % 5) / 4) if i % 2 else math.pi * (0.05 + 0.9 * (i % 4) / 3)
        stem = 0.18 + 0.075 * i
        leaves.append((0.5 + 0.13 * math.cos(angle), stem, angle, 0.2 + 0.03 * (i % 3), i))

    def pixel(x, y):
        u, v = (x + 0.5) / side, 1 - (y + 0.5) / side
        colour, alpha = (60, 110, 40), 255 if abs(u - 0.5) < 0.012 and v < 0.85 else 0
        for at_u, at_v, angle, length, i in leaves:
            along = (u - at_u) * math.cos(angle) + (v - at_v) * math.sin(angle)
            across = -(u - at_u) * math.sin(angle) + (v - at_v) * math.cos(angle)
            part = along / length
            if 0 < part < 1 and abs(across) < 0.36 * length * math.sin(math.pi * part**0.8):
                vein = abs(across) < 0.006
                shade = 10 * (i % 3) + (26 if vein else 0)
                colour, alpha = (62 + shade, 122 + shade, 40 + shade // 2), 255
        return *colour, alpha

    write_png("leaves.png", side, 6, pixel)


def wire_png():
    """One mesh of a chain-link fence, that repeats: white where the wire is."""
    side = 48

    def pixel(x, y):
        u, v = (x + 0.5) / side, (y + 0.5) / side
        away = min(abs((u + v) % 1 - 0.5), abs((u - v) % 1 - 0.5)) / math.sqrt(2)
        return (round(255 * min(max((0.05 - away) * side + 0.5, 0), 1)),)

    write_png("wire.png", side, 0, pixel)


class Obj:
    def __init__(self):
        self.lines = ["# Made by make_garden.py: leaves and a fence cut out by map_d, a pane that is half there.",
                      "mtllib garden.mtl"]
        self.vertices = 0
        self.texcoords = {}

    def quad(self, corners, texcoords=((0, 0), (1, 0), (1, 1), (0, 1))):
        for corner in corners:
            self.lines.append("v " + " ".join(f"{x:.3f}".rstrip("0").rstrip(".") for x in corner))
        face = "f"
        for i, texcoord in enumerate(texcoords):
            if texcoord not in self.texcoords:
                self.texcoords[texcoord] = len(self.texcoords) + 1
                self.lines.append(f"vt {texcoord[0]:g} {texcoord[1]:g}")
            face += f" {self.vertices + i + 1}/{self.texcoords[texcoord]}"
        self.vertices += 4
        self.lines.append(face)

    def box(self, low, high):
        x, y, z = zip(low, high)
        for a, b, c, d in ((0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3), (0, 1, 3, 2), (4, 6, 7, 5)):
            self.quad([(x[k & 1], y[k >> 1 & 1], z[k >> 2]) for k in (a, b, c, d)])

    def use(self, material):
        self.lines.append("usemtl " + material)

    def write(self):
        with open(os.path.join(HERE, "garden.obj"), "w") as file:
            file.write("\n".join(self.lines) + "\n")


def fence(obj, begin, end, height):
    length = math.hypot(end[0] - begin[0], end[1] - begin[1])
    u, v = round(4 * length), round(4 * height)
    obj.use("wire")
    obj.quad([(begin[0], 0.05, begin[1]), (end[0], 0.05, end[1]), (end[0], height, end[1]), (begin[0], height, begin[1])],
             ((0, 0), (u, 0), (u, v), (0, v)))
    obj.use("post")
    count = round(length / 1.5)
    for i in range(count + 1):
        x, z = (begin[k] + (end[k] - begin[k]) * i / count for k in (0, 1))
        obj.box((x - 0.04, 0, z - 0.04), (x + 0.04, height + 0.1, z + 0.04))


def tree(obj, x, z, height, radius, count):
    obj.use("bark")
    obj.box((x - 0.09, 0, z - 0.09), (x + 0.09, height, z + 0.09))
    obj.use("leaves")
    for _ in range(count):
        turn, up = 2 * math.pi * random(), 2 * random() - 1
        far = radius * random() ** 0.4
        flat = math.sqrt(1 - up * up)
        centre = (x + far * flat * math.cos(turn), height + 0.9 * far * up, z + far * flat * math.sin(turn))
        yaw, pitch, size = 2 * math.pi * random(), 1.2 * random() - 0.6, 0.55 + 0.25 * random()
        right = (math.cos(yaw), 0.0, math.sin(yaw))
        top = (-math.sin(pitch) * math.sin(yaw), math.cos(pitch), math.sin(pitch) * math.cos(yaw))
        obj.quad([tuple(centre[k] + size * (a * right[k] + b * top[k]) for k in range(3))
                  for a, b in ((-0.5, -0.5), (0.5, -0.5), (0.5, 0.5), (-0.5, 0.5))])


def main():
    leaves_png()
    wire_png()
    obj = Obj()
    obj.use("tiles")
    obj.quad([(-6, 0, 5), (6, 0, 5), (6, 0, -6), (-6, 0, -6)], ((0, 0), (6, 0), (6, 5.5), (0, 5.5)))
    fence(obj, (-5.6, -4.5), (2.6, -4.5), 1.6)
    fence(obj, (3.6, 3.4), (3.6, -4.4), 1.6)
    tree(obj, -1.6, -1.4, 2.3, 1.25, 110)
    tree(obj, 2.1, -2.9, 1.7, 0.85, 50)
    obj.use("pane")
    obj.quad([(-0.2, 0.1, 1.4), (1.7, 0.1, 0.8), (1.7, 1.3, 0.8), (-0.2, 1.3, 1.4)])
    obj.use("post")
    obj.box((-0.25, 0, 1.36), (-0.17, 1.4, 1.44))
    obj.box((1.66, 0, 0.76), (1.74, 1.4, 0.84))
    obj.write()


main()
