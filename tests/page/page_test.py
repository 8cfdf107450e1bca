"""page_test.py HSDM TESTDATA [browser]: what `hsdm reconstruct --html` writes, looked at with other programs' eyes.

Without `browser`: the text, by Python's own HTML parser. With it: headless Chromium draws it; 77 where there is none.
"""
import base64
import html.parser
import json
import os
import shutil
import struct
import subprocess
import sys
import tempfile

sys.path.insert(0, os.path.dirname(__file__))
import browser

HSDM, TESTDATA = sys.argv[1], sys.argv[2]
VOID = {"meta", "link", "br", "hr", "img", "input", "area", "base", "col", "embed", "source", "track", "wbr"}


class Page(html.parser.HTMLParser):
    """A page's elements; every element that is begun is ended, in order."""

    def __init__(self, text):
        super().__init__(convert_charrefs=True)
        self.open, self.ids, self.scripts, self.places, self.references, self.title, self.text = [], [], {}, [], [], "", ""
        self.feed(text)
        self.close()
        assert self.open == [], f"not ended: {self.open}"

    def handle_starttag(self, tag, attributes):
        given = dict(attributes)
        assert len(given) == len(attributes), f"an attribute twice in <{tag}>"
        if "id" in given:
            assert given["id"] not in self.ids, f"id {given['id']} twice"
            self.ids.append(given["id"])
        if "data-place" in given:
            self.places.append([float(x) for x in given["data-place"].split()])
        self.references += [given[k] for k in ("src", "href", "action", "data", "poster", "srcset") if given.get(k)]
        if tag not in VOID:
            self.open.append((tag, given.get("id")))

    def handle_endtag(self, tag):
        assert self.open and self.open[-1][0] == tag, f"</{tag}> ends {self.open[-1:]}"
        self.open.pop()

    def handle_data(self, data):
        tag, name = self.open[-1] if self.open else ("", None)
        if tag == "script":
            self.scripts[name] = self.scripts.get(name, "") + data
        elif tag == "title":
            self.title += data
        elif tag not in ("style",):
            self.text += data


def run(folder, *arguments, status=0):
    result = subprocess.run([HSDM, *arguments], cwd=folder, capture_output=True)
    assert result.returncode == status, f"{arguments}: {result.returncode}\n{result.stderr.decode(errors='replace')}"
    return result


def read(path):
    with open(path, encoding="utf-8") as file:  # a page is UTF-8 whatever names are in it
        return Page(file.read())


def packed(text):
    numbers, value, shift = [], 0, 0
    for byte in base64.b64decode(text):
        value |= (byte & 127) << shift
        shift += 7
        if byte < 128:
            numbers.append(value)
            value = shift = 0
    return numbers


def step(number):
    return -(number + 1) // 2 if number % 2 else number // 2


def decode(data):
    """Positions in the mesh's units, facets, and per facet its triangles."""
    flat = struct.unpack(f"<{3 * data['vertex_count']}f", base64.b64decode(data["positions"]))
    positions = [[flat[3 * v + k] * data["radius"] + data["centre"][k] for k in range(3)] for v in range(data["vertex_count"])]
    numbers, facets, triangles, last = iter(packed(data["facets"])), [], [], 0
    for size in numbers:
        facet = []
        for _ in range(size):
            last += step(next(numbers))
            facet.append(last)
        corners = [c for k in range(2, size) for c in (0, k - 1, k)] if size < 5 else [next(numbers) for _ in range(3 * (size - 2))]
        facets.append(facet)
        triangles.append([facet[c] for c in corners])
    return positions, facets, triangles


def read_off(path):
    with open(path, encoding="ascii") as file:
        words = iter(file.read().split())
    assert next(words) == "OFF"
    vertices, faces, _ = int(next(words)), int(next(words)), next(words)
    positions = [[float(next(words)) for _ in range(3)] for _ in range(vertices)]
    return positions, [[int(next(words)) for _ in range(int(next(words)))] for _ in range(faces)]


def from_least(facet):
    at = facet.index(min(facet))
    return facet[at:] + facet[:at]


def cross_sum(positions, facet):
    total = [0.0, 0.0, 0.0]
    for a, b in zip(facet, facet[1:] + facet[:1]):
        p, q = positions[a], positions[b]
        for k in range(3):
            total[k] += p[(k + 1) % 3] * q[(k + 2) % 3] - p[(k + 2) % 3] * q[(k + 1) % 3]
    return total


