#!/usr/bin/env python3
"""Draws README's strip: a scan's points, the mesh's facets, its sharp edges and corners, the deviations of the points.

  python3 docs/strip.py [OUT.png]      docs/images/strip.png, unless another is named

Scans the part of `sh cmake/bootstrap.sh demo`, reconstructs it with a page, and has headless Chromium draw the four
pictures by that page's own viewer. Takes the binaries of build/release, or HSDM and HSDM_GENERATE; the rest goes to
build/strip.
"""
import array
import base64
import json
import os
import subprocess
import sys

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "page"))
import browser

SHARE = 4  # one of so many points is drawn: all of them would be a solid
WIDTH, HEIGHT = 1600, 420

STYLE = """
    body { margin: 0; padding: 0; width: 1600px; height: 420px; display: grid; grid-template-columns: repeat(4, 1fr); background: rgb(242,244,247); }
    figure { margin: 0; position: relative; font: 18px/20px "DejaVu Sans", sans-serif; color: #17202b; }
    canvas { position: absolute; left: 0; top: 8px; width: 400px; height: 344px; }
    figcaption { position: absolute; top: 362px; width: 100%; text-align: center; font-size: 24px; line-height: 30px; white-space: nowrap; }
    .scale { position: absolute; left: 6px; top: 16px; height: 136px; padding-left: 22px; display: flex; flex-direction: column; justify-content: space-between; }
    .scale i { position: absolute; left: 0; top: 10px; bottom: 10px; width: 16px; }
"""

SCRIPT = r"""
    // One look at the part for all pictures: where from, how near, where in the picture (shares of its height). The last
    // two numbers are the viewer's: its field of view in degrees and how far away a whole mesh is looked at.
    const LOOK = {from: [0.75, 0.6, -0.8], up: [1, 0, 0], near: 0.6, aside: [0.065, -0.04], field: 28, whole: 1.08};

    const grouped = (n) => String(n).replace(/\B(?=(\d{3})+$)/g, ",");

    function panel(caption) {
        const figure = document.createElement("figure"), canvas = document.createElement("canvas"), text = document.createElement("figcaption");
        text.textContent = caption;
        figure.append(canvas, text);
        document.body.append(figure);
        return canvas;
    }

    // `software` has the viewer draw two pixels for each of the picture's, both ways.
    function meshPanel(caption, data, options) {
        const view = hsdm.view(panel(caption), data, Object.assign({software: true, edges: false, points: false, dark: false}, options));
        view.look(LOOK.from, LOOK.up);
        view.zoom(LOOK.near);
        view.pan(...LOOK.aside);
        return view;
    }

    // The camera of meshPanel().
    function lens(aspect) {
        const half = LOOK.field * Math.PI / 360, distance = LOOK.near * LOOK.whole / Math.sin(half), step = 2 * distance * Math.tan(half);
        const camera = new THREE.PerspectiveCamera(LOOK.field, aspect, 0.1, 20);
        camera.up.set(...LOOK.up);
        camera.position.set(...LOOK.from).setLength(distance);
        camera.lookAt(0, 0, 0);
        return camera.translateX(-LOOK.aside[0] * step).translateY(LOOK.aside[1] * step);
    }

    // Dots a little before the surface that they are on, in the light that their own normals are in.
    const DOTS = {
        vertexShader: `
            varying float light;
            void main() {
                light = smoothstep(0.3, 0.95, dot(normalize(normalMatrix * normal), vec3(-0.36, 0.48, 0.8)));
                gl_Position = projectionMatrix * vec4(0.997 * (modelViewMatrix * vec4(position, 1.0)).xyz, 1.0);
                gl_PointSize = 3.0;
            }`,
        fragmentShader: `
            varying float light;
            void main() {
                vec2 from = gl_PointCoord - 0.5;
                if (dot(from, from) > 0.25) discard;
                gl_FragColor = vec4(mix(vec3(0.08, 0.2, 0.4), vec3(0.38, 0.62, 0.88), light), 1.0);
            }`,
    };

    // Places and normals, six numbers a point; the mesh itself is not seen, and hides the points behind it.
    function pointPanel(caption, data, numbers) {
        const canvas = panel(caption), renderer = new THREE.WebGLRenderer({canvas, antialias: true, alpha: true}), scene = new THREE.Scene();
        renderer.setSize(2 * canvas.clientWidth, 2 * canvas.clientHeight, false);
        const shape = hsdm.shapeOf(data, hsdm.connect(data).group), surface = new THREE.BufferGeometry(), cloud = new THREE.BufferGeometry();
        surface.setIndex(new THREE.BufferAttribute(shape.index, 1));
        surface.setAttribute("position", new THREE.BufferAttribute(shape.position, 3));
        scene.add(new THREE.Mesh(surface, new THREE.MeshBasicMaterial({colorWrite: false})));
        const placed = numbers.map((x, i) => i % 6 < 3 ? (x - data.centre[i % 6]) / data.radius : x), rows = new THREE.InterleavedBuffer(placed, 6);
        cloud.setAttribute("position", new THREE.InterleavedBufferAttribute(rows, 3, 0));
        cloud.setAttribute("normal", new THREE.InterleavedBufferAttribute(rows, 3, 3));
        scene.add(new THREE.Points(cloud, new THREE.ShaderMaterial(DOTS)));
        renderer.render(scene, lens(canvas.clientWidth / canvas.clientHeight));
    }

    function addScale(range) {
        const scale = document.createElement("div"), ramp = document.createElement("i"), stops = [];
        for (let i = 16; i >= 0; --i) stops.push(hsdm.css(hsdm.colorAt(hsdm.SIGNED, i / 16)));
        scale.className = "scale";
        ramp.style.background = `linear-gradient(${stops})`;
        scale.append(ramp);
        for (const text of ["+" + range, "0", "−" + range]) scale.append(Object.assign(document.createElement("span"), {textContent: text}));
        document.body.lastChild.append(scale);
    }

    // In place of the page. `points` has what pointPanel() takes, in base64.
    function strip(points, style) {
        const data = hsdm.read(document.getElementById("mesh")), report = JSON.parse(document.getElementById("report-json").textContent);
        hsdm.shown.end();
        document.head.append(Object.assign(document.createElement("style"), {textContent: style}));
        document.body.replaceChildren();
        const {edges, sharpEdges} = hsdm.connect(data), quads = Math.round(1000 * report.mesh.quad_share) / 10;
        pointPanel(`${grouped(report.input.points)} noisy points`, data, new Float32Array(Uint8Array.from(atob(points), (c) => c.charCodeAt(0)).buffer));
        // With every edge as a sharp one facets are flat, as they are.
        meshPanel(`${grouped(data.facet_count)} facets, ${quads} % quads`,
                  Object.assign({}, data, {sharp: edges.concat(sharpEdges), corner_vertices: [], points: null}), {mode: "plain", still: true});
        meshPanel(`${grouped(sharpEdges.length / 2)} sharp edges, ${data.corner_vertices.length} corners`,
                  Object.assign({}, data, {points: null}), {mode: "plain"});
        window.last = meshPanel("Deviations of the points", data, {mode: "deviation", still: true});
        addScale(data.range);
    }

    // How far apart, in shares of the picture, a place of the mesh is in the points' picture and in the last one.
    function apart() {
        const {data, canvas} = last, camera = lens(canvas.clientWidth / canvas.clientHeight), place = data.positions.subarray(0, 3);
        camera.updateMatrixWorld();
        const p = new THREE.Vector3(...place).project(camera), q = last.project([...place].map((x, k) => x * data.radius + data.centre[k]));
        return Math.hypot(0.5 + 0.5 * p.x - q.x, 0.5 - 0.5 * p.y - q.y);
    }
"""


