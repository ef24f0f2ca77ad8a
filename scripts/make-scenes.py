#!/usr/bin/env python3
"""Makes the meshes and images of scenes/ again: python3 scripts/make-scenes.py [FOLDER]   (FOLDER: scenes, beside this script)

Python 3 and its standard library are all it needs. It draws every random number from fixed seeds, so the same files come out
each time (the bytes of a PNG may differ with another version of zlib, its pixels do not). It writes .obj, .png, .hdr and .ies files only:
the .toml and .mtl files are written by hand, and so are cornell/, instances/, simple/ and furnace/furnace.obj.

Conventions: y is up, faces are counter-clockwise seen from outside, v of a texture coordinate is upwards. A shape is a list of points,
a list of faces (indices of points) and, where it has them, one texture coordinate a point.
"""

import math
import random
import struct
import sys
import zlib
from pathlib import Path

TAU = 2 * math.pi


# Vectors ----------------------------------------------------------------------------------------------------------------------


def add(a, b):
    return tuple(x + y for x, y in zip(a, b))


def sub(a, b):
    return tuple(x - y for x, y in zip(a, b))


def mul(a, s):
    return tuple(x * s for x in a)


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    return mul(a, 1 / math.sqrt(dot(a, a)))


# Shapes -----------------------------------------------------------------------------------------------------------------------


class Shape:
    """Points, faces, and texture coordinates (none, or one a point)."""

    def __init__(self, points, faces, uvs=None):
        self.points, self.faces, self.uvs = [tuple(p) for p in points], faces, uvs

    def map(self, f):
        return Shape([f(p) for p in self.points], self.faces, self.uvs)

    def move(self, x, y, z):
        return self.map(lambda p: add(p, (x, y, z)))

    def scale(self, x, y=None, z=None):
        y, z = x if y is None else y, x if z is None else z
        return self.map(lambda p: (p[0] * x, p[1] * y, p[2] * z))

    def turn(self, axis, degrees):
        """About the x, y or z axis, counter-clockwise seen from its tip."""
        c, s = math.cos(math.radians(degrees)), math.sin(math.radians(degrees))
        i, j = {"x": (1, 2), "y": (2, 0), "z": (0, 1)}[axis]

        def f(p):
            p = list(p)
            p[i], p[j] = c * p[i] - s * p[j], s * p[i] + c * p[j]
            return tuple(p)

        return self.map(f)

    def place(self, origin, x, y, z):
        """Into a frame of three vectors at an origin."""
        return self.map(lambda p: add(origin, add(mul(x, p[0]), add(mul(y, p[1]), mul(z, p[2])))))

    def flip(self):
        return Shape(self.points, [face[::-1] for face in self.faces], self.uvs)


def join(shapes):
    """Several shapes without texture coordinates as one."""
    points, faces = [], []
    for shape in shapes:
        first = len(points)
        points += shape.points
        faces += [[first + i for i in face] for face in shape.faces]
    return Shape(points, faces)


def quad(a, b, c, d, repeat=(1, 1)):
    """Four corners, counter-clockwise from the lower left; the texture repeats so often along its sides."""
    u, v = repeat
    return Shape([a, b, c, d], [[0, 1, 2, 3]], [(0, 0), (u, 0), (u, v), (0, v)])


def box(low, high):
    (a, b, c), (d, e, f) = low, high
    points = [(a, b, c), (d, b, c), (d, e, c), (a, e, c), (a, b, f), (d, b, f), (d, e, f), (a, e, f)]
    faces = [[0, 3, 2, 1], [4, 5, 6, 7], [0, 1, 5, 4], [3, 7, 6, 2], [0, 4, 7, 3], [1, 2, 6, 5]]
    return Shape(points, faces)


def inside(low, high, without=()):
    """A room seen from inside; `without` names faces by their place in `box`."""
    shape = box(low, high).flip()
    return Shape(shape.points, [face for i, face in enumerate(shape.faces) if i not in without])


def geodesic(n):
    """A unit sphere: an icosahedron whose faces are split into n * n triangles."""
    g = (1 + math.sqrt(5)) / 2
    corners = [(-1, g, 0), (1, g, 0), (-1, -g, 0), (1, -g, 0), (0, -1, g), (0, 1, g), (0, -1, -g), (0, 1, -g),
               (g, 0, -1), (g, 0, 1), (-g, 0, -1), (-g, 0, 1)]
    sides = [(0, 11, 5), (0, 5, 1), (0, 1, 7), (0, 7, 10), (0, 10, 11), (1, 5, 9), (5, 11, 4), (11, 10, 2), (10, 7, 6), (7, 1, 8),
             (3, 9, 4), (3, 4, 2), (3, 2, 6), (3, 6, 8), (3, 8, 9), (4, 9, 5), (2, 4, 11), (6, 2, 10), (8, 6, 7), (9, 8, 1)]
    index, points, faces = {}, [], []

    def point(p):
        p = unit(p)
        key = tuple(round(x, 9) + 0.0 for x in p)
        if key not in index:
            index[key] = len(points)
            points.append(p)
        return index[key]

    for a, b, c in sides:
        a, b, c = corners[a], corners[b], corners[c]
        rows = [[point(add(add(mul(a, n - i), mul(b, i - j)), mul(c, j))) for j in range(i + 1)] for i in range(n + 1)]
        for i in range(n):
            for j in range(i + 1):
                faces.append([rows[i][j], rows[i + 1][j], rows[i + 1][j + 1]])
                if j < i:
                    faces.append([rows[i][j], rows[i + 1][j + 1], rows[i][j + 1]])
    return Shape(points, faces)


def octahedron():
    points = [(1, 0, 0), (0, 0, -1), (-1, 0, 0), (0, 0, 1), (0, 1, 0), (0, -1, 0)]
    faces = [[i, (i + 1) % 4, 4] for i in range(4)] + [[(i + 1) % 4, i, 5] for i in range(4)]
    return Shape(points, faces)


def lathe(profile, n):
    """A profile of (radius, height) from the bottom up, turned about the y axis in n steps; radius 0 is a pole."""
    points, rings = [], []
    for radius, height in profile:
        if radius == 0:
            rings.append([len(points)] * n)
            points.append((0, height, 0))
        else:
            rings.append([len(points) + i for i in range(n)])
            points += [(radius * math.sin(TAU * i / n), height, radius * math.cos(TAU * i / n)) for i in range(n)]
    faces = []
    for low, high in zip(rings, rings[1:]):
        for i in range(n):
            j = (i + 1) % n
            face = [low[i], low[j], high[j], high[i]]
            faces.append([corner for k, corner in enumerate(face) if corner not in face[:k]])
    return Shape(points, [face for face in faces if len(face) > 2])


def turned(profile, n):
    """As `lathe`, with a seam at -z and texture coordinates: u goes around the axis, v along the profile."""
    points, uvs, faces = [], [], []
    for j, (radius, height) in enumerate(profile):
        for i in range(n + 1):
            angle = TAU * (i / n + 0.5)
            points.append((radius * math.sin(angle), height, radius * math.cos(angle)))
            uvs.append((i / n, j / (len(profile) - 1)))
    for j in range(len(profile) - 1):
        for i in range(n):
            low, high = j * (n + 1) + i, (j + 1) * (n + 1) + i
            face = [low, low + 1, high + 1, high]
            # At a pole two corners are one; the one in the middle of its triangle is left.
            if profile[j][0] == 0:
                face = [low, high + 1, high]
            elif profile[j + 1][0] == 0:
                face = [low, low + 1, high]
            faces.append(face)
    return Shape(points, faces, uvs)