def check_mesh(page, off):
    data = json.loads(page.scripts["mesh"])
    positions, facets, triangles = decode(data)
    wanted, polygons = read_off(off)
    assert len(facets) == len(polygons) == data["facet_count"] and len(positions) == len(wanted)
    assert sum(map(len, facets)) == data["corner_count"]
    assert [from_least(f) for f in facets] == [from_least(f) for f in polygons]
    for p, q in zip(positions, wanted):
        assert max(abs(a - b) for a, b in zip(p, q)) <= 1e-6 * data["radius"]
    for facet, cut in zip(facets, triangles):  # the triangles are the facet, none turned over
        assert sorted(set(cut)) == sorted(facet)
        parts = [cross_sum(wanted, cut[i:i + 3]) for i in range(0, len(cut), 3)]
        whole = cross_sum(wanted, facet)
        assert all(abs(sum(p[k] for p in parts) - whole[k]) < 1e-9 for k in range(3))
    return data


def check_nothing_is_loaded(page, text):
    assert all(r.startswith("#") for r in page.references), page.references
    assert "default-src 'none'" in text
    style = text[text.index("<style>"):text.index("</style>")]
    assert "url(" not in style and "@import" not in style


# ---- Text -------------------------------------------------------------------------------------------------------

def a_page_is_well_formed_loads_nothing_and_holds_the_mesh(folder):
    shutil.copy(TESTDATA + "/part.ply", folder + "/part.ply")
    run(folder, "reconstruct", "part.ply", "--depth", "4", "--confidence", "-o", "part.off", "--html", "part.html", "--report", "part.json")
    page = read(folder + "/part.html")
    with open(folder + "/part.html", encoding="utf-8") as file:
        text = file.read()
    check_nothing_is_loaded(page, text)
    data = check_mesh(page, folder + "/part.off")
    with open(folder + "/part.json", encoding="utf-8") as file:
        report = json.load(file)
    shown = json.loads(page.scripts["report-json"])
    assert {**shown, "seconds": 0, "peak_memory_bytes": 0} == {**report, "seconds": 0, "peak_memory_bytes": 0}
    histogram = data["histogram"]
    assert sum(histogram["counts"]) + histogram["below"] + histogram["above"] == report["input"]["points"]
    deviations = struct.unpack(f"<{data['vertex_count']}h", base64.b64decode(data["deviations"]))
    largest = max(abs(d) for d in deviations if d != -32768) * data["deviation_step"]
    assert 0 < largest <= report["error"]["points_to_mesh_max"] * 1.0001
    of_points = struct.unpack(f"<{len(base64.b64decode(data['point_deviations'])) // 2}h", base64.b64decode(data["point_deviations"]))
    assert abs(max(map(abs, of_points)) * data["deviation_step"] / report["error"]["points_to_mesh_max"] - 1) < 1e-3
    assert len(packed(data["sharp_edges"])) == 2 * report["features"]["sharp_edges"]
    assert len(packed(data["corner_vertices"])) == report["features"]["corner_vertices"]
    assert len(base64.b64decode(data["confidence"])) == data["vertex_count"]
    assert f"{report['mesh']['faces']:,} facets" in page.text and "2-manifold" in page.text
    assert "MIT License" in text and "three.js authors" in text


def odd_names_break_nothing(folder):
    name = b"a<b>&\"'</script>{{report}}\xff.ply".replace(b"/", b"_")
    shutil.copy(TESTDATA.encode() + b"/box.ply", folder.encode() + b"/" + name)
    run(folder, "reconstruct", name, "--depth", "3", "-o", "box.off", "--html", "box.html", "--quiet")
    page = read(folder + "/box.html")
    wanted = "a<b>&\"'<_script>{{report}}\\xff.ply"
    assert page.title == wanted, page.title
    assert wanted in page.text
    check_mesh(page, folder + "/box.off")


def facets_of_many_corners_are_cut_as_the_stl_writer_cuts_them(folder):
    shutil.copy(TESTDATA + "/part.ply", folder + "/part.ply")
    run(folder, "reconstruct", "part.ply", "--max-error", "1%", "-o", "part.off", "--html", "part.html")
    check_mesh(read(folder + "/part.html"), folder + "/part.off")


def warnings_and_borders_are_places_to_go_to(folder):
    points = [(x / 10, y / 10, 0) for x in range(40) for y in range(40)]
    with open(folder + "/sheet.xyz", "w", encoding="ascii") as file:
        file.writelines(f"{x} {y} {z} 0 0 1\n" for x, y, z in points)
    run(folder, "reconstruct", "sheet.xyz", "-o", "sheet.off", "--html", "sheet.html", "--report", "sheet.json")
    page = read(folder + "/sheet.html")
    with open(folder + "/sheet.json", encoding="utf-8") as file:
        report = json.load(file)
    assert report["loops"] and not report["mesh"]["closed"]
    for loop in report["loops"]:
        assert loop["where"] in page.places
    for warning in report["warnings"]:
        assert warning["where"] in page.places
    assert "Border of the surface" in page.text


