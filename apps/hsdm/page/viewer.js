// Draws a mesh of mesh.js into a canvas: `const view = hsdm.view(canvas, hsdm.read(element), options)`.
"use strict";
(function () {
    const {connect, shapeOf, ofFew, fewerLines} = hsdm;

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
        const shape = shapeOf(data, group);
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
            const less = ofFew(shape);
            coarse = add(new THREE.Mesh(less === shape ? full.geometry : surfaceGeometry(less), quick));
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

    Object.assign(hsdm, {view, picture, colorAt, css, SIGNED, SHARE});
})();
