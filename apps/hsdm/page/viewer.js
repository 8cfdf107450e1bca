// Draws a mesh of hsdm into a canvas: `const view = hsdm.view(canvas, hsdm.read(element), options)`.
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

    // As above, with cells so large that about FEW triangles are left: their number goes with the square of cells.
    function ofFew(shape) {
        const cells = 80, first = coarser(shape, cells);
        const wanted = Math.round(cells * Math.sqrt(FEW / Math.max(1, first.index.length / 3)));
        const less = coarser(shape, Math.max(24, Math.min(160, wanted)));
        for (let i = 0; i < less.normals.length; i += 3) {
            const length = Math.hypot(less.normals[i], less.normals[i + 1], less.normals[i + 2]) || 1;
            for (let k = 0; k < 3; ++k) less.normals[i + k] /= length;
        }
        return less;
    }

    // ---- Colours --------------------------------------------------------------------------------------------

    // Safe for the colour-blind: blue over white to orange for signed values, viridis for shares.
    const SIGNED = [[0.02, 0.19, 0.48], [0.13, 0.44, 0.71], [0.45, 0.69, 0.88], [0.8, 0.89, 0.96], [0.97, 0.97, 0.97],
                    [0.99, 0.87, 0.71], [0.96, 0.65, 0.3], [0.82, 0.4, 0.06], [0.5, 0.2, 0.02]];
    const SHARE = [[0.267, 0.005, 0.329], [0.283, 0.141, 0.458], [0.254, 0.265, 0.53], [0.207, 0.372, 0.553], [0.164, 0.471, 0.558],
                   [0.128, 0.567, 0.551], [0.135, 0.659, 0.518], [0.267, 0.749, 0.441], [0.478, 0.821, 0.318], [0.741, 0.873, 0.15], [0.993, 0.906, 0.144]];

    // The colour at x in [0, 1], each part in [0, 1].
    function colorAt(scale, x) {
        const at = Math.min(1, Math.max(0, x)) * (scale.length - 1), i = Math.min(scale.length - 2, Math.floor(at));
        return [0, 1, 2].map((k) => scale[i][k] + (scale[i + 1][k] - scale[i][k]) * (at - i));
    }

    function css(color) { return "rgb(" + color.map((c) => Math.round(255 * c)).join(",") + ")"; }

    // Both scales as one texture of two rows.
    function scaleTexture() {
        const width = 256, data = new Uint8Array(2 * 4 * width);
        [SIGNED, SHARE].forEach((scale, row) => {
            for (let i = 0; i < width; ++i)
                data.set([...colorAt(scale, i / (width - 1)).map((c) => Math.round(255 * c)), 255], 4 * (row * width + i));
        });
        const texture = new THREE.DataTexture(data, width, 2, THREE.RGBAFormat);
        texture.magFilter = texture.minFilter = THREE.LinearFilter;
        texture.needsUpdate = true;
        return texture;
    }

    // ---- Materials ------------------------------------------------------------------------------------------

    const MODES = {plain: 0, deviation: 1, confidence: 2};

    const SURFACE = {
        vertexShader: `
            attribute float deviation;
            attribute vec4 marks;
            varying vec3 way;
            varying float offset;
            varying vec3 mark;
            void main() {
                way = normalMatrix * normal;
                offset = deviation;
                mark = marks.xyz;
                gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
            }`,
        fragmentShader: `
            uniform sampler2D scale;
            uniform float range, ratio;
            uniform int mode;
            uniform vec3 plain, unknown, stripe;
            varying vec3 way;
            varying float offset;
            varying vec3 mark;
            void main() {
                vec3 color = plain;
                if (mode == 1) color = mix(unknown, texture2D(scale, vec2(0.5 + 0.498 * clamp(offset / range, -1.0, 1.0), 0.25)).rgb, step(0.5, mark.x));
                if (mode == 2) color = texture2D(scale, vec2(0.002 + 0.996 * mark.y, 0.75)).rgb;
                if (mark.z > 0.5 && fract((gl_FragCoord.x + gl_FragCoord.y) / (9.0 * ratio)) < 0.35) color = stripe;
                vec3 n = normalize(way);
                if (!gl_FrontFacing) { n = -n; color *= 0.55; }
                float light = 0.62 + 0.34 * max(0.0, dot(n, vec3(-0.36, 0.48, 0.8))) + 0.1 * max(0.0, n.z);
                gl_FragColor = vec4(color * light, 1.0);
            }`,
    };

    // The same with everything but the placing of pixels done for the vertices: to turn without a graphics card.
    const QUICK_SURFACE = {
        vertexShader: `
            uniform sampler2D scale;
            uniform float range;
            uniform int mode;
            uniform vec3 plain, unknown, stripe;
            attribute float deviation;
            attribute vec4 marks;
            varying vec3 shade;
            void main() {
                vec3 color = plain;
                if (mode == 1) color = mix(unknown, texture2D(scale, vec2(0.5 + 0.498 * clamp(deviation / range, -1.0, 1.0), 0.25)).rgb, step(0.5, marks.x));
                if (mode == 2) color = texture2D(scale, vec2(0.002 + 0.996 * marks.y, 0.75)).rgb;
                if (marks.z > 0.5) color = mix(color, stripe, 0.35);
                vec3 n = normalize(normalMatrix * normal);
                shade = color * (0.62 + 0.34 * max(0.0, dot(n, vec3(-0.36, 0.48, 0.8))) + 0.1 * max(0.0, n.z));
                gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
            }`,
        fragmentShader: `
            varying vec3 shade;
            void main() { gl_FragColor = vec4(gl_FrontFacing ? shade : 0.55 * shade, 1.0); }`,
    };

    // Lines and points lie a little before the surface that they are on, at the same place of the picture.
    const NEARER = "\n#define NEARER(place) (projectionMatrix * vec4(0.998 * (modelViewMatrix * vec4(place, 1.0)).xyz, 1.0))\n";

    const THIN_LINES = {
        vertexShader: NEARER + `
            void main() { gl_Position = NEARER(position); }`,
        fragmentShader: `
            uniform vec3 color;
            uniform float alpha;
            void main() { gl_FragColor = vec4(color, alpha); }`,
    };

    // Lines of a width in pixels: every segment is two triangles that turn to the viewer.
    const LINES = {
        vertexShader: NEARER + `
            attribute vec3 other;
            attribute float side;
            uniform vec2 size;
            uniform float width;
            void main() {
                vec4 here = NEARER(position);
                vec4 there = NEARER(other);
                vec2 along = (there.xy / there.w - here.xy / here.w) * size;
                along = length(along) > 0.0 ? normalize(along) : vec2(1.0, 0.0);
                vec2 across = vec2(-along.y, along.x) * side - along * 0.4;
                here.xy += across * width / size * here.w;
                gl_Position = here;
            }`,
        fragmentShader: `
            uniform vec3 color;
            void main() { gl_FragColor = vec4(color, 1.0); }`,
    };

    const DOTS = {
        vertexShader: NEARER + `
            attribute float deviation;
            uniform float width;
            varying float offset;
            void main() {
                offset = deviation;
                gl_Position = NEARER(position);
                gl_PointSize = width;
            }`,
        fragmentShader: `
            uniform sampler2D scale;
            uniform float range;
            uniform int mode;
            uniform vec3 color;
            varying float offset;
            void main() {
                vec2 from = gl_PointCoord - 0.5;
                if (dot(from, from) > 0.25) discard;
                vec3 shown = mode == 1 ? texture2D(scale, vec2(0.5 + 0.498 * clamp(offset / range, -1.0, 1.0), 0.25)).rgb : color;
                gl_FragColor = vec4(shown, 1.0);
            }`,
    };

    const LIGHT = {background: [0.949, 0.957, 0.969], plain: [0.72, 0.77, 0.83], unknown: [0.6, 0.6, 0.62], stripe: [0.34, 0.3, 0.36],
                   edges: [0.2, 0.23, 0.28], edgeAlpha: 0.35, sharp: [0.05, 0.07, 0.1], corner: [0.05, 0.07, 0.1], border: [0.75, 0.05, 0.4]};
    const DARK = {background: [0.075, 0.09, 0.115], plain: [0.62, 0.68, 0.76], unknown: [0.42, 0.42, 0.45], stripe: [0.2, 0.17, 0.22],
                  edges: [0.02, 0.03, 0.05], edgeAlpha: 0.5, sharp: [0.97, 0.98, 1.0], corner: [1.0, 1.0, 1.0], border: [1.0, 0.45, 0.75]};

    // ---- The view -------------------------------------------------------------------------------------------

    function lineGeometry(positions, pairs) {
        const n = pairs.length / 2, position = new Float32Array(12 * n), other = new Float32Array(12 * n), side = new Float32Array(4 * n);
        const index = new Uint32Array(6 * n);
        for (let i = 0; i < n; ++i) {
            const a = positions.subarray(3 * pairs[2 * i], 3 * pairs[2 * i] + 3), b = positions.subarray(3 * pairs[2 * i + 1], 3 * pairs[2 * i + 1] + 3);
            position.set(a, 12 * i); position.set(a, 12 * i + 3); position.set(b, 12 * i + 6); position.set(b, 12 * i + 9);
            other.set(b, 12 * i); other.set(b, 12 * i + 3); other.set(a, 12 * i + 6); other.set(a, 12 * i + 9);
            side.set([1, -1, -1, 1], 4 * i);
            index.set([4 * i, 4 * i + 2, 4 * i + 1, 4 * i + 2, 4 * i + 3, 4 * i + 1], 6 * i);
        }
        const geometry = new THREE.BufferGeometry();
        geometry.setIndex(new THREE.BufferAttribute(index, 1));
        geometry.setAttribute("position", new THREE.BufferAttribute(position, 3));
        geometry.setAttribute("other", new THREE.BufferAttribute(other, 3));
        geometry.setAttribute("side", new THREE.BufferAttribute(side, 1));
        return geometry;
    }

    function surfaceGeometry(shape) {
        const geometry = new THREE.BufferGeometry();
        geometry.setIndex(new THREE.BufferAttribute(shape.index, 1));
        geometry.setAttribute("position", new THREE.BufferAttribute(shape.position, 3));
        geometry.setAttribute("normal", new THREE.BufferAttribute(shape.normals, 3));
        geometry.setAttribute("deviation", new THREE.BufferAttribute(shape.deviation, 1));
        geometry.setAttribute("marks", new THREE.BufferAttribute(shape.marks, 4, true));
        return geometry;
    }

    const MANY = 60000;      // triangles that large ones are divided into, for their colours, at most
    const FEW = 15000;       // triangles: from more on a coarser mesh of about so many stands by, to turn
    const SLOW = 25;         // ms of a whole picture from which on it is taken to turn
    const SETTLED = 160;     // ms without a movement until all is drawn again

    function drawnBySoftware() {
        const gl = document.createElement("canvas").getContext("webgl"), about = gl && gl.getExtension("WEBGL_debug_renderer_info");
        const name = about ? String(gl.getParameter(about.UNMASKED_RENDERER_WEBGL)) : "";
        if (gl && gl.getExtension("WEBGL_lose_context")) gl.getExtension("WEBGL_lose_context").loseContext();
        return /swiftshader|llvmpipe|software/i.test(name);
    }

    // options: mode ("plain", "deviation", "confidence"), edges, sharp, points (booleans), range, dark, still (no
    // controls: for thumbnails). Returns an object with set(options), draw(), fit(), look(direction, up), goTo(place),
    // turn(dx, dy), zoom(factor), pan(dx, dy), project(place), pick(x, y), picture(width, height), bench(frames).
    function view(canvas, data, options) {
        const state = Object.assign({mode: data.deviations ? "deviation" : "plain", edges: true, sharp: true, points: false,
                                     range: data.range || 1, dark: false, still: false}, options);
        // A renderer without a graphics card draws smooth edges by drawing more pixels, once the mesh stands still:
        // what it does by itself would be done for every picture of a turning one.
        const software = state.software === undefined ? drawnBySoftware() : state.software;
        const renderer = new THREE.WebGLRenderer({canvas, antialias: !software});
        const {edges, sharpEdges, borders, group} = connect(data);
        const corners = drawn(data, group);
        const shape = divided(Object.assign({index: corners.index, normals: corners.normals}, attributes(data, corners)), data);
        const scale = scaleTexture();
        const shared = {scale: {value: scale}, range: {value: 1}, mode: {value: 0}, ratio: {value: 1}, size: {value: new THREE.Vector2(1, 1)},
                        plain: {value: new THREE.Color()}, unknown: {value: new THREE.Color()}, stripe: {value: new THREE.Color()}};
        const material = (source, own, more) => new THREE.ShaderMaterial(Object.assign({}, source, {uniforms: Object.assign({}, shared, own)}, more));

        const scene = new THREE.Scene(), camera = new THREE.PerspectiveCamera(28, 1, 0.01, 100);
        const add = (object) => { object.frustumCulled = false; scene.add(object); return object; };
        const side = borders.length ? THREE.DoubleSide : THREE.FrontSide; // nobody sees a closed surface from behind
        const surfaceMaterial = material(SURFACE, {}, {side, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1});
        const full = add(new THREE.Mesh(surfaceGeometry(shape), surfaceMaterial));
        let coarse = null;

        const positions = new THREE.BufferAttribute(data.positions, 3);
        const thin = (pairs) => {
            const geometry = new THREE.BufferGeometry();
            geometry.setAttribute("position", positions);
            geometry.setIndex(new THREE.BufferAttribute(Uint32Array.from(pairs), 1));
            const own = {color: {value: new THREE.Color()}, alpha: {value: 1}};
            return add(new THREE.LineSegments(geometry, material(THIN_LINES, own, {transparent: true, depthWrite: false})));
        };
        const edgeLines = thin(edges);
        const quickLines = thin(state.still ? [] : fewerLines(data.positions, sharpEdges));
        const sharpMaterial = material(LINES, {width: {value: 2}, color: {value: new THREE.Color()}}, {side: THREE.DoubleSide});
        const borderMaterial = material(LINES, {width: {value: 3}, color: {value: new THREE.Color()}}, {side: THREE.DoubleSide});
        const sharpLines = add(new THREE.Mesh(lineGeometry(data.positions, sharpEdges), sharpMaterial));
        const borderLines = add(new THREE.Mesh(lineGeometry(data.positions, borders), borderMaterial));
        const dots = (place, deviation, own) => {
            const geometry = new THREE.BufferGeometry();
            geometry.setAttribute("position", place);
            geometry.setAttribute("deviation", new THREE.BufferAttribute(deviation, 1));
            return add(new THREE.Points(geometry, material(DOTS, own)));
        };
        const cornerPlaces = new Float32Array(3 * data.corner_vertices.length);
        data.corner_vertices.forEach((v, i) => cornerPlaces.set(data.positions.subarray(3 * v, 3 * v + 3), 3 * i));
        const cornerDots = dots(new THREE.BufferAttribute(cornerPlaces, 3), new Float32Array(data.corner_vertices.length),
                                {mode: {value: 0}, width: {value: 7}, color: {value: new THREE.Color()}});
        let pointDots = null;
        if (data.points) {
            const n = data.points.length / 3, place = new Float32Array(3 * n), deviation = new Float32Array(n);
            for (let i = 0; i < 3 * n; ++i) place[i] = data.points[i] * data.point_step;
            for (let i = 0; i < n; ++i) deviation[i] = data.point_deviations[i] * data.deviation_step;
            pointDots = dots(new THREE.BufferAttribute(place, 3), deviation, {width: {value: 4}, color: {value: new THREE.Color()}});
        }

        // The camera looks at `target` from `distance` away; `turned` takes its axes to those of the mesh.
        const target = new THREE.Vector3(), turned = new THREE.Quaternion();
        let distance = 4;
        const home = () => Math.max(1, 1 / camera.aspect) * 1.08 / Math.sin(camera.fov * Math.PI / 360);

        const colors = (theme) => {
            const put = (uniform, color) => uniform.value.setRGB(...color);
            renderer.setClearColor(new THREE.Color(...theme.background), 1);
            put(shared.plain, theme.plain); put(shared.unknown, theme.unknown); put(shared.stripe, theme.stripe);
            put(sharpMaterial.uniforms.color, theme.sharp); put(borderMaterial.uniforms.color, theme.border);
            put(cornerDots.material.uniforms.color, theme.corner);
            if (pointDots) put(pointDots.material.uniforms.color, theme.sharp);
            put(edgeLines.material.uniforms.color, theme.edges);
            edgeLines.material.uniforms.alpha.value = theme.edgeAlpha;
            put(quickLines.material.uniforms.color, theme.sharp);
        };

        let moving = false, settle = 0, waiting = 0, slow = false, measured = false, listener = null;

        // Pixels of the canvas for one of the page's: fewer while a slow renderer turns, more when it has stopped.
        function sharpness() {
            const ratio = Math.min(2, window.devicePixelRatio || 1);
            if (!software) return moving && slow ? Math.min(1, ratio) : ratio;
            return moving ? Math.min(1, ratio) : Math.max(2, ratio);
        }

        function render(asItIs) {
            if (!asItIs && renderer.getPixelRatio() !== sharpness()) {
                const size = renderer.getSize(new THREE.Vector2());
                resize(size.x, size.y, sharpness());
            }
            camera.quaternion.copy(turned);
            camera.position.set(0, 0, distance).applyQuaternion(turned).add(target);
            camera.near = Math.max(distance - 3, distance / 200);
            camera.far = distance + 3 + target.length();
            camera.updateProjectionMatrix();
            const less = moving && slow && coarse;
            full.visible = !less;
            if (coarse) coarse.visible = !!less;
            edgeLines.visible = state.edges && !less;
            sharpLines.visible = cornerDots.visible = state.sharp && !less;
            quickLines.visible = state.sharp && !!less;
            borderLines.visible = state.sharp;
            if (pointDots) pointDots.visible = state.points;
            renderer.render(scene, camera);
        }

        // Waits until the picture is there: reading a pixel is what makes sure of it.
        const pixel = new Uint8Array(4);
        function finish() {
            const gl = renderer.getContext();
            gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
        }

        function draw() {
            waiting = 0;
            render();
            if (listener) listener();
            if (measured || moving || !coarse) return;
            finish();
            const start = performance.now();
            render();
            finish();
            slow = performance.now() - start > SLOW;
            measured = true;
        }

        const invalidate = () => { if (!waiting) waiting = requestAnimationFrame(draw); };

        function moved() {
            moving = true;
            clearTimeout(settle);
            settle = setTimeout(() => { moving = false; invalidate(); }, SETTLED);
            invalidate();
        }

        function resize(width, height, ratio) {
            renderer.setPixelRatio(ratio);
            renderer.setSize(width, height, false);
            camera.aspect = width / height;
            shared.ratio.value = ratio;
            shared.size.value.set(width * ratio, height * ratio);
            sharpMaterial.uniforms.width.value = (state.still ? 1.4 : 2) * ratio;
            borderMaterial.uniforms.width.value = (state.still ? 2 : 3) * ratio;
            cornerDots.material.uniforms.width.value = (state.still ? 4 : 7) * ratio;
            if (pointDots) pointDots.material.uniforms.width.value = 4 * ratio;
        }

        const self = {
            state, data, canvas,
            edgeCounts: {smooth: edges.length / 2, sharp: sharpEdges.length / 2, border: borders.length / 2},
            onDraw: (f) => { listener = f; },
            draw: invalidate,
            set(more) {
                Object.assign(state, more);
                shared.range.value = state.range;
                shared.mode.value = MODES[state.mode];
                colors(state.dark ? DARK : LIGHT);
                invalidate();
            },
            fit() { target.set(0, 0, 0); distance = home(); moved(); },
            look(direction, up) {
                const z = new THREE.Vector3(...direction).normalize(), x = new THREE.Vector3(...up).cross(z).normalize();
                turned.setFromRotationMatrix(new THREE.Matrix4().makeBasis(x, z.clone().cross(x), z));
                moved();
            },
            turn(dx, dy) {
                const by = new THREE.Quaternion().setFromEuler(new THREE.Euler(-dy, -dx, 0));
                turned.multiply(by).normalize();
                moved();
            },
            zoom(factor) { distance = Math.min(12, Math.max(0.02, distance * factor)); moved(); },
            pan(dx, dy) {
                const step = 2 * distance * Math.tan(camera.fov * Math.PI / 360);
                target.add(new THREE.Vector3(-dx * step, dy * step, 0).applyQuaternion(turned));
                moved();
            },
            // Looks at a place of the mesh's own coordinates from the side that it is seen from.
            goTo(place) {
                const to = self.inside(place), away = to.clone().normalize();
                target.copy(to);
                distance = home() * 0.3;
                if (to.length() > 0.05) {
                    const up = Math.abs(away.z) > 0.95 ? [0, 1, 0] : [0, 0, 1];
                    self.look([away.x + 0.25, away.y - 0.2, away.z + 0.25], up);
                }
                moved();
            },
            inside: (place) => new THREE.Vector3(...place.map((x, k) => (x - data.centre[k]) / data.radius)),
            // Where a place of the mesh's own coordinates is in the canvas, in shares of its size.
            project(place) {
                const p = self.inside(place).project(camera);
                return {x: 0.5 + 0.5 * p.x, y: 0.5 - 0.5 * p.y, seen: p.z < 1};
            },
            // What lies under a place of the canvas (shares of its size), with the deviation of the nearest vertex drawn.
            pick(x, y) {
                const ray = new THREE.Raycaster();
                ray.setFromCamera(new THREE.Vector2(2 * x - 1, 1 - 2 * y), camera);
                const hit = ray.intersectObject(full)[0];
                if (!hit) return null;
                const near = [hit.face.a, hit.face.b, hit.face.c].map((d) => [d, hit.point.distanceTo(new THREE.Vector3(...shape.position.subarray(3 * d, 3 * d + 3)))]);
                const d = near.sort((p, q) => p[1] - q[1])[0][0];
                return {place: hit.point.toArray().map((c, k) => c * data.radius + data.centre[k]), 
                        deviation: shape.marks[4 * d] ? shape.deviation[d] : null, confidence: data.confidence ? shape.marks[4 * d + 1] / 255 : null};
            },
            // A still picture as a data: address, on a light ground.
            picture(width, height) {
                const old = renderer.getSize(new THREE.Vector2()), ratio = renderer.getPixelRatio(), was = moving;
                moving = false;
                colors(LIGHT);
                renderer.setClearColor(new THREE.Color(1, 1, 1), 1);
                resize(width, height, 1);
                render(true);
                const address = canvas.toDataURL("image/png");
                resize(old.x, old.y, ratio);
                colors(state.dark ? DARK : LIGHT);
                moving = was;
                render();
                return address;
            },
            // Gives the graphics card its memory back; browsers allow only some views at a time.
            end() { renderer.dispose(); renderer.forceContextLoss(); },
            resize: () => {
                if (!canvas.clientWidth || !canvas.clientHeight) return;
                resize(canvas.clientWidth, canvas.clientHeight, sharpness());
                invalidate();
            },
            // Turns the mesh once round and tells the pictures per second, each waited for.
            bench(frames, done) {
                let left = frames, start = 0;
                const step = () => {
                    moving = true;
                    clearTimeout(settle);
                    self.turn(2 * Math.PI / frames, 0);
                    render();
                    finish();
                    if (left === frames) start = performance.now();
                    if (left-- > 0) requestAnimationFrame(step);
                    else done({frames, fps: 1000 * frames / (performance.now() - start), coarse: !!(slow && coarse),
                               triangles: (slow && coarse ? coarse.geometry : full.geometry).index.count / 3});
                };
                draw();
                step();
            },
        };

        if (!state.still) {
            const quick = material(QUICK_SURFACE, {}, {side, polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1});
            coarse = add(new THREE.Mesh(shape.index.length / 3 > FEW ? surfaceGeometry(ofFew(shape)) : full.geometry, quick));
            coarse.visible = false;
        }
        self.resize();
        self.set({});
        distance = home();
        self.look([0.62, -0.72, 0.5], [0, 0, 1]);
        if (!state.still) {
            control(canvas, self);
            if (window.ResizeObserver) new ResizeObserver(self.resize).observe(canvas);
            else window.addEventListener("resize", self.resize);
        }
        return self;
    }

    // A still picture of a mesh as a data: address, for an <img>: of many meshes one after the other.
    function picture(data, width, height, options) {
        const shown = view(document.createElement("canvas"), data, Object.assign({still: true}, options));
        const address = shown.picture(width, height);
        shown.end();
        return address;
    }

    // ---- Mouse, fingers, keys ---------------------------------------------------------------------------------

    // One finger or the left button turns, two fingers or other buttons move, pinching and the wheel zoom.
    function control(canvas, self) {
        const held = new Map();
        const share = () => 1 / canvas.clientHeight;
        const spread = () => {
            const [a, b] = [...held.values()];
            return {x: (a.x + b.x) / 2, y: (a.y + b.y) / 2, apart: Math.hypot(a.x - b.x, a.y - b.y)};
        };
        canvas.addEventListener("pointerdown", (e) => {
            canvas.setPointerCapture(e.pointerId);
            held.set(e.pointerId, {x: e.clientX, y: e.clientY, button: e.button});
        });
        canvas.addEventListener("pointermove", (e) => {
            const one = held.get(e.pointerId);
            if (!one) return;
            const before = held.size === 2 ? spread() : one, dx = e.clientX - one.x, dy = e.clientY - one.y;
            if (held.size === 1) {
                if (one.button > 0 || e.shiftKey) self.pan(dx * share(), dy * share());
                else self.turn(3.4 * dx * share(), 3.4 * dy * share());
            }
            const earlier = {x: before.x, y: before.y, apart: before.apart};
            one.x = e.clientX;
            one.y = e.clientY;
            if (held.size === 2) {
                const now = spread();
                self.pan((now.x - earlier.x) * share(), (now.y - earlier.y) * share());
                if (now.apart > 0 && earlier.apart > 0) self.zoom(earlier.apart / now.apart);
            }
        });
        for (const end of ["pointerup", "pointercancel"]) canvas.addEventListener(end, (e) => held.delete(e.pointerId));
        canvas.addEventListener("contextmenu", (e) => e.preventDefault());
        canvas.addEventListener("wheel", (e) => {
            e.preventDefault();
            self.zoom(Math.exp(Math.max(-0.5, Math.min(0.5, e.deltaY * (e.deltaMode ? 0.04 : 0.0015)))));
        }, {passive: false});
        canvas.addEventListener("keydown", (e) => {
            if (e.ctrlKey || e.altKey || e.metaKey) return;
            const step = 0.13, move = 0.05;
            const keys = {ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1]};
            if (keys[e.key]) {
                const [x, y] = keys[e.key];
                if (e.shiftKey) self.pan(x * move, y * move);
                else self.turn(x * step, y * step);
            } else if (e.key === "+" || e.key === "=") self.zoom(0.85);
            else if (e.key === "-" || e.key === "_") self.zoom(1 / 0.85);
            else if (e.key === "Home" || e.key === "0") self.fit();
            else return;
            e.preventDefault();
        });
    }

    return {read, view, picture, colorAt, css, SIGNED, SHARE};
})();
