// A mesh of a page, read from its element and prepared to be drawn: `hsdm.read(element)`; the rest is for viewer.js.
// Lengths are those of the page's own space, the mesh's coordinates less its centre over its radius.
"use strict";
var hsdm = (function () {
    // ---- The data of a mesh element -----------------------------------------------------------------------

    const NOWHERE = -32768; // a vertex or point without a deviation

    function bytes(text) {
        const raw = atob(text || ""), out = new Uint8Array(raw.length);
        for (let i = 0; i < raw.length; ++i) out[i] = raw.charCodeAt(i);
        return out;
    }

    // Whole numbers, seven bits a byte, the least first; all but the last byte of a number have the eighth bit.
    function reader(text) {
        const data = bytes(text);
        let at = 0;
        const next = () => {
            let value = 0, shift = 1, byte;
            do {
                byte = data[at++];
                value += (byte & 127) * shift;
                shift *= 128;
            } while (byte > 127);
            return value;
        };
        return {
            more: () => at < data.length,
            next,
            signed: () => { const v = next(); return v % 2 ? -(v + 1) / 2 : v / 2; },
        };
    }

    // Facets as corners with where each begins, and the triangles that they are cut into.
    function readFacets(json) {
        const from = reader(json.facets);
        const first = new Uint32Array(json.facet_count + 1), corners = new Uint32Array(json.corner_count);
        const triangles = new Uint32Array(3 * (json.corner_count - 2 * json.facet_count)); // corners, not vertices
        let c = 0, t = 0, last = 0;
        for (let f = 0; f < json.facet_count; ++f) {
            const size = from.next();
            for (let k = 0; k < size; ++k) corners[c + k] = last += from.signed();
            if (size < 5) {
                for (let k = 2; k < size; ++k) { triangles[t++] = c; triangles[t++] = c + k - 1; triangles[t++] = c + k; }
            } else {
                for (let k = 0; k < 3 * (size - 2); ++k) triangles[t++] = c + from.next();
            }
            first[f + 1] = c += size;
        }
        return {first, corners, triangles};
    }

    function readPairs(text) {
        const from = reader(text), pairs = [];
        let last = 0;
        while (from.more()) pairs.push(last += from.signed());
        return pairs;
    }

    // What an element of mesh_element() holds.
    function read(element) {
        const json = JSON.parse(element.textContent);
        const data = Object.assign({}, json, readFacets(json));
        data.positions = new Float32Array(bytes(json.positions).buffer);
        data.deviations = json.deviations ? new Int16Array(bytes(json.deviations).buffer) : null;
        data.confidence = json.confidence ? bytes(json.confidence) : null;
        data.completed = json.completed ? bytes(json.completed) : null;
        data.sharp = readPairs(json.sharp_edges);
        data.corner_vertices = readPairs(json.corner_vertices);
        if (json.points) {
            data.points = new Int16Array(bytes(json.points).buffer);
            data.point_deviations = new Int16Array(bytes(json.point_deviations).buffer);
        }
        return data;
    }

    const MANY = 60000; // triangles that large ones are divided into, for their colours, at most
    const FEW = 15000;  // triangles: from more on a coarser mesh of about so many stands by, to turn

    // ---- Edges and smooth corners ---------------------------------------------------------------------------

    // The half-edges of each vertex that is the lesser of their two: half-edge c goes from corner c to the next.
    function halfEdges(data) {
        const {first, corners} = data, n = corners.length;
        const next = new Uint32Array(n), start = new Uint32Array(data.vertex_count + 1);
        for (let f = 0; f + 1 < first.length; ++f)
            for (let c = first[f]; c < first[f + 1]; ++c) next[c] = c + 1 < first[f + 1] ? c + 1 : first[f];
        for (let c = 0; c < n; ++c) ++start[Math.min(corners[c], corners[next[c]]) + 1];
        for (let v = 0; v < data.vertex_count; ++v) start[v + 1] += start[v];
        const fill = start.slice(), list = new Uint32Array(n);
        for (let c = 0; c < n; ++c) list[fill[Math.min(corners[c], corners[next[c]])]++] = c;
        return {next, start, list};
    }

    // All edges once, as pairs of vertices: smooth ones, sharp ones and those of one facet. Corners that meet
    // across smooth edges get one number.
    function connect(data) {
        const {corners} = data, {next, start, list} = halfEdges(data);
        const sharp = new Set();
        for (let i = 0; i < data.sharp.length; i += 2)
            sharp.add(Math.min(data.sharp[i], data.sharp[i + 1]) * 4294967296 + Math.max(data.sharp[i], data.sharp[i + 1]));
        const group = new Uint32Array(corners.length);
        for (let c = 0; c < group.length; ++c) group[c] = c;
        const find = (c) => {
            while (group[c] !== c) c = group[c] = group[group[c]];
            return c;
        };
        const join = (a, b) => { a = find(a); b = find(b); if (a < b) group[b] = a; else group[a] = b; };
        const edges = [], sharpEdges = [], borders = [];
        for (let v = 0; v < data.vertex_count; ++v)
            for (let i = start[v]; i < start[v + 1]; ++i) {
                const c = list[i], a = corners[c], b = corners[next[c]], other = a + b - v;
                let twin = -1;
                let earlier = false;
                for (let j = start[v]; j < start[v + 1]; ++j) {
                    const d = list[j];
                    if (j === i || corners[d] + corners[next[d]] - v !== other) continue;
                    twin = d;
                    earlier = earlier || j < i;
                }
                if (earlier) continue;
                if (twin < 0) borders.push(a, b);
                else if (sharp.has(v * 4294967296 + other)) sharpEdges.push(a, b);
                else {
                    edges.push(a, b);
                    join(c, next[twin]);
                    join(next[c], twin);
                }
            }
        for (let c = 0; c < group.length; ++c) group[c] = find(c);
        return {edges, sharpEdges, borders, group};
    }

    // Vertices to draw: a mesh's vertex for each group of corners, with the mean normal of their triangles.
    function drawn(data, group) {
        const {corners, positions, triangles} = data;
        const number = new Uint32Array(corners.length), source = [];
        for (let c = 0; c < corners.length; ++c)
            if (group[c] === c) { number[c] = source.length; source.push(corners[c]); }
        const index = new Uint32Array(triangles.length), normals = new Float32Array(3 * source.length);
        for (let t = 0; t < triangles.length; t += 3) {
            const a = 3 * corners[triangles[t]], b = 3 * corners[triangles[t + 1]], c = 3 * corners[triangles[t + 2]];
            const ux = positions[b] - positions[a], uy = positions[b + 1] - positions[a + 1], uz = positions[b + 2] - positions[a + 2];
            const vx = positions[c] - positions[a], vy = positions[c + 1] - positions[a + 1], vz = positions[c + 2] - positions[a + 2];
            const nx = uy * vz - uz * vy, ny = uz * vx - ux * vz, nz = ux * vy - uy * vx;
            for (let k = 0; k < 3; ++k) {
                const d = index[t + k] = number[group[triangles[t + k]]];
                normals[3 * d] += nx; normals[3 * d + 1] += ny; normals[3 * d + 2] += nz;
            }
        }
        for (let i = 0; i < normals.length; i += 3) {
            const length = Math.hypot(normals[i], normals[i + 1], normals[i + 2]) || 1;
            normals[i] /= length; normals[i + 1] /= length; normals[i + 2] /= length;
        }
        return {source: Uint32Array.from(source), index, normals};
    }

    // Position, deviation and marks of the drawn vertices. Marks: is there a deviation, confidence, completed.
    function attributes(data, {source}) {
        const n = source.length, position = new Float32Array(3 * n), deviation = new Float32Array(n), marks = new Uint8Array(4 * n);
        for (let i = 0; i < n; ++i) {
            const v = source[i];
            position.set(data.positions.subarray(3 * v, 3 * v + 3), 3 * i);
            const d = data.deviations ? data.deviations[v] : NOWHERE;
            deviation[i] = d === NOWHERE ? 0 : d * data.deviation_step;
            marks[4 * i] = d === NOWHERE ? 0 : 255;
            marks[4 * i + 1] = data.confidence ? data.confidence[v] : 255;
            marks[4 * i + 2] = data.completed && data.completed[v] ? 255 : 0;
        }
        return {position, deviation, marks};
    }

    // ---- More triangles, for colours --------------------------------------------------------------------------

    // The points by cells of a grid, to find those near a place.
    function pointGrid(data, size) {
        const n = data.points.length / 3, cells = new Map(), step = data.point_step;
        const cell = (x) => Math.floor(x / size) + 4096;
        const key = (i, j, k) => (i * 8192 + j) * 8192 + k;
        for (let i = 0; i < n; ++i) {
            const at = key(cell(data.points[3 * i] * step), cell(data.points[3 * i + 1] * step), cell(data.points[3 * i + 2] * step));
            if (cells.has(at)) cells.get(at).push(i);
            else cells.set(at, [i]);
        }
        // Mean deviation of the points less than `size` from a place whose feet lie in its plane, the nearer ones
        // counting more; null if there are none. The plane keeps out what belongs to the other side of a wall.
        return (x, y, z, nx, ny, nz) => {
            let sum = 0, weights = 0;
            const ci = cell(x), cj = cell(y), ck = cell(z);
            for (let i = ci - 1; i <= ci + 1; ++i) for (let j = cj - 1; j <= cj + 1; ++j) for (let k = ck - 1; k <= ck + 1; ++k) {
                const found = cells.get(key(i, j, k));
                if (!found) continue;
                for (const p of found) {
                    const dx = data.points[3 * p] * step - x, dy = data.points[3 * p + 1] * step - y, dz = data.points[3 * p + 2] * step - z;
                    const d = data.point_deviations[p] * data.deviation_step, apart = dx * dx + dy * dy + dz * dz;
                    if (apart > size * size || Math.abs(dx * nx + dy * ny + dz * nz - d / data.radius) > 0.3 * size) continue;
                    const weight = 1.001 - apart / (size * size);
                    sum += weight * weight * d;
                    weights += weight * weight;
                }
            }
            return weights > 0 ? sum / weights : null;
        };
    }

    // Where triangles are large against the distance of the points, they are divided, so that colours tell what lies
    // between their corners. Other meshes stay as they are.
    function divided(shape, data) {
        const {position, normals, marks, index} = shape;
        if (!data.points || !data.deviations) return shape;
        const at = (d) => [position[3 * d], position[3 * d + 1], position[3 * d + 2]];
        const minus = (p, q) => [p[0] - q[0], p[1] - q[1], p[2] - q[2]];
        const cross = (p, q) => [p[1] * q[2] - p[2] * q[1], p[2] * q[0] - p[0] * q[2], p[0] * q[1] - p[1] * q[0]];
        const length = (p) => Math.hypot(...p);
        const count = index.length / 3, longest = new Float32Array(count), planes = [];
        let area = 0;
        if (count > MANY) return shape;
        for (let t = 0; t < count; ++t) {
            const [a, b, c] = [0, 1, 2].map((k) => at(index[3 * t + k])), n = cross(minus(b, a), minus(c, a)), twice = length(n);
            area += twice / 2;
            longest[t] = Math.max(length(minus(b, a)), length(minus(c, b)), length(minus(a, c)));
            planes.push(n.map((x) => x / (twice || 1)));
        }
        if (!(area > 0)) return shape;
        const spacing = Math.sqrt(3 * area / data.points.length), reach = 3.5 * spacing;
        // As fine as two spacings, or as `MANY` triangles allow.
        let edge = 2 * spacing;
        const parts = (t) => Math.min(128, Math.max(1, Math.ceil(longest[t] / edge)));
        for (;;) {
            let sum = 0;
            for (let t = 0; t < count; ++t) sum += parts(t) * parts(t);
            if (sum <= MANY) {
                if (sum < 2 * count) return shape;
                break;
            }
            edge *= 1.2;
        }
        const near = pointGrid(data, Math.max(reach, edge)), out = {position: [], normals: [], deviation: [], marks: [], index: []};
        for (let t = 0; t < count; ++t) {
            const corners = [0, 1, 2].map((k) => index[3 * t + k]), n = parts(t), first = out.deviation.length, plane = planes[t];
            const row = (i) => first + i * (n + 1) - i * (i - 1) / 2;
            for (let i = 0; i <= n; ++i)
                for (let j = 0; i + j <= n; ++j) {
                    const shares = [(n - i - j) / n, j / n, i / n];
                    const mix = (array, width, k) => shares.reduce((sum, share, c) => sum + share * array[width * corners[c] + k], 0);
                    const p = [0, 1, 2].map((k) => mix(position, 3, k)), way = [0, 1, 2].map((k) => mix(normals, 3, k)), size = length(way) || 1;
                    const d = near(...p, ...plane);
                    out.position.push(...p);
                    out.normals.push(...way.map((x) => x / size));
                    out.deviation.push(d === null ? 0 : d);
                    out.marks.push(d === null ? 0 : 255, mix(marks, 4, 1), mix(marks, 4, 2), 0);
                    if (i + j < n) out.index.push(row(i) + j, row(i) + j + 1, row(i + 1) + j);
                    if (i + j + 1 < n) out.index.push(row(i) + j + 1, row(i + 1) + j + 1, row(i + 1) + j);
                }
        }
        return {position: Float32Array.from(out.position), normals: Float32Array.from(out.normals), deviation: Float32Array.from(out.deviation),
                marks: Uint8Array.from(out.marks), index: Uint32Array.from(out.index)};
    }

    // What is drawn of a mesh whose corners have the groups of connect().
    function shapeOf(data, group) {
        const corners = drawn(data, group);
        return divided(Object.assign({index: corners.index, normals: corners.normals}, attributes(data, corners)), data);
    }

    // ---- Fewer triangles, to turn -----------------------------------------------------------------------------

    // The mesh with the vertices of each cell of a grid as one; the two sides of a wall stay apart. For large
    // meshes while they turn.
    function coarser(shape, cells) {
        const {position, normals, deviation, marks, index} = shape, n = deviation.length;
        const cellOf = new Map(), cell = new Uint32Array(n), side = new Uint32Array(n);
        const place = (x) => Math.min(cells - 1, Math.max(0, Math.floor((x + 1) * 0.5 * cells)));
        const way = [];
        for (let i = 0; i < n; ++i) {
            const key = (place(position[3 * i]) * cells + place(position[3 * i + 1])) * cells + place(position[3 * i + 2]);
            let c = cellOf.get(key);
            if (c === undefined) {
                cellOf.set(key, c = way.length / 3);
                way.push(normals[3 * i], normals[3 * i + 1], normals[3 * i + 2]);
            }
            const dot = way[3 * c] * normals[3 * i] + way[3 * c + 1] * normals[3 * i + 1] + way[3 * c + 2] * normals[3 * i + 2];
            cell[i] = 2 * c + (dot < -0.3 ? 1 : 0);
            let axis = 0;
            for (let k = 1; k < 3; ++k) if (Math.abs(normals[3 * i + k]) > Math.abs(normals[3 * i + axis])) axis = k;
            side[i] = 2 * axis + (normals[3 * i + axis] < 0 ? 1 : 0);
        }
        const middle = new Float32Array(6 * way.length), count = new Float32Array(way.length);
        const numbers = new Int32Array(4 * way.length).fill(-1), of = new Uint32Array(n);
        let m = 0;
        for (let i = 0; i < n; ++i) {
            const c = cell[i];
            for (let k = 0; k < 3; ++k) middle[3 * c + k] += position[3 * i + k];
            ++count[c];
            const key = 6 * c + side[i];
            if (numbers[key] < 0) numbers[key] = m++;
            of[i] = numbers[key];
        }
        const out = {position: new Float32Array(3 * m), normals: new Float32Array(3 * m), deviation: new Float32Array(m), marks: new Uint8Array(4 * m)};
        for (let i = 0; i < n; ++i) {
            const o = of[i], c = cell[i];
            for (let k = 0; k < 3; ++k) {
                out.position[3 * o + k] = middle[3 * c + k] / count[c];
                out.normals[3 * o + k] += normals[3 * i + k];
            }
            out.deviation[o] = deviation[i];
            out.marks.set(marks.subarray(4 * i, 4 * i + 4), 4 * o);
        }
        const kept = new Uint32Array(index.length);
        let t = 0;
        for (let i = 0; i < index.length; i += 3) {
            const a = cell[index[i]], b = cell[index[i + 1]], c = cell[index[i + 2]];
            if (a === b || b === c || c === a) continue;
            for (let k = 0; k < 3; ++k) kept[t++] = of[index[i + k]];
        }
        out.index = kept.slice(0, t);
        return out;
    }

    // Rows of edges as few segments, none of which leaves its edges by more than a hair: to turn.
    function fewerLines(positions, pairs) {
        const HAIR = 0.002, ends = new Map(), out = [];
        const at = (v) => [positions[3 * v], positions[3 * v + 1], positions[3 * v + 2]];
        const add = (a, e) => { if (ends.has(a)) ends.get(a).push(e); else ends.set(a, [e]); };
        for (let e = 0; e < pairs.length / 2; ++e) { add(pairs[2 * e], e); add(pairs[2 * e + 1], e); }
        const done = new Uint8Array(pairs.length / 2);
        const isNear = (p, a, b) => { // is p no more than a hair from the segment?
            let length = 0, along = 0, apart = 0;
            for (let k = 0; k < 3; ++k) { length += (b[k] - a[k]) ** 2; along += (b[k] - a[k]) * (p[k] - a[k]); }
            const share = length > 0 ? Math.min(1, Math.max(0, along / length)) : 0;
            for (let k = 0; k < 3; ++k) apart += (p[k] - a[k] - share * (b[k] - a[k])) ** 2;
            return apart <= HAIR * HAIR;
        };
        const walk = (start, edge) => {
            let from = start, here = start, passed = [];
            for (let e = edge; e !== undefined && !done[e];) {
                done[e] = 1;
                const next = pairs[2 * e] + pairs[2 * e + 1] - here;
                if (here !== from) passed.push(at(here));
                if (passed.length > 60 || !passed.every((p) => isNear(p, at(from), at(next)))) {
                    out.push(from, here);
                    from = here;
                    passed = [];
                }
                here = next;
                const round = ends.get(here);
                e = round.length === 2 ? round.find((other) => !done[other]) : undefined;
            }
            if (here !== from) out.push(from, here);
        };
        for (const [v, round] of ends) if (round.length !== 2) for (const e of round) walk(v, e);
        for (let e = 0; e < done.length; ++e) walk(pairs[2 * e], e); // rings
        return out;
    }

    // The shape itself if it has few triangles, else a coarser one with cells so large that about FEW are left: their
    // number goes with the square of cells.
    function ofFew(shape) {
        if (shape.index.length / 3 <= FEW) return shape;
        const cells = 80, first = coarser(shape, cells);
        const wanted = Math.round(cells * Math.sqrt(FEW / Math.max(1, first.index.length / 3)));
        const less = coarser(shape, Math.max(24, Math.min(160, wanted)));
        for (let i = 0; i < less.normals.length; i += 3) {
            const length = Math.hypot(less.normals[i], less.normals[i + 1], less.normals[i + 2]) || 1;
            for (let k = 0; k < 3; ++k) less.normals[i + k] /= length;
        }
        return less;
    }

    return {read, connect, shapeOf, ofFew, fewerLines};
})();