def some_points(scan):
    """Places and normals of some points of a PLY of hsdm_generate, six floats a point."""
    with open(scan, "rb") as file:
        header, numbers = file.read().split(b"end_header\n", 1)
    kinds = [line.split()[1:] for line in header.decode().splitlines() if line.startswith("property")]
    if b"binary_little_endian" not in header or kinds != [["double", n] for n in ("x", "y", "z", "nx", "ny", "nz")]:
        sys.exit(f"strip: {scan}: not the six numbers a point that are drawn here")
    values = array.array("d", numbers)
    return array.array("f", (x for at in range(0, len(values), 6 * SHARE) for x in values[at:at + 6]))


def draw(page, scan, out):
    points = base64.b64encode(some_points(scan).tobytes()).decode()
    with browser.Browser(WIDTH, HEIGHT) as shown:
        shown.open(page)
        shown.value(SCRIPT + f"strip({json.dumps(points)}, {json.dumps(STYLE)})")
        shown.settle()
        if shown.value("apart()") > 0.001:
            sys.exit("strip: the page's viewer looks from elsewhere than LOOK says")
        png = shown.picture()
        if shown.console:
            sys.exit("strip: " + "; ".join(shown.console))
    with open(out, "wb") as file:
        file.write(png)


def main(out=os.path.join(ROOT, "docs", "images", "strip.png")):
    hsdm = os.environ.get("HSDM") or os.path.join(ROOT, "build/release/apps/hsdm/hsdm")
    generate = os.environ.get("HSDM_GENERATE") or os.path.join(ROOT, "build/release/tests/support/hsdm_generate")
    for tool in hsdm, generate:
        if not os.access(tool, os.X_OK):
            sys.exit(f"strip: no {tool}; sh cmake/bootstrap.sh build builds it")
    if not browser.find():
        sys.exit("strip: no chromium here: apt-get install chromium")
    folder = os.path.join(ROOT, "build", "strip")
    os.makedirs(folder, exist_ok=True)
    scan, part, page = (os.path.join(folder, name) for name in ("scan.ply", "part.off", "part.html"))
    subprocess.run([generate, "part", "--points", "200000", "--noise", "0.002", "--normal-noise", "5", "-o", scan], check=True)
    subprocess.run([hsdm, "reconstruct", scan, "--depth", "5", "-o", part, "--html", page, "--quiet"], check=True)
    draw(page, scan, out)


if __name__ == "__main__":
    if len(sys.argv) > 2 or sys.argv[1:2] in (["-h"], ["--help"]):
        sys.exit(__doc__)
    main(*sys.argv[1:])