def cushion(size, roundness, n, m):
    """A superellipsoid of half the edges `size`: `roundness` 1 is an ellipsoid, less is nearer to a box (upright, and seen from above)."""
    def power(x, e):
        return math.copysign(abs(x) ** e, x)

    up, around = roundness
    profile = [(power(math.cos(a), up), power(math.sin(a), up)) for a in (math.pi * (j / m - 0.5) for j in range(m + 1))]
    profile[0], profile[-1] = (0, -1), (0, 1)
    shape = lathe(profile, n)

    def square(p):
        r = math.hypot(p[0], p[2])
        if r == 0:
            return p
        return (r * power(p[0] / r, around), p[1], r * power(p[2] / r, around))

    return shape.map(square).scale(*size)


def tube(path, radius, n, closed=False):
    """A round tube along a path, its ends shut unless the path is closed."""
    count = len(path)

    def tangent(i):
        if closed:
            return unit(sub(path[(i + 1) % count], path[i - 1]))
        return unit(sub(path[min(i + 1, count - 1)], path[max(i - 1, 0)]))

    # A frame carried along without twist; what is left of a closed path's twist is spread over it.
    frames = []
    t = tangent(0)
    side = unit(cross(t, (0, 1, 0) if abs(t[1]) < 0.9 else (1, 0, 0)))
    for i in range(count):
        t = tangent(i)
        side = unit(sub(side, mul(t, dot(side, t))))
        frames.append((t, side, cross(t, side)))
    twist = 0
    if closed:
        t, first, up = frames[0]
        last = unit(sub(side, mul(t, dot(side, t))))
        twist = -math.atan2(dot(last, up), dot(last, first))
    points = []
    for i, (t, side, up) in enumerate(frames):
        for k in range(n):
            angle = TAU * k / n + twist * i / count
            offset = add(mul(side, radius * math.cos(angle)), mul(up, radius * math.sin(angle)))
            points.append(add(path[i], offset))
    faces = []
    for i in range(count if closed else count - 1):
        j = (i + 1) % count
        faces += [[i * n + k, i * n + (k + 1) % n, j * n + (k + 1) % n, j * n + k] for k in range(n)]
    if not closed:
        faces += [list(range(n))[::-1], [(count - 1) * n + k for k in range(n)]]
    return Shape(points, faces)


def torus(major, minor, n, m):
    """In the x-z plane."""
    return tube([(major * math.sin(TAU * i / n), 0, major * math.cos(TAU * i / n)) for i in range(n)], minor, m, closed=True)


def knot(n, m, radius):
    """A trefoil, about 3 wide, upright."""
    path = []
    for i in range(n):
        a = TAU * i / n
        path.append((math.sin(a) + 2 * math.sin(2 * a), math.cos(a) - 2 * math.cos(2 * a), -math.sin(3 * a)))
    return tube([mul(p, 0.5) for p in path], radius, m, closed=True)


def star(points, outer, inner, thickness):
    """A star in the x-y plane."""
    n = 2 * points
    rim = [((outer, inner)[i % 2] * math.sin(TAU * i / n), (outer, inner)[i % 2] * math.cos(TAU * i / n)) for i in range(n)]
    vertices = [(0, 0, thickness), (0, 0, -thickness)] + [(x, y, 0) for x, y in rim]
    faces = []
    for i in range(n):
        j = (i + 1) % n
        faces += [[0, 2 + j, 2 + i], [1, 2 + i, 2 + j]]
    return Shape(vertices, faces)


def annulus(outer, inner, n):
    """A flat ring in the x-y plane that faces +z."""
    points = []
    for i in range(n):
        a = TAU * i / n
        points += [(outer * math.cos(a), outer * math.sin(a), 0), (inner * math.cos(a), inner * math.sin(a), 0)]
    return Shape(points, [[2 * i, 2 * ((i + 1) % n), 2 * ((i + 1) % n) + 1, 2 * i + 1] for i in range(n)])


def disk(radius, n):
    """In the x-z plane, facing down."""
    return Shape([(radius * math.cos(TAU * i / n), 0, radius * math.sin(TAU * i / n)) for i in range(n)], [list(range(n))])


def checker(low, high, count, odd):
    """Every other square of a floor between (x, z) and (x, z)."""
    shapes = []
    (nx, nz), (x0, z0), (x1, z1) = count, low, high
    for i in range(nx):
        for k in range(nz):
            if (i + k) % 2 == odd:
                a, b = x0 + (x1 - x0) * i / nx, x0 + (x1 - x0) * (i + 1) / nx
                c, d = z0 + (z1 - z0) * k / nz, z0 + (z1 - z0) * (k + 1) / nz
                shapes.append(quad((a, 0, d), (b, 0, d), (b, 0, c), (a, 0, c)))
    return join(shapes)


def sweep(width, depth, height, radius, n=8):
    """A studio backdrop: a floor that bends up into a wall. The floor ends at z = depth, the wall stands at z = -radius."""
    profile = [(depth, 0.0)] + [(-radius * math.sin(0.25 * TAU * i / n), radius * (1 - math.cos(0.25 * TAU * i / n)))
                                for i in range(n + 1)] + [(-radius, height)]
    points = [(x, y, z) for z, y in profile for x in (-width / 2, width / 2)]
    return Shape(points, [[2 * i, 2 * i + 1, 2 * i + 3, 2 * i + 2] for i in range(len(profile) - 1)])


# Files ------------------------------------------------------------------------------------------------------------------------


def number(x, digits=4):
    text = f"{x:.{digits}f}".rstrip("0").rstrip(".")
    return "0" if text in ("-0", "") else text


def unfolded(face, points):
    """A quadrangle, or its two triangles where two of its sides cross: such a polygon has no inside that can be told."""
    if len(face) != 4:
        return [face]
    a, b, c, d = (points[i] for i in face)
    minus = lambda p, q: [x - y for x, y in zip(p, q)]
    cross = lambda p, q: [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]]
    dot = lambda p, q: sum(x * y for x, y in zip(p, q))
    normal = cross(minus(c, a), minus(d, b))
    turns = lambda p, q, r: dot(cross(minus(q, p), minus(r, p)), normal) >= -1e-9 * dot(normal, normal)
    plain = turns(a, b, c) and turns(a, c, d) or turns(b, c, d) and turns(b, d, a)
    return [face] if plain else [[face[0], face[1], face[2]], [face[0], face[2], face[3]]]


class Obj:
    """An OBJ file: parts, each a name, a material and a shape; with texture coordinates if it names a library or is `mapped`."""

    def __init__(self, comment, library=None, mapped=False):
        self.comment, self.library, self.mapped, self.parts = comment, library, mapped or library is not None, []

    def part(self, name, material, shape):
        self.parts.append((name, material, shape))
        return self

    def write(self, path, smooth=()):
        """Parts whose names are in `smooth` get smoothing group 1."""
        lines = [f"# {line}" for line in self.comment.split("\n") + ["Made by scripts/make-scenes.py."]]
        lines += [f"mtllib {self.library}"] if self.library else []
        first, first_uv, count = 1, 1, 0
        for name, material, shape in self.parts:
            lines += ["", f"o {name}"]
            lines += ["v " + " ".join(number(x) for x in p) for p in shape.points]
            uvs = shape.uvs if self.mapped else None
            if uvs:
                lines += ["vt " + " ".join(number(x) for x in uv) for uv in uvs]
            lines += [f"usemtl {material}"] if material else []
            lines.append("s 1" if name in smooth else "s off")
            for face in (part for face in shape.faces for part in unfolded(face, shape.points)):
                corners = [f"{first + i}/{first_uv + i}" if uvs else str(first + i) for i in face]
                lines.append("f " + " ".join(corners))
                count += len(face) - 2
            first += len(shape.points)
            first_uv += len(uvs) if uvs else 0
        text = "\n".join(lines) + "\n"
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)
        print(f"{path}: {count} triangles, {len(text)} bytes")


