"""pictures.py: what a picture shows in numbers, what it ought to show, and sheets of many."""

import json
import struct

import numpy as np
from PIL import Image, ImageDraw

COMPONENTS = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


def linear(path):
    """Light [h, w, 3] and which pixels are covered [h, w] of an sRGB picture."""
    pixels = np.asarray(Image.open(path).convert("RGBA"), np.float64) / 255
    low = pixels <= 0.04045
    light = np.where(low, pixels / 12.92, ((pixels + 0.055) / 1.055) ** 2.4)
    return light[..., :3], pixels[..., 3] == 1


# ---- what it ought to show


def read_glb(path):
    """[(positions, triangles, occlusion)] of a result whose nodes stand at the origin."""
    data = path.read_bytes()
    length = struct.unpack("<I", data[12:16])[0]
    gltf = json.loads(data[20:20 + length])
    binary = data[28 + length:]

    def array(index):
        accessor = gltf["accessors"][index]
        view = gltf["bufferViews"][accessor["bufferView"]]
        kind = np.dtype(COMPONENTS[accessor["componentType"]])
        shape = (accessor["count"], WIDTHS[accessor["type"]])
        stride = view.get("byteStride", shape[1] * kind.itemsize)
        start = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        return np.ndarray(shape, kind, binary, start, (stride, kind.itemsize)).squeeze(1 if shape[1] == 1 else ())

    return [(array(primitive["attributes"]["POSITION"]).astype(np.float64),
             array(primitive["indices"]).reshape(-1, 3), array(primitive["attributes"]["_OCCLUSION"]))
            for mesh in gltf["meshes"] for primitive in mesh["primitives"]]


def visibility(parts, camera, size):
    """The interpolated visibility [size, size] as the camera sees it, NaN where it sees nothing."""
    frame = np.array([camera["right"], camera["up"], camera["back"]])
    candidates = []
    for positions, triangles, occlusion in parts:
        seen = (positions - camera["center"]) @ frame.T / camera["half"]
        seen[:, 0] = (seen[:, 0] + 1) * size / 2 - 0.5  # pixel centres at whole numbers
        seen[:, 1] = (1 - seen[:, 1]) * size / 2 - 0.5
        a, b, c = (seen[triangles[:, i]] for i in range(3))
        low = np.ceil(np.minimum(np.minimum(a, b), c)[:, :2]).astype(int).clip(0, size)
        high = (np.floor(np.maximum(np.maximum(a, b), c)[:, :2]).astype(int) + 1).clip(0, size)
        extent = (high - low).clip(0)
        count = extent.prod(1)
        owner = np.repeat(np.arange(len(triangles)), count)  # one row per pixel of a triangle's box
        nth = np.arange(len(owner)) - np.repeat(np.cumsum(count) - count, count)
        x = low[owner, 0] + nth % extent[owner, 0]
        y = low[owner, 1] + nth // extent[owner, 0]
        a, b, c = a[owner], b[owner], c[owner]
        twice = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
        with np.errstate(divide="ignore", invalid="ignore"):
            v = ((x - a[:, 0]) * (c[:, 1] - a[:, 1]) - (y - a[:, 1]) * (c[:, 0] - a[:, 0])) / twice
            w = ((b[:, 0] - a[:, 0]) * (y - a[:, 1]) - (b[:, 1] - a[:, 1]) * (x - a[:, 0])) / twice
        inside = (v >= 0) & (w >= 0) & (v + w <= 1)
        weights = np.stack([1 - v - w, v, w], 1)[inside]
        corners = 1 - occlusion[triangles[owner[inside]]]
        depth = (weights * np.stack([a[:, 2], b[:, 2], c[:, 2]], 1)[inside]).sum(1)
        candidates.append(np.stack([y[inside] * size + x[inside], depth, (weights * corners).sum(1)]))
    pixel, depth, value = np.concatenate(candidates, 1)
    nearest_last = np.argsort(depth, kind="stable")
    picture = np.full(size * size, np.nan)
    picture[pixel[nearest_last].astype(int)] = value[nearest_last]
    return picture.reshape(size, size)


def against(picture, truth, bare=None):
    """Means over the pixels that both cover, and the root mean square of the differences. With a
    picture without occlusion: what remains of its light."""
    light, covered = linear(picture)
    covered &= ~np.isnan(truth)
    if bare:
        white, also = linear(bare)
        covered &= also & (white.min(2) > 0.02)
        light = light / np.maximum(white, 0.02)
    shown, wanted = light[covered].mean(1), truth[covered]
    return {"screen": shown.mean(), "truth": wanted.mean(), "difference": shown.mean() - wanted.mean(),
            "rms": np.sqrt(((shown - wanted) ** 2).mean()), "pixels": int(covered.sum())}


def difference(a, b):
    """The largest mean difference of a colour channel between two pictures, in linear light."""
    (first, covered), (second, also) = linear(a), linear(b)
    return abs(first[covered & also] - second[covered & also]).mean(0).max()


# ---- sheets


def save_grey(values, path):
    light = np.nan_to_num(values).clip(0, 1)
    encoded = np.where(light <= 0.0031308, light * 12.92, 1.055 * light ** (1 / 2.4) - 0.055)
    alpha = np.where(np.isnan(values), 0, 255)
    grey = np.rint(encoded * 255)
    Image.fromarray(np.stack([grey, grey, grey, alpha], 2).astype(np.uint8)).save(path)


def sheet(path, rows, side=200):
    """rows: [(label, [(label, picture or None)])]; on middle grey, as PNG of at most 256 colours."""
    margin, head = 64, 14
    columns = max(len(cells) for _, cells in rows)
    image = Image.new("RGB", (margin + columns * side, len(rows) * (side + head)), (110, 110, 110))
    draw = ImageDraw.Draw(image)
    for y, (label, cells) in enumerate(rows):
        top = y * (side + head)
        draw.text((4, top + head + side // 2), label, fill="white")
        for x, (name, picture) in enumerate(cells):
            left = margin + x * side
            draw.text((left + 4, top + 1), name, fill="white")
            if picture:
                cell = Image.open(picture).convert("RGBA").resize((side, side), Image.LANCZOS)
                image.paste(cell, (left, top + head), cell)
    image.quantize(256, dither=Image.Dither.NONE).save(path, optimize=True)