def points_that_are_no_numbers_and_strays_do_not_blur_the_figures(folder):
    with open(folder + "/sheet.xyz", "w", encoding="ascii") as file:
        file.writelines(f"{x / 10} {y / 10} 0 0 0 1\n" for x in range(40) for y in range(40))
        file.write("nan 0 0 0 0 1\n1 1 4000 0 0 1\n")
    run(folder, "reconstruct", "sheet.xyz", "-o", "sheet.off", "--html", "sheet.html")
    data = json.loads(read(folder + "/sheet.html").scripts["mesh"])
    histogram = data["histogram"]
    assert sum(histogram["counts"]) + histogram["below"] + histogram["above"] == 1600
    assert data["range"] < 1


def a_page_is_of_one_mesh_and_destroys_no_other_file(folder):
    for name in ("part", "box"):
        shutil.copy(f"{TESTDATA}/{name}.ply", f"{folder}/{name}.ply")
    refused = run(folder, "reconstruct", "part.ply", "box.ply", "--out-dir", "out", "--html", "a.html", status=2)
    assert b"--html FILE shows one mesh" in refused.stderr
    for other in ("part.ply", "part.off"):
        refused = run(folder, "reconstruct", "part.ply", "-o", "part.off", "--html", other, status=2)
        assert b"--html " + other.encode() in refused.stderr
    run(folder, "reconstruct", "part.ply", "-o", "part.off", "--html", "none/a.html", status=1)
    assert not os.path.exists(folder + "/part.off")
    run(folder, "reconstruct", "part.ply", "--levels", "3:4", "-o", "part.off", "--html", "part.html")
    assert read(folder + "/part.d3.html").title == "part.ply, depth 3"
    check_mesh(read(folder + "/part.d4.html"), folder + "/part.d4.off")
    out = run(folder, "reconstruct", "box.ply", "--depth", "3", "-o", "box.off", "--html", "-")
    assert Page(out.stdout.decode()).title == "box.ply" and out.stderr


# ---- Browser ----------------------------------------------------------------------------------------------------

def a_browser_draws_the_page_and_keys_turn_it(folder):
    shutil.copy(TESTDATA + "/part.ply", folder + "/part.ply")
    run(folder, "reconstruct", "part.ply", "--depth", "4", "--confidence", "-o", "part.off", "--html", "part.html")
    with browser.Browser(900, 700) as page:
        page.open(folder + "/part.html")
        page.value("document.getElementById('view').focus()")
        page.settle()
        seen = [page.picture("#view")]
        assert browser.colors(seen[0]) > 200, "the picture is blank"
        for key in ("ArrowLeft", "+", "c", "p", "d"):
            page.press(key)
            seen.append(page.picture("#view"))
            assert seen[-1] != seen[-2], f"{key} changes nothing"
        page.press("0")
        page.value("document.querySelector('.places button').click()")
        page.settle()
        assert page.value("!document.getElementById('marker').hidden"), "the place is not marked"
        assert browser.colors(page.picture("#view")) > 100
        assert page.value("document.querySelectorAll('#histogram rect').length") == 41
        assert page.pdf().startswith(b"%PDF")
        assert page.console == [], page.console
        assert all(url.startswith(("file:", "data:", "blob:")) for url in page.requests), page.requests


def main():
    in_browser = sys.argv[3:] == ["browser"]
    if in_browser and not browser.find():
        print("skipped: no chromium here; install it to see pages drawn")
        return 77
    if b"no three.js" in subprocess.run([HSDM, "reconstruct", "x", "-o", "y.off", "--html", "z"], capture_output=True).stderr:
        print("skipped: this build has no three.js, so it writes no pages")
        return 77
    tests = [a_browser_draws_the_page_and_keys_turn_it] if in_browser else [
        a_page_is_well_formed_loads_nothing_and_holds_the_mesh, odd_names_break_nothing,
        facets_of_many_corners_are_cut_as_the_stl_writer_cuts_them, warnings_and_borders_are_places_to_go_to,
        points_that_are_no_numbers_and_strays_do_not_blur_the_figures, a_page_is_of_one_mesh_and_destroys_no_other_file]
    for test in tests:
        with tempfile.TemporaryDirectory() as folder:
            test(folder)
        print("passed:", test.__name__.replace("_", " "))
    return 0


if __name__ == "__main__":
    sys.exit(main())