def write_png(path, width, height, pixels):
    """Pixels from the upper left: a number (grey), three (RGB) or four (RGBA), 0 to 255."""
    pixels = [p if isinstance(p, tuple) else (p,) for p in pixels]
    channels = len(pixels[0])
    rows, above = b"", bytes(width * channels)
    for y in range(height):
        row = bytes(c for p in pixels[y * width:(y + 1) * width] for c in p)
        # Filter 2: the difference to the row above.
        rows += b"\x02" + bytes((a - b) & 255 for a, b in zip(row, above))
        above = row

    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))

    header = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2, 4: 6}[channels], 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"sRGB", b"\0") + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    path.write_bytes(data)
    print(f"{path}: {width} x {height}, {len(data)} bytes")


def write_hdr(path, width, height, pixels):
    """Radiance's RGBE, run-length encoded; linear pixels from the upper left."""
    def rgbe(colour):
        largest = max(colour)
        if largest < 1e-9:
            return (0, 0, 0, 0)
        mantissa, exponent = math.frexp(largest)
        scale = mantissa * 256 / largest
        return tuple(min(255, int(c * scale)) for c in colour) + (exponent + 128,)

    data = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    for y in range(height):
        row = [rgbe(p) for p in pixels[y * width:(y + 1) * width]]
        data += bytes((2, 2, width >> 8, width & 255))
        for channel in range(4):
            values = [p[channel] for p in row]
            i = 0
            while i < width:
                run = 1
                while i + run < width and run < 127 and values[i + run] == values[i]:
                    run += 1
                if run >= 3:
                    data += bytes((128 + run, values[i]))
                    i += run
                    continue
                end = i + 1
                while end < width and end - i < 128 and not (end + 2 < width and values[end] == values[end + 1] == values[end + 2]):
                    end += 1
                data += bytes((end - i,)) + bytes(values[i:end])
                i = end
    path.write_bytes(data)
    print(f"{path}: {width} x {height}, {len(data)} bytes")


def noise(seed):
    """Smooth value noise that repeats: f(x, y, period), from 0 to 1."""
    rng = random.Random(seed)
    table = [rng.random() for _ in range(4096)]

    def f(x, y, period):
        i, j = math.floor(x), math.floor(y)
        s, t = x - i, y - j
        s, t = s * s * (3 - 2 * s), t * t * (3 - 2 * t)
        at = lambda a, b: table[((a % period) * 57 + (b % period) * 131 + period * 17) % 4096]
        low = at(i, j) * (1 - s) + at(i + 1, j) * s
        high = at(i, j + 1) * (1 - s) + at(i + 1, j + 1) * s
        return low * (1 - t) + high * t

    return f


def byte(x):
    return max(0, min(255, round(x)))


# The scenes -------------------------------------------------------------------------------------------------------------------


def shapes(out):
    """Meshes that several scenes use."""
    def write(name, comment, shape):
        Obj(comment).part(name, None, shape).write(out / "shapes" / f"{name}.obj", smooth=(name,))

    write("ball", "A ball of radius 1 about the origin.", geodesic(12))
    write("torus", "A torus about the y axis: radius 1 to the middle of a tube of radius 0.35.", torus(1, 0.35, 56, 20))
    write("knot", "A trefoil of a tube of radius 0.32, about 3 wide and high, upright.", knot(110, 14, 0.32))
    pawn = [(0, 0), (0.42, 0), (0.46, 0.05), (0.46, 0.13), (0.4, 0.19), (0.4, 0.23), (0.3, 0.3), (0.21, 0.45), (0.165, 0.65), (0.155, 0.8),
            (0.29, 0.84), (0.3, 0.87), (0.29, 0.9), (0.18, 0.93)]
    head = [(0.255 * math.cos(math.radians(a)), 1.12 + 0.255 * math.sin(math.radians(a))) for a in range(-45, 90, 15)]
    write("pawn", "A pawn that stands on the origin, 1.375 high.", lathe(pawn + head + [(0, 1.375)], 32))
    for name, shape, comment in (
        ("cube", box((-0.5, 0, -0.5), (0.5, 1, 0.5)), "A cube of edge 1 that stands on the origin."),
        ("cone", lathe([(0, 0), (0.5, 0), (0, 1)], 40), "A cone that stands on the origin: radius 0.5, height 1."),
    ):
        Obj(comment).part(name, None, shape).write(out / "shapes" / f"{name}.obj")


def shadows(out):
    stage = Obj("A floor and a wall, a screen between the middle luminaire and the wall, and a fence.")
    stage.part("floor", "floor", quad((-5.6, 0, 5), (5.6, 0, 5), (5.6, 0, -2), (-5.6, 0, -2)))
    stage.part("wall", "wall", quad((-5.6, 0, -2), (5.6, 0, -2), (5.6, 4, -2), (-5.6, 4, -2)))
    stage.part("screen", "screen", box((-0.75, 0, -1.55), (0.75, 1.9, -1.5)))
    pickets = [box((x - 0.06, 0, 0.5), (x + 0.06, 0.9, 0.55)) for x in (-0.6, -0.3, 0.0, 0.3, 0.6)]
    stage.part("fence", "wood", join(pickets + [box((-0.75, h, 0.55), (0.75, h + 0.08, 0.6)) for h in (0.2, 0.62)]))
    stage.write(out / "shadows" / "stage.obj")


def directions(out):
    room = Obj("A room under a bowl that throws its light at the ceiling; open towards the camera.")
    room.part("walls", "wall", inside((-3, 0, -3), (3, 3.6, 4.5), without=(1, 2, 4, 5)))
    room.part("floor", "floor", quad((-3, 0, 4.5), (3, 0, 4.5), (3, 0, -3), (-3, 0, -3)))
    room.part("left", "red", quad((-3, 0, 4.5), (-3, 0, -3), (-3, 3.6, -3), (-3, 3.6, 4.5)))
    room.part("right", "blue", quad((3, 0, -3), (3, 0, 4.5), (3, 3.6, 4.5), (3, 3.6, -3)))
    bowl = lathe([(0, 1.2), (0.3, 1.22), (0.6, 1.3), (0.75, 1.42), (0.72, 1.42), (0.57, 1.33), (0.3, 1.26), (0, 1.24)], 32)
    foot = lathe([(0.3, 0), (0.28, 0.04), (0.05, 0.08), (0.04, 1.22)], 20)
    room.part("lamp_stand", "metal", join([bowl, foot]).move(-1.7, 0, -1.7))
    room.part("lamp", "lamp", disk(0.56, 24).move(-1.7, 1.34, -1.7))
    room.write(out / "directions" / "room.obj", smooth=("lamp_stand",))


def extinction(out):
    rooms = Obj("Two rooms and an arcade between them; the lamp hangs in the one behind.")
    rooms.part("front", "wall", inside((-2.6, 0, 0), (2.6, 3, 5), without=(0, 2)))
    rooms.part("floor", "floor", quad((-2.6, 0, 5), (2.6, 0, 5), (2.6, 0, -3.2), (-2.6, 0, -3.2)))
    # The wall between the rooms is 0.3 thick, with three doors 1 wide and 2.2 high.
    for name, x in (("pier_1", -2.6), ("pier_2", -1.05), ("pier_3", 0.3), ("pier_4", 1.65)):
        rooms.part(name, "wall", box((x, 0, -0.3), (-2.05 if x < -2 else 2.6 if x > 1.5 else x + 0.35, 2.2, 0)))
    rooms.part("lintel", "wall", box((-2.6, 2.2, -0.3), (2.6, 3, 0)))
    rooms.part("back", "wall", inside((-2.6, 0, -3.2), (2.6, 3, -0.3), without=(1, 2)))
    rooms.part("lamp", "lamp", quad((-1.4, 2.99, -1.7), (1.4, 2.99, -1.7), (1.4, 2.99, -0.9), (-1.4, 2.99, -0.9)))
    rooms.write(out / "extinction" / "rooms.obj")


