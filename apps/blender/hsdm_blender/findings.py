"""A reconstruction's report in words, a line each."""

from functools import lru_cache
import json


@lru_cache(maxsize=8)  # panels are drawn again and again
def parsed(text):
    """The report of its JSON; an empty one where the property was changed into something else."""
    try:
        report = json.loads(text)
    except ValueError:
        return {}
    return report if isinstance(report, dict) else {}


def counts(mesh):
    """Facets by their sizes, and vertices."""
    sizes = [(mesh.get(key, 0), key) for key in ("quads", "triangles", "larger")]
    kinds = [f"{count:,} {name}" for count, name in sizes if count]
    if len(kinds) > 1:
        kinds.insert(0, f"{mesh.get('faces', 0):,} facets")
    return [*kinds, f"{mesh.get('vertices', 0):,} vertices"]


def topology(mesh):
    """Parts, borders and handles."""
    closed = "closed" if mesh.get("closed") else _several(mesh.get("boundary_loops", 0), "open border")
    line = f"{_several(mesh.get('components', 0), 'part')}, {closed}"
    return line + (f", genus {mesh['genus']}" if "genus" in mesh else "")


def errors(measured):
    """Distances of the points from the mesh, where they were measured."""
    told = (("mean error", "points_to_mesh_mean"), ("largest error", "points_to_mesh_max"))
    return [f"{name} {measured[key]:.4g}" for name, key in told if key in measured]


def left_out(report):
    """Points and facets that are not in the mesh."""
    unknown = report.get("input", {}).get("dropped_nonfinite", 0)
    said = [f"points without coordinates: {unknown:,}"] if unknown else []
    return said + [f"{one['what']}: {one['count']:,}" for one in report.get("dropped", [])]


def summary(report):
    """Counts and topology, for one line."""
    mesh = report.get("mesh", {})
    return [*counts(mesh), topology(mesh)]


def lines(report):
    """What became of it: counts, topology, resolution, edges, error."""
    grid, features = report.get("grid", {}), report.get("features", {})
    said = summary(report)
    if "sharp_edges" in features:
        corners = _several(features.get("corner_vertices", 0), "corner")
        said.append(f"{_several(features['sharp_edges'], 'sharp edge')}, {corners}")
    if "voxel_size" in grid:
        said.append(f"voxels of {grid['voxel_size']:.4g}, depth {grid.get('depth', '?')}")
    return said + errors(report.get("error", {})) + left_out(report)


def warnings(report):
    """The warnings as (text, place)."""
    told = []
    for warning in report.get("warnings", []):
        how_much = warning.get("how_much")
        text = warning.get("what", "") if how_much is None else f"{warning.get('what', '')}: {_number(how_much)}"
        told.append((text, tuple(warning.get("where", (0, 0, 0)))))
    return told


def _several(count, name):
    return f"{count:,} {name}" if count == 1 else f"{count:,} {name}s"


def _number(value):
    return value if isinstance(value, str) else f"{value:,.6g}"
