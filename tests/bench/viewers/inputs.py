"""inputs.py: the same mesh as OBJ and as glTF, and a small scene, plain and textured, to be baked."""

import json
import struct
import zlib

import numpy as np


def read_obj(path):
    """Positions [n, 3] and triangles [m, 3]; whatever else the file has is passed over."""
    positions, triangles = [], []
    for line in path.read_text().splitlines():
        words = line.split()
        if words[:1] == ["v"]:
            positions.append([float(word) for word in words[1:4]])
        elif words[:1] == ["f"]:
            corners = [int(word.split("/")[0]) - 1 for word in words[1:]]
            triangles += [[corners[0], *corners[i:i + 2]] for i in range(1, len(corners) - 1)]
    return np.array(positions, np.float32), np.array(triangles, np.uint32)


def write_obj(path, positions, triangles):
    lines = ["v " + " ".join(map(repr, point)) for point in positions.tolist()]
    lines += ["f " + " ".join(map(str, corners)) for corners in (triangles + 1).tolist()]
    path.write_text("\n".join(lines) + "\n")


class Gltf:
    """A glTF that grows: arrays become accessors of one buffer."""

    def __init__(self):
        self.binary = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
                     "nodes": [{"mesh": 0}], "meshes": [{"primitives": []}], "materials": [],
                     "accessors": [], "bufferViews": []}

    def view(self, data):
        self.json["bufferViews"].append({"buffer": 0, "byteOffset": len(self.binary),
                                         "byteLength": len(data)})
        self.binary += data + bytes(-len(data) % 4)
        return len(self.json["bufferViews"]) - 1

    def accessor(self, array):
        kind = {1: "SCALAR", 2: "VEC2", 3: "VEC3"}[1 if array.ndim == 1 else array.shape[1]]
        accessor = {"bufferView": self.view(array.tobytes()), "count": len(array), "type": kind,
                    "componentType": 5125 if array.dtype == np.uint32 else 5126}
        if kind == "VEC3":
            accessor |= {"min": array.min(0).tolist(), "max": array.max(0).tolist()}
        self.json["accessors"].append(accessor)
        return len(self.json["accessors"]) - 1

    def primitive(self, positions, triangles, material, texcoords=None):
        attributes = {"POSITION": self.accessor(positions)}
        if texcoords is not None:
            attributes["TEXCOORD_0"] = self.accessor(texcoords)
        self.json["materials"].append(material)
        self.json["meshes"][0]["primitives"].append(
            {"attributes": attributes, "indices": self.accessor(triangles.reshape(-1)),
             "material": len(self.json["materials"]) - 1})

    def texture(self, png):
        self.json["images"] = [{"bufferView": self.view(png), "mimeType": "image/png"}]
        self.json["textures"] = [{"source": 0}]

    def write(self, path):
        """.glb: one file; .gltf: with a .bin beside it."""
        buffer = {"byteLength": len(self.binary)}
        if path.suffix == ".gltf":
            buffer["uri"] = f"{path.stem}.bin"
            path.with_suffix(".bin").write_bytes(self.binary)
            path.write_text(json.dumps({**self.json, "buffers": [buffer]}))
            return
        text = json.dumps({**self.json, "buffers": [buffer]}).encode()
        text += b" " * (-len(text) % 4)
        path.write_bytes(struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.binary)) +
                         struct.pack("<I4s", len(text), b"JSON") + text +
                         struct.pack("<I4s", len(self.binary), b"BIN\0") + self.binary)


def matt(color=(1, 1, 1, 1), **others):
    return {"doubleSided": True, "pbrMetallicRoughness":
            {"baseColorFactor": list(color), "metallicFactor": 0, "roughnessFactor": 1, **others}}


def untextured(positions, triangles):
    gltf = Gltf()
    gltf.primitive(positions, triangles, matt())
    return gltf


def png(pixels):
    """RGB bytes [height, width, 3] as a PNG."""
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    rows = b"".join(b"\0" + row.tobytes() for row in pixels)
    return (b"\x89PNG\r\n\x1a\n" +
            chunk(b"IHDR", struct.pack(">IIBBBBB", pixels.shape[1], pixels.shape[0], 8, 2, 0, 0, 0)) +
            chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b""))


def grid(corner, side, other, cells):
    """A parallelogram of cells x cells quads; its texture coordinates run from 0 to 1."""
    s, t = np.meshgrid(np.linspace(0, 1, cells + 1), np.linspace(0, 1, cells + 1))
    texcoords = np.stack([s.ravel(), t.ravel()], 1).astype(np.float32)
    positions = np.array(corner) + texcoords[:, :1] * np.array(side) + texcoords[:, 1:] * np.array(other)
    row = cells + 1
    first = (np.arange(cells)[:, None] * row + np.arange(cells)).ravel()
    quads = np.stack([first, first + 1, first + row + 1, first, first + row + 1, first + row], 1)
    return positions.astype(np.float32), quads.reshape(-1, 3).astype(np.uint32), texcoords


def joined(parts):
    offsets = np.cumsum([0] + [len(part[0]) for part in parts])
    return (np.concatenate([part[0] for part in parts]),
            np.concatenate([part[1] + offset for part, offset in zip(parts, offsets)]).astype(np.uint32),
            np.concatenate([part[2] for part in parts]))


def block(low, high, cells):
    (x, y, z), (X, Y, Z) = low, high
    a, b, c = (X - x, 0, 0), (0, Y - y, 0), (0, 0, Z - z)
    faces = [((x, y, Z), a, b), ((X, y, z), (x - X, 0, 0), b), ((X, y, Z), (0, 0, z - Z), b),
             ((x, y, z), c, b), ((x, Y, Z), a, (0, 0, z - Z)), ((x, y, z), a, c)]
    return joined([grid(*face, cells) for face in faces])


def corner():
    """Two walls and a floor, finely cut, and a box that hangs there: positions, triangles, texcoords."""
    room = [grid((0, 0, 4), (4, 0, 0), (0, 0, -4), 64), grid((0, 0, 0), (4, 0, 0), (0, 2.5, 0), 64),
            grid((0, 0, 4), (0, 0, -4), (0, 2.5, 0), 64)]
    return joined([*room, block((1, 0.3, 1), (2.4, 1.3, 2.4), 24)])


def textured(positions, triangles, texcoords):
    """With a coloured checker."""
    gltf = Gltf()
    squares = (np.indices((8, 8)).sum(0) % 2)[..., None]
    checker = np.where(squares, np.uint8([226, 120, 60]), np.uint8([60, 130, 190])).astype(np.uint8)
    gltf.texture(png(checker.repeat(16, 0).repeat(16, 1)))
    gltf.primitive(positions, triangles, matt(baseColorTexture={"index": 0}), texcoords)
    return gltf