def lamps(out):
    stage = Obj("A floor and a wall.")
    stage.part("floor", "floor", quad((-9, 0, 8), (9, 0, 8), (9, 0, -2), (-9, 0, -2)))
    stage.part("wall", "wall", quad((-9, 0, -2), (9, 0, -2), (9, 7, -2), (-9, 7, -2)))
    stage.write(out / "lamps" / "stage.obj")
    lights = Obj("Area luminaires of odd shapes.")
    lights.part("star", "star", star(5, 0.62, 0.25, 0.1).turn("z", 8).move(2.5, 2.55, -1.8))
    lights.part("ring", "ring", annulus(0.85, 0.7, 40).turn("x", -14).turn("y", 24).move(-2.45, 0.86, -0.9))
    lights.part("torus", "torus", torus(0.55, 0.05, 28, 8).turn("x", 12).move(1.1, 0.2, 0.6))
    lights.part("spiral", "spiral", tube([(0.32 * math.cos(i * 0.5), i * 0.028, 0.32 * math.sin(i * 0.5)) for i in range(52)], 0.035, 6).move(2.9, 0.1, 0.2))

    def letter(strokes):
        return join([tube([(x, y, 0) for x, y in stroke], 0.045, 8) for stroke in strokes])

    arc = [(0.3 - 0.3 * math.cos(math.radians(a)), 0.3 - 0.3 * math.sin(math.radians(a))) for a in range(0, 181, 15)]
    word = join([
        letter([[(0, 1.3), (0, 0.02), (0.02, 0), (0.6, 0)]]),
        letter([[(0, 0.85)] + arc + [(0.6, 0.85)]]).move(0.95, 0, 0),
        letter([[(0, 0), (0.3, 0.42), (0.6, 0.85)], [(0, 0.85), (0.27, 0.465)], [(0.33, 0.385), (0.6, 0)]]).move(1.85, 0, 0),
    ])
    lights.part("word", "word", word.scale(0.95).move(-1.45, 1.85, -1.86))
    lights.write(out / "lamps" / "lights.obj")


def mirror(out):
    room = Obj("A checkered floor, three panels that stand in it like a folding screen, and a lamp above.")
    for odd, material in ((0, "light_tile"), (1, "dark_tile")):
        room.part(material, material, checker((-5, -3), (5, 5), (20, 16), odd))
    room.part("wall", "wall", quad((-5, 0, -3), (5, 0, -3), (5, 4.5, -3), (-5, 4.5, -3)))
    panel = box((-0.95, 0.06, -0.03), (0.95, 2.7, 0.03))
    frame = join([box((-1, 0, -0.06), (1, 0.06, 0.06)), box((-1, 2.7, -0.06), (1, 2.76, 0.06)),
                  box((-1, 0.06, -0.06), (-0.95, 2.7, 0.06)), box((0.95, 0.06, -0.06), (1, 2.7, 0.06))])
    for name, x, z, angle in (("plain", -1.86, -0.95, 30), ("both", 0, -1.45, 0), ("mirror", 1.86, -0.95, -30)):
        room.part(name, name, panel.turn("y", angle).move(x, 0, z))
        room.part(f"{name}_frame", "frame", frame.turn("y", angle).move(x, 0, z))
    room.part("lamp", "lamp", disk(0.9, 24).move(0, 4.4, 2.2))
    room.write(out / "mirror" / "room.obj")


def glass(out):
    studio = Obj("A backdrop and a lamp.")
    studio.part("backdrop", "backdrop", sweep(14, 6, 6, 3).move(0, 0, -0.6))
    studio.part("lamp", "lamp", disk(0.6, 24).turn("z", 30).turn("x", -20).move(-2.2, 4.2, -1.6))
    studio.write(out / "glass" / "studio.obj", smooth=("backdrop",))
    bodies = Obj("A prism and a slab of glass, with their outsides outside; each stands 0.001 above the floor.")
    r = 0.5
    prism = [(r * math.sin(TAU * i / 3), r * math.cos(TAU * i / 3)) for i in range(3)]
    points = [(x, y, z) for z in (-0.8, 0.8) for x, y in prism]
    prism = Shape(points, [[0, 1, 2], [5, 4, 3], [0, 3, 4, 1], [1, 4, 5, 2], [2, 5, 3, 0]])
    bodies.part("prism", "clear", prism.turn("y", 24).move(-1.45, 0.251, 1.3))
    bodies.part("slab", "tinted", box((-0.06, 0, -0.55), (0.06, 1.5, 0.55)).turn("y", 35).move(2.3, 0.001, -0.35))
    bodies.write(out / "glass" / "bodies.obj")


def lens(out):
    table = Obj("A checkered board that lies on a dark ground, and a few dozen small lamps far behind it.")
    for odd, material in ((0, "light_field"), (1, "dark_field")):
        table.part(material, material, checker((-4, -6), (4, 2), (8, 8), odd).move(0, 0.001, 0))
    rng = random.Random(5)
    small = [[], [], []]
    for i in range(42):
        x, y, z = rng.uniform(-9, 9), rng.uniform(0.3, 5.2), rng.uniform(-18, -13)
        small[i % 3].append(octahedron().scale(rng.uniform(0.09, 0.13)).move(x, y, z))
    for lights, material in zip(small, ("warm", "cool", "rose")):
        table.part(material, material, join(lights))
    table.part("ground", "ground", quad((-30, -0.3, 10), (30, -0.3, 10), (30, -0.3, -30), (-30, -0.3, -30)))
    table.part("board", "frame", box((-4.2, -0.3, -6.2), (4.2, -0.002, 2.2)))
    table.part("key", "key", quad((-4.5, 5, -3), (-2.5, 5, -3), (-2.5, 5.5, -0.5), (-4.5, 5.5, -0.5)))
    table.write(out / "lens" / "table.obj")


def brick(f, size, rows, columns, x, y):
    """Of a texel of a wall of bricks: the row, the place along it in bricks, and how far it is from the brick's edge, in texels, with chips."""
    row = y * rows // size
    bx = (x * columns / size + 0.5 * (row % 2)) % columns
    u, v = bx % 1 * size / columns, y * rows / size % 1 * size / rows
    return row, bx, min(u, size / columns - u, v, size / rows - v) + 2.5 * (f(x / 6, y / 6, 43) - 0.5)


