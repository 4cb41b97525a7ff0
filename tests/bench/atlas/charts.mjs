// charts.mjs: charts of xatlas (npm watlas) beside ours, judged alike.
//
//     node charts.mjs MODULES FOLDER SIZE TRIANGLES NAME...
//
// Reads what tests/bench/atlas_tables.cpp wrote and prints JSON: per name {ours, xatlas}, the latter
// only for meshes of at most TRIANGLES triangles. xatlas has default options, SIZE as resolution and
// a padding that keeps charts as far apart as ours.

import fs from 'node:fs';
import path from 'node:path';

const [modules, folder, size, most, ...names] = process.argv.slice(2);
const watlas = await import(path.resolve(modules, 'node_modules/watlas/dist/watlas.js'));
await watlas.Initialize();

function array(Type, file) {
    const bytes = fs.readFileSync(file);
    return new Type(bytes.buffer, bytes.byteOffset, bytes.byteLength / Type.BYTES_PER_ELEMENT);
}

const minus = (a, b) => a.map((x, i) => x - b[i]);
const length = (a) => Math.hypot(...a);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2],
                         a[0] * b[1] - a[1] * b[0]];

// Seams: edges of two triangles whose corners there are not the same, their length over the root of
// the area. Stretch: a triangle's share of the map over its share of the surface, or one over it.
function judge(places, corners, uvs, uvCorners) {
    const place = (i) => [places[3 * i], places[3 * i + 1], places[3 * i + 2]];
    const uv = (i) => [uvs[2 * i], uvs[2 * i + 1]];
    const edges = new Map();
    const triangles = [];
    for (let t = 0; t < corners.length; t += 3) {
        const [a, b, c] = [0, 1, 2].map((k) => place(corners[t + k]));
        const [p, q, r] = [0, 1, 2].map((k) => uv(uvCorners[t + k]));
        const [e, f] = [minus(q, p), minus(r, p)];
        triangles.push([length(cross(minus(b, a), minus(c, a))) / 2,
                        Math.abs(e[0] * f[1] - e[1] * f[0]) / 2]);
        for (let k = 0; k < 3; ++k) {
            let ends = [t + k, t + (k + 1) % 3];
            if (corners[ends[0]] > corners[ends[1]])
                ends.reverse();
            const key = corners[ends[0]] * 2 ** 26 + corners[ends[1]];
            if (!edges.has(key))
                edges.set(key, []);
            edges.get(key).push(ends);
        }
    }
    const area = triangles.reduce((sum, [own]) => sum + own, 0);
    const inMap = triangles.reduce((sum, [, own]) => sum + own, 0);
    let seam = 0;
    for (const sides of edges.values()) {
        if (sides.length === 2 &&
            [0, 1].some((k) => uvCorners[sides[0][k]] !== uvCorners[sides[1][k]]))
            seam += length(minus(...sides[0].map((corner) => place(corners[corner]))));
    }
    let stretch = 0, largest = 1;
    for (const [own, flat] of triangles) {
        if (own === 0 || flat === 0)
            continue;
        const ratio = (flat / inMap) / (own / area);
        stretch += own * Math.max(ratio, 1 / ratio);
        largest = Math.max(largest, ratio, 1 / ratio);
    }
    return { seam: seam / Math.sqrt(area), stretch: stretch / area, largest };
}

function xatlas(places, corners) {
    const start = performance.now();
    const atlas = new watlas.Atlas();
    atlas.addMesh({ vertexPositionData: places, vertexCount: places.length / 3,
                    vertexPositionStride: 12, indexData: corners, indexCount: corners.length });
    atlas.generate({}, { resolution: Number(size), padding: 8 });
    const seconds = (performance.now() - start) / 1000;
    const mesh = atlas.getMesh(0);
    const uvCorners = new Uint32Array(mesh.indexCount);
    mesh.getIndexArray(uvCorners);
    const uvs = new Float32Array(2 * mesh.vertexCount);
    for (let i = 0; i < mesh.vertexCount; ++i)
        uvs.set(mesh.getVertex(i).uv, 2 * i);
    const use = new Float32Array(atlas.atlasCount);
    atlas.getUtilization(use);
    const found = { charts: atlas.chartCount, use: use[0], seconds,
                    ...judge(places, corners, uvs, uvCorners) };
    atlas.delete();
    return found;
}

const rows = {};
for (const name of names) {
    const read = (Type, kind) => array(Type, path.join(folder, `${name}.${kind}`));
    const places = read(Float32Array, 'places'), corners = read(Uint32Array, 'corners');
    rows[name] = { ours: judge(places, corners, read(Float32Array, 'uvs'),
                               read(Uint32Array, 'uv_corners')) };
    if (corners.length / 3 <= Number(most))
        rows[name].xatlas = xatlas(places, corners);
}
console.log(JSON.stringify(rows));