def textures(out):
    folder = out / "textures"
    folder.mkdir(parents=True, exist_ok=True)
    f = noise(1)
    # Bricks: 8 rows of 4, every other row shifted by half a brick; all of it repeats.
    size, rows, columns, rng = 256, 8, 4, random.Random(2)
    tone = [[(rng.uniform(0.75, 1.15), rng.uniform(-10, 14)) for _ in range(columns)] for _ in range(rows)]
    pixels = []
    for y in range(size):
        for x in range(size):
            row, bx, edge = brick(f, size, rows, columns, x, y)
            grain = 0.86 + 0.22 * f(x / 2, y / 2, 128) + 0.12 * f(x / 16, y / 16, 16)
            if edge < 2:
                pixels.append(tuple(byte(c * grain) for c in (168, 160, 148)))
            else:
                light, hue = tone[row][int(bx)]
                pixels.append(tuple(byte(c * grain * light) for c in (150 + hue, 74 + 0.4 * hue, 56)))
    write_png(folder / "bricks.png", size, size, pixels)
    # Only 8 by 8 texels: what is between them is bilinear.
    pixels = [(226, 220, 205) if (x + y) % 2 else (24, 44, 50) for y in range(8) for x in range(8)]
    write_png(folder / "checker.png", 8, 8, pixels)
    # A maple-like leaf with veins; alpha is its outline.
    size, pixels = 128, []
    lobes = [(0, 0.5), (52, 0.42), (-52, 0.42), (104, 0.3), (-104, 0.3)]
    for y in range(size):
        for x in range(size):
            dx, dy = (x + 0.5) / size - 0.5, 0.42 - (y + 0.5) / size + 0.04
            angle, radius = math.degrees(math.atan2(dx, dy)), math.hypot(dx, dy)
            reach, vein = 0.14, 1.0
            for at, length in lobes:
                away = abs((angle - at + 180) % 360 - 180)
                reach = max(reach, length * max(0, 1 - (away / 27) ** 1.15) + 0.1 * max(0, 1 - away / 36))
                if away < 90:
                    vein = min(vein, abs(math.sin(math.radians(away))) * radius * size / 1.3)
            reach *= 1 + 0.1 * math.sin(math.radians(angle * 22)) * min(1, radius * 4)
            stem = abs(dx + 0.05 * dy) < 0.014 and -0.5 < dy < 0
            inside = radius < reach or stem
            shade = 0.85 + 0.3 * f(x / 8, y / 8, 64)
            base = (118, 158, 52) if vein > 1 else (176, 192, 104)
            pixels.append(tuple(byte(c * shade) for c in base) + (255 if inside else 0,))
    write_png(folder / "leaf.png", size, size, pixels)
    # A trellis: opaque bars, holes between them. No colours: this is a map_d.
    size = 64
    pixels = []
    for y in range(size):
        for x in range(size):
            a, b = (x + y) % 32, (x - y) % 32
            pixels.append(255 if min(a, b) < 7 else 0)
    write_png(folder / "trellis.png", size, size, pixels)
    # Stained glass that glows: cells around random points, black lead between them.
    width, height, rng = 96, 144, random.Random(12)
    seeds = [(rng.uniform(0, width), rng.uniform(0, height)) for _ in range(38)]
    colours = [(235, 60, 40), (250, 160, 40), (250, 225, 110), (60, 150, 90), (40, 110, 220), (140, 60, 180), (240, 240, 225)]
    chosen = [rng.choice(colours) for _ in seeds]
    pixels = []
    for y in range(height):
        for x in range(width):
            near = sorted((math.hypot(x - a, y - b), i) for i, (a, b) in enumerate(seeds))
            border = min(x, y, width - 1 - x, height - 1 - y) < 4
            lead = near[1][0] - near[0][0] < 2.6 or border
            pixels.append((0, 0, 0) if lead else chosen[near[0][1]])
    write_png(folder / "window.png", width, height, pixels)
    # Black and white in equal parts, and the sRGB value whose light is half as much: 188. From afar both look the same.
    pixels = [255 * ((x + y) % 2) if (x < 32) else 188 for y in range(64) for x in range(64)]
    write_png(folder / "half.png", 64, 64, pixels)

    yard = Obj("A brick wall, a checkered floor, a trellis, a window that glows, and a chart.", library="textures.mtl")
    yard.part("floor", "checker", quad((-6, 0, 4), (6, 0, 4), (6, 0, -2), (-6, 0, -2), (3, 1.5)))
    yard.part("wall", "bricks", quad((-6, 0, -2), (6, 0, -2), (6, 4, -2), (-6, 4, -2), (6, 2)))
    yard.part("trellis", "trellis", quad((-2.9, 0, -0.2), (-0.9, 0, -0.9), (-0.9, 2.1, -0.9), (-2.9, 2.1, -0.2), (4, 4)))
    yard.part("window", "window", quad((1.15, 0.95, -1.95), (2.35, 0.95, -1.95), (2.35, 2.75, -1.95), (1.15, 2.75, -1.95)))
    sill = join([box((1.05, 0.85, -2), (2.45, 0.95, -1.8)), box((1.05, 2.75, -2), (2.45, 2.85, -1.88)),
                 box((1.05, 0.95, -2), (1.15, 2.75, -1.9)), box((2.35, 0.95, -2), (2.45, 2.75, -1.9))])
    yard.part("frame", "wood", sill)
    yard.part("chart", "half", quad((0.3, 1.3, -1.97), (0.95, 1.3, -1.97), (0.95, 1.95, -1.97), (0.3, 1.95, -1.97)))
    rng = random.Random(9)
    leaves = []
    for i in range(90):
        # Hanging over the wall from the upper left, ever fewer further down.
        across, down = rng.random(), rng.random() ** 1.7
        centre = (-3.8 + 4.6 * across, 4.1 - 2.3 * down * (1.1 - 0.8 * across), -1.75 + 0.5 * rng.random())
        size, turn, tilt, lean = rng.uniform(0.2, 0.36), rng.uniform(-70, 70), rng.uniform(-40, 25), rng.uniform(-40, 40)
        leaf = quad((-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)).scale(size * 2)
        leaves.append(leaf.turn("z", 180 + turn).turn("x", tilt).turn("y", lean).move(*centre))
    for i in range(9):
        leaf = quad((-0.5, -0.5, 0), (0.5, -0.5, 0), (0.5, 0.5, 0), (-0.5, 0.5, 0)).scale(rng.uniform(0.35, 0.55))
        leaves.append(leaf.turn("x", -90 + rng.uniform(-12, 12)).turn("y", rng.uniform(0, 360)).move(rng.uniform(-2.2, 2.6), 0.05, rng.uniform(-0.8, 1.6)))
    leaf = join(leaves)
    leaf.uvs = [uv for one in leaves for uv in one.uvs]
    yard.part("leaves", "leaf", leaf)
    yard.write(folder / "yard.obj")


def environment(out):
    folder = out / "environment"
    folder.mkdir(parents=True, exist_ok=True)
    f = noise(3)
    width, height, pixels = 256, 128, []
    sun = unit((0.62, 0.5, -0.35))
    for y in range(height):
        theta = math.pi * (y + 0.5) / height
        for x in range(width):
            phi = TAU * ((x + 0.5) / width - 0.5)
            d = (math.sin(theta) * math.sin(phi), math.cos(theta), -math.sin(theta) * math.cos(phi))
            glow = max(0, dot(d, sun))
            if d[1] < 0:
                depth = min(1, -d[1] * 6)
                colour = tuple(h * (1 - depth) + g * depth for h, g in zip((0.55, 0.58, 0.62), (0.16, 0.14, 0.11)))
            else:
                rise = d[1] ** 0.55
                colour = tuple(h * (1 - rise) + z * rise for h, z in zip((0.95, 0.92, 0.88), (0.13, 0.29, 0.66)))
                # Clouds on a plane above; further away they are denser and fade into the haze.
                far = 1 / (d[1] + 0.12)
                cx, cz = d[0] * far + 40, d[2] * far + 40
                cloud = sum(f(cx * 2 ** k * 1.1, cz * 2 ** k * 1.1, 512) / 2 ** k for k in range(5)) / 1.9375
                cover = max(0, min(1, (cloud - 0.5) * 5)) * min(1, d[1] * 9)
                colour = tuple(c * (1 - cover) + w * cover for c, w in zip(colour, (1.05, 1.02, 1.0)))
                colour = add(colour, mul((0.9, 0.7, 0.4), 0.8 * glow ** 40 + 0.25 * glow ** 6))
            if glow > math.cos(math.radians(1.9)):
                colour = (1500, 1250, 900)
            pixels.append(colour)
    write_hdr(folder / "sky.hdr", width, height, pixels)
    ground = Obj("A round terrace with a rim.")
    ground.part("terrace", "ground", lathe([(5.2, -0.3), (5.2, 0), (0, 0)], 64))
    ground.write(folder / "terrace.obj")


def many_lights(out):
    rng = random.Random(24)
    tree = Obj("A tree in the snow with some hundred small lamps of very different size and radiance.")
    tree.part("snow", "snow", quad((-14, 0, 14), (14, 0, 14), (14, 0, -14), (-14, 0, -14)))
    tiers = [(1.75, 0.55, 1.9), (1.4, 1.35, 2.75), (1.05, 2.15, 3.5), (0.72, 2.95, 4.3)]
    crown = [lathe([(0.15, y + 0.18), (radius * 0.9, y - 0.02), (radius, y), (radius * 0.55, y + 0.42 * (top - y)), (0, top)], 28) for radius, y, top in tiers]
    tree.part("tree", "needles", join(crown))
    tree.part("trunk", "bark", lathe([(0.2, 0), (0.16, 0.8)], 12))
    tree.part("tip", "star", star(5, 0.3, 0.12, 0.07).move(0, 4.5, 0))
    for name, x, z, size, turn in (("red", 1.7, 1.3, 0.55, 20), ("blue", 2.35, 0.75, 0.42, 50), ("gold", -1.75, 1.25, 0.5, -25), ("red", -2.4, 0.9, 0.33, 10)):
        tree.part(f"present_{name}", f"present_{name}", box((-size / 2, 0, -size / 2), (size / 2, size * 0.8, size / 2)).turn("y", turn).move(x, 0, z))
    kinds = {name: [] for name in ("ember", "amber", "ice", "rose", "leaf", "dim")}
    names = list(kinds)

    def surface(height):
        """The radius of the tree at a height: the largest of its tiers."""
        largest = 0.0
        for radius, y, top in tiers:
            if y <= height <= top:
                s = (height - y) / (top - y)
                largest = max(largest, radius * (1 - s * 0.45 / 0.42) if s < 0.42 else radius * 0.55 * (1 - s) / 0.58)
        return largest

    for i in range(330):
        share = (i + 0.5) / 330
        height = 0.56 + 3.7 * (1 - math.sqrt(1 - share))
        angle = i * math.pi * (3 - math.sqrt(5))
        # Many are tiny, few are large: a power law.
        size = 0.012 + 0.03 * rng.random() ** 5
        radius = surface(height) + 0.6 * size + 0.02
        kinds[names[rng.randrange(6)]].append(octahedron().scale(size).move(radius * math.sin(angle), height, radius * math.cos(angle)))
    # A string of lamps over the snow.
    for i in range(60):
        angle = TAU * i / 60
        radius = 3.6 + 0.25 * math.sin(5 * angle)
        kinds[names[i % 6]].append(octahedron().scale(0.02 + 0.012 * (i % 3)).move(radius * math.sin(angle), 0.05, radius * math.cos(angle)))
    for name, lights in kinds.items():
        tree.part(name, name, join(lights))
    tree.write(out / "many-lights" / "tree.obj", smooth=())


def plates(out):
    camera = (0.0, 2.0, 13.0)
    lamps_at = (0.0, 4.6, -2.6)
    stage = Obj("Eric Veach's experiment: four plates, each turned so that it mirrors the row of lamps to the camera.")
    stage.part("floor", "stage", quad((-14, -2.4, 14), (14, -2.4, 14), (14, -2.4, -5), (-14, -2.4, -5)))
    stage.part("wall", "stage", quad((-14, -2.4, -5), (14, -2.4, -5), (14, 10, -5), (-14, 10, -5)))
    for i, (y, z) in enumerate(((1.75, -1.6), (0.55, 0.1), (-0.45, 1.6), (-1.2, 3.2))):
        centre = (0, y, z)
        normal = unit(add(unit(sub(camera, centre)), unit(sub(lamps_at, centre))))
        x, y = (1, 0, 0), normal
        stage.part(f"plate_{i}", f"plate_{i}", box((-3.4, -0.04, -0.55), (3.4, 0, 0.55)).place(centre, x, y, cross(x, y)))
    stage.write(out / "plates" / "stage.obj")
    lights = Obj("Four lamps of equal power: radius 0.04, 0.12, 0.36 and 0.9. Their radiance goes with 1 / radius^2.")
    for i, (x, radius) in enumerate(((-2.7, 0.04), (-1.3, 0.12), (0.1, 0.36), (2.1, 0.9))):
        lights.part(f"lamp_{i}", f"lamp_{i}", geodesic(3 if radius < 0.3 else 5).scale(radius).move(x, lamps_at[1], lamps_at[2]))
    lights.write(out / "plates" / "lights.obj")


def spotlights(out):
    stage = Obj("A pavilion open to the front, with a plinth, and a fence beside it in the sun.")
    stage.part("floor", "floor", quad((-5.6, 0, 4), (5.6, 0, 4), (5.6, 0, -2.2), (-5.6, 0, -2.2)))
    stage.part("wall", "wall", box((-3.6, 0, -2.2), (3.6, 3.1, -2)))
    stage.part("roof", "wall", box((-3.8, 3.1, -2.3), (3.8, 3.25, -0.9)))
    stage.part("plinth", "plinth", box((1.5, 0, -1.55), (2.3, 0.7, -0.95)))
    pickets = [box((-3.1, 0, 1 + 0.32 * i), (-3.04, 0.9, 1.1 + 0.32 * i)) for i in range(9)]
    stage.part("fence", "wood", join(pickets + [box((-3.04, h, 0.9), (-2.98, h + 0.08, 3.8)) for h in (0.2, 0.62)]))
    stage.part("lamps", "metal", join([box((x - 0.07, 2.86, -1.77), (x + 0.07, 2.98, -1.63)) for x in (-2.7, -1.5, -0.3)]))
    stage.write(out / "spotlights" / "stage.obj")

    # A wall washer of our own: a round beam, a ring of its reflector around it, and a tail that is wider to the sides than to front and back.
    vertical = [0, 5, 10, 15, 20, 25, 30, 35, 40, 45, 50, 55, 60, 65, 70, 75, 80, 85, 90]
    horizontal = [0, 22.5, 45, 67.5, 90]

    def candela(theta, phi):
        beam = 900 * math.exp(-((theta / 16) ** 2))
        ring = 260 * math.exp(-(((theta - 36) / 6) ** 2))
        tail = 90 * math.cos(math.radians(theta)) * (1 + 0.8 * math.cos(math.radians(2 * phi)))
        return beam + ring + tail

    rows = [" ".join(f"{candela(theta, phi):.1f}" for theta in vertical) for phi in horizontal]
    lines = ["IESNA:LM-63-2002", "[TEST] none: made by scripts/make-scenes.py", "[MANUFAC] nobody", "[LUMINAIRE] wall washer", "TILT=NONE",
             f"1 -1 1 {len(vertical)} {len(horizontal)} 1 2 0 0 0", "1 1 20", " ".join(map(str, vertical)), " ".join(map(str, horizontal))]
    (out / "spotlights" / "wall-washer.ies").write_text("\n".join(lines + rows) + "\n")


def metals(out):
    stage = Obj("Three steps before a wall.")
    stage.part("steps", "stage", join([box((-8, -2, -5), (8, 0.62 * i, 1.5 - 1.05 * i)) for i in range(3)]))
    stage.part("wall", "stage", quad((-8, -2, -1.9), (8, -2, -1.9), (8, 7, -1.9), (-8, 7, -1.9)))
    stage.write(out / "metals" / "stage.obj")
    lamps = Obj("Two strips of light, above and to the left, and to the right.")
    lamps.part("key", "key", quad((-1.3, -2.2, 0), (1.3, -2.2, 0), (1.3, 2.2, 0), (-1.3, 2.2, 0)).turn("x", 40).turn("y", 140).move(-4.6, 5.4, 5.5))
    lamps.part("rim", "rim", quad((-0.5, -2.2, 0), (0.5, -2.2, 0), (0.5, 2.2, 0), (-0.5, 2.2, 0)).turn("y", -118).move(6.4, 2.8, 3.6))
    lamps.write(out / "metals" / "lamps.obj")


def frosted(out):
    stage = Obj("A table before a wall, and the frames of three panes.")
    stage.part("table", "table", quad((-9, 0, 9), (9, 0, 9), (9, 0, -3.2), (-9, 0, -3.2)))
    stage.part("wall", "wall", quad((-9, 0, -3.2), (9, 0, -3.2), (9, 8, -3.2), (-9, 8, -3.2)))
    frame = [box((-0.74, 0, -0.2), (0.74, 0.09, 0.2)), box((-0.7, 0.09, -0.1), (-0.66, 1.84, 0.1)), box((0.66, 0.09, -0.1), (0.7, 1.84, 0.1)), box((-0.7, 1.8, -0.1), (0.7, 1.84, 0.1))]
    stage.part("frames", "frames", join([part.move(x, 0, 0) for part in frame for x in (-2.1, 0, 2.1)]))
    stage.write(out / "frosted" / "stage.obj")
    sheet = Obj("A sheet without a thickness, 1.3 wide and 1.7 high, upright.")
    sheet.part("sheet", None, quad((-0.65, 0, 0), (0.65, 0, 0), (0.65, 1.7, 0), (-0.65, 1.7, 0)))
    sheet.write(out / "frosted" / "sheet.obj")
    slab = Obj("The same as a slab of 0.16.")
    slab.part("slab", None, box((-0.65, 0, -0.08), (0.65, 1.7, 0.08)))
    slab.write(out / "frosted" / "slab.obj")


def liquid(out):
    stage = Obj("A table, and a bright panel behind it.")
    stage.part("table", "table", quad((-12, 0, 10), (12, 0, 10), (12, 0, -4), (-12, 0, -4)))
    stage.part("panel", "panel", quad((-7, 0, -4), (7, 0, -4), (7, 6, -4), (-7, 6, -4)))
    stage.write(out / "liquid" / "stage.obj")

    def filled(name, comment, dry, wet, dye):
        """A glass whose faces are: those to air; those to the liquid, which are modelled once; the liquid's own surface; and the dye in it."""
        glass = Obj(comment)
        dry = [p for p, before in zip(dry, [None] + dry) if p != before]
        glass.part("dry", "glass", lathe(dry, 96))
        glass.part("wet", "glass to liquid", lathe(wet, 96))
        glass.part("surface", "liquid", lathe([wet[0], (0, wet[0][1])], 96))
        glass.write(out / "liquid" / f"{name}.obj")
        inside = Obj("What is dissolved in the liquid: nearly all of it, a hair away from the glass and the surface.")
        inside.part("dye", None, lathe(dye, 96))
        inside.write(out / "liquid" / f"{name}-dye.obj")

    def arc(x, y, r, first, last, n=6):
        """Part of a circle in the plane of the profile, from one angle to another; 0 is outwards, 90 up."""
        angles = [math.radians(first + (last - first) * i / n) for i in range(n + 1)]
        return [(x + r * math.cos(a), y + r * math.sin(a)) for a in angles]

    h = 0.002
    level = 1.02
    filled("tumbler", "A tumbler with a thick bottom, 1.4 high, and what it is filled with. It stands 0.002 above its origin.",
           [(0, 0.002)] + arc(0.43, 0.062, 0.06, -90, 0) + arc(0.468, 1.38, 0.022, 0, 180) + [(0.446, level)],
           [(0.446, level)] + arc(0.37, 0.236, 0.076, 0, -90) + [(0, 0.16)],
           [(0, 0.16 + h)] + arc(0.37, 0.236, 0.076 - h, -90, 0) + [(0.446 - h, level - h), (0, level - h)])
    rim, tip, level = (0.74, 1.5), 0.86, 1.36
    slope = (rim[0] - 0.012) / (rim[1] - tip)
    at = lambda y: slope * (y - tip)
    filled("cocktail", "A cocktail glass, 1.5 high, and what it is filled with. It stands 0.002 above its origin.",
           [(0, 0.002)] + arc(0.44, 0.014, 0.012, -90, 70) + [(0.3, 0.045), (0.12, 0.09), (0.055, 0.16), (0.04, 0.3), (0.038, 0.6), (0.05, 0.74), (0.09, 0.82)]
           + arc(rim[0], rim[1], 0.012, -40, 140) + [(at(level), level)],
           [(at(level), level), (0, tip)], [(0, tip + 3 * h), (at(level) - 2 * h, level - h), (0, level - h)])


def brushed(out):
    stage = Obj("A table before a wall, and a lamp on each side.")
    stage.part("table", "table", sweep(24, 9, 8, 2.5, 16).move(0, 0, -1.6))
    stage.part("left", "left", quad((-0.35, -1.6, 0), (0.35, -1.6, 0), (0.35, 1.6, 0), (-0.35, 1.6, 0)).turn("x", 20).turn("y", 130).move(-4.6, 3.2, 3.2))
    stage.part("right", "right", quad((-0.3, -1, 0), (0.3, -1, 0), (0.3, 1, 0), (-0.3, 1, 0)).turn("x", 40).turn("y", 180).move(1.1, 5.4, 5.2))
    stage.write(out / "brushed" / "stage.obj", smooth=("table",))
    bevel = 0.03
    pot = [(0, 0.002), (0.98, 0.002), (1.0, bevel), (1.0, 1.02), (0.985, 1.04), (0.96, 1.04), (0.95, 1.02), (0.95, 0.1), (0, 0.1)]
    pan = Obj("A pot that was turned on a lathe, 1.04 high: u goes around its axis, along the grooves.", mapped=True)
    pan.part("pot", None, turned(pot, 120))
    pan.write(out / "brushed" / "pot.obj")
    lid = [(0, 0), (1.02, 0), (1.04, 0.02), (1.02, 0.05)] + [(r, 0.05 + 0.16 * (1 - (r / 1.02) ** 2)) for r in (0.9, 0.75, 0.6, 0.45, 0.3, 0.2, 0.12, 0.05, 0)]
    cover = Obj("Its lid, turned, too, around +y.", mapped=True)
    cover.part("lid", None, turned(lid, 120))
    cover.write(out / "brushed" / "lid.obj")
    board = Obj("A plate that was brushed in straight lines along u, which is its x axis: 2.4 x 1.2, standing.", mapped=True)
    w, h, t = 1.2, 1.2, 0.05
    board.part("plate", None, quad((-w, 0, t), (w, 0, t), (w, h, t), (-w, h, t)))
    corners = [(w, 0, t), (w, 0, -t), (w, h, -t), (w, h, t), (-w, h, t), (-w, h, -t), (-w, 0, -t), (-w, 0, t)]
    # Coordinates that no side sees from the edge.
    board.part("sides", None, Shape(corners, [[0, 1, 2, 3], [3, 2, 5, 4], [4, 5, 6, 7], [1, 6, 5, 2]], [(x + 2 * z, y + z) for x, y, z in corners]))
    board.write(out / "brushed" / "plate.obj")


def car_paint(out):
    folder = out / "car-paint"
    stage = Obj("A backdrop, and four long lamps, three over it and one behind.")
    stage.part("backdrop", "backdrop", sweep(28, 14, 9, 4, 10).move(0, 0, -3))
    for name, x in (("left", -3.4), ("middle", 0), ("right", 3.4)):
        stage.part(name, name, quad((x - 0.5, 4.6, -3), (x + 0.5, 4.6, -3), (x + 0.5, 4.3, 4), (x - 0.5, 4.3, 4)))
    stage.part("back", "back", quad((-4.5, 2.5, -5), (4.5, 2.5, -5), (4.5, 3.2, -5.2), (-4.5, 3.2, -5.2)))
    stage.write(folder / "stage.obj", smooth=("backdrop",))
    car = Obj("A toy car, 3 long: it looks along +x and stands on the origin.")
    car.part("body", "paint", join([cushion((1.5, 0.3, 0.66), (0.55, 0.5), 64, 20).move(0, 0.58, 0),
                                    cushion((0.52, 0.12, 0.55), (0.6, 0.5), 40, 12).move(0.75, 0.8, 0)]))
    car.part("cabin", "window", cushion((0.72, 0.4, 0.52), (0.65, 0.55), 48, 16).move(-0.25, 0.88, 0))
    car.part("roof", "paint", cushion((0.56, 0.12, 0.45), (0.6, 0.5), 40, 12).move(-0.27, 1.22, 0))
    wheel = tube([(0.26 * math.cos(TAU * i / 28), 0.26 * math.sin(TAU * i / 28), 0) for i in range(28)], 0.11, 12, closed=True)
    hub = cushion((0.2, 0.2, 0.07), (1, 1), 24, 8)
    ends = [(x, 0.37, z) for x in (-0.92, 0.92) for z in (-0.6, 0.6)]
    car.part("wheels", "rubber", join([wheel.move(*at) for at in ends]))
    car.part("hubs", "chrome", join([hub.move(*at) for at in ends]))
    eye = cushion((0.05, 0.12, 0.12), (1, 1), 20, 8)
    car.part("eyes", "chrome", join([eye.move(1.46, 0.62, z) for z in (-0.36, 0.36)]))
    bumper = cushion((0.06, 0.06, 0.62), (0.7, 0.7), 20, 8)
    car.part("bumpers", "chrome", join([bumper.move(x, 0.4, 0) for x in (-1.5, 1.5)]))
    car.write(folder / "car.obj", smooth=("body", "cabin", "roof", "wheels", "hubs", "eyes", "bumpers"))


def normals(size, height):
    """A map of the normals of heights in texels, which repeat; green is up."""
    pixels = []
    for y in range(size):
        for x in range(size):
            across = (height[y][(x + 1) % size] - height[y][x - 1]) / 2
            upwards = (height[y - 1][x] - height[(y + 1) % size][x]) / 2
            pixels.append(tuple(byte(127.5 + 127.5 * c) for c in unit((-across, -upwards, 1))))
    return pixels


def step(x, low, high):
    """From 0 at `low` to 1 at `high`, smoothly."""
    t = max(0, min(1, (x - low) / (high - low)))
    return t * t * (3 - 2 * t)


def brick_wall(out):
    folder = out / "brick-wall"
    folder.mkdir(parents=True, exist_ok=True)
    f = noise(1)
    # The normals of textures/bricks.png: the same bricks, each a little askew, with rounded edges and a rough face; the mortar lies deeper.
    size, rows, columns, rng = 256, 8, 4, random.Random(3)
    lean = [[(rng.uniform(-0.05, 0.05), rng.uniform(-0.1, 0.1), rng.uniform(0, 0.8)) for _ in range(columns)] for _ in range(rows)]
    height = []
    for y in range(size):
        line = []
        for x in range(size):
            row, bx, edge = brick(f, size, rows, columns, x, y)
            right, down, out_of = lean[row][int(bx)]
            face = 3.4 + out_of + right * (bx % 1 - 0.5) * size / columns + down * (y % (size // rows) - 16)
            rough = 0.9 * f(x / 5, y / 5, 51) + 0.5 * f(x / 2, y / 2, 128)
            line.append(face * step(edge, 0.5, 4.5) + rough)
        height.append(line)
    write_png(folder / "bricks-normals.png", size, size, normals(size, height))
    # Heights of cobbles: round stones around points that repeat, sand between them.
    size, rng = 128, random.Random(5)
    seeds = [((i + rng.uniform(0.2, 0.8)) * size / 7, (j + rng.uniform(0.2, 0.8)) * size / 7) for i in range(7) for j in range(7)]
    around = [(x + dx, y + dy) for x, y in seeds for dx in (-size, 0, size) for dy in (-size, 0, size)]
    pixels = []
    for y in range(size):
        for x in range(size):
            first, second = sorted(math.hypot(x - a, y - b) for a, b in around)[:2]
            stone = math.sqrt(step(second - first, 0.5, 11)) * (1 - 0.012 * first)
            pixels.append(byte(30 + 205 * stone + 20 * f(x / 2, y / 2, 64)))
    write_png(folder / "cobbles.png", size, size, pixels)
    # A plate of metal: a bevelled rim, four rivets, and a star with ridges.
    size, height = 192, []
    for y in range(size):
        line = []
        for x in range(size):
            u, v = 2 * (x + 0.5) / size - 1, 1 - 2 * (y + 0.5) / size
            rim = 1 - max(abs(u), abs(v))
            h = 5 * step(rim, 0.0, 0.05) - 3 * step(rim, 0.1, 0.16)
            corner = math.hypot(abs(u) - 0.74, abs(v) - 0.74)
            h += 5 * math.sqrt(max(0, 1 - (corner / 0.075) ** 2))
            angle, radius = math.atan2(u, v), math.hypot(u, v)
            turn = abs((angle * 5 / TAU + 0.5) % 1 - 0.5) * TAU / 5
            # How far inside the edge from a tip to the notch beside it; the ridge runs from tip to middle.
            tip, notch = (0.66, 0), (0.27 * math.cos(TAU / 10), 0.27 * math.sin(TAU / 10))
            px, py = radius * math.cos(turn), radius * math.sin(turn)
            ex, ey = notch[0] - tip[0], notch[1] - tip[1]
            inside = (ey * (px - tip[0]) - ex * (py - tip[1])) / math.hypot(ex, ey)
            h += 60 * max(0, min(inside, 0.2))
            line.append(h)
        height.append(line)
    write_png(folder / "star-normals.png", size, size, normals(size, height))

    alley = Obj("A brick wall, cobbles, a plate on the wall, and two lamps that graze it.", mapped=True)
    alley.part("wall", "bricks", quad((-4, 0, 0), (4, 0, 0), (4, 4, 0), (-4, 4, 0), (4, 2)))
    alley.part("ground", "cobbles", quad((-4, 0, 4), (4, 0, 4), (4, 0, 0), (-4, 0, 0), (4, 2)))
    alley.part("plate", "plate", quad((0.15, 1.15, 0.04), (1.05, 1.15, 0.04), (1.05, 2.05, 0.04), (0.15, 2.05, 0.04)))
    alley.part("edge", "iron", box((0.13, 1.13, 0), (1.07, 2.07, 0.039)))
    alley.part("lamp", "warm", geodesic(4).scale(0.09).move(-1.35, 2.35, 0.3))
    alley.part("bracket", "iron", join([box((-1.375, 2.46, 0), (-1.325, 2.5, 0.32)), box((-1.36, 2.42, 0.28), (-1.34, 2.48, 0.32))]))
    alley.part("second", "cool", geodesic(4).scale(0.07).move(2.15, 0.5, 0.25))
    alley.part("foot", "iron", box((2.1, 0, 0.2), (2.2, 0.42, 0.3)))
    alley.write(folder / "alley.obj")


def main():
    here = Path(__file__).resolve().parent.parent
    out = Path(sys.argv[1]) if len(sys.argv) > 1 else here / "scenes"
    for make in (shapes, shadows, directions, extinction, lamps, mirror, glass, lens, textures, environment, many_lights, plates, spotlights,
                 metals, frosted, liquid, brushed, car_paint, brick_wall):
        make(out)


if __name__ == "__main__":
    main()
