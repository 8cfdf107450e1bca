#!/usr/bin/env python3
"""sensitivity.py - what half and double of each tuning value do to the measurement suites.

    sensitivity.py list               the values of libhsdm/hsdm/*/constants.hh
    sensitivity.py registry           C++ that sets them from the environment; CMake asks for it (-DHSDM_SENSITIVITY=ON)
    sensitivity.py run [--cases REGEX] [--only REGEX] [--until HH:MM]
                                      tries them; what is known already is not tried again
    sensitivity.py table              writes docs/constants.md of what is known
    sensitivity.py check              fails if that page does not have the values as they are

`run` builds build/sensitivity, where every value can be set (HSDM_TUNED="placement.margin=0.004,..."), and keeps what it
finds in build/sensitivity/trials.json: a run that was stopped goes on. For each value, at half and at double, it
reconstructs some small clouds of both suites (SUBSET below, or those whose names match --cases), compares hashes of the
meshes, and has the cases whose mesh has changed judged from outside, by suite.py and meshjudge with a tenth of its samples.
What changes none of them is tried on a few more (MORE). Values of simplify/ are tried on adaptive grids, those of core/ and pipeline/
on all, all others on uniform ones. A case is sound if its mesh is a 2-manifold of the topology that the suite expects,
within limits if it keeps all of the suite's limits.

Half and double: of cosines and sines, the angle; of factors, what they exceed 1 by; of counts, at least one less and one
more. Angles are never more than 180 degrees, that of a sine 90.

Needs python3 and what the build needs; HSDM_SHARED_DIR, or ../shared, must hold the suites and their tools.
"""
import argparse, datetime, glob, itertools, json, math, os, re, subprocess, sys, time

HOME = os.path.normpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), ".."))
PAGE = os.path.join(HOME, "docs", "constants.md")
TREE = os.path.join(HOME, "build", "sensitivity")
SHARED = os.environ.get("HSDM_SHARED_DIR", os.path.normpath(os.path.join(HOME, "..", "shared")))
SUITES = ("data/suite.json", "data/crowd/suite.json")
TRIALS = os.path.join(TREE, "trials.json")
COUNTS = ("int", "std::int32_t", "std::size_t", "Index")
FOLDERS = ("core", "octree", "contour", "mesh", "pipeline", "features", "normals", "simplify")
SAMPLES = 20000
TOPOLOGICAL = ("manifold", "closed", "genus", "components", "boundary_loops", "euler", "oriented", "inside out", "exit",
               "no face", "judge")  # as suite.py
SUBSET = (
    "mechpart d4", "club d5", "engine d4", "hypersheet d5", "kitten d5", "sphere d4", "cube d3", "L bracket noisy d4",
    "wedge 30 d5", "B channel06 | n-depth", "B channel06 | e-depth", "E nnoise20_channel06 | n-depth",
    "E outl5_shaft | n-depth", "E outl5_noise025_genus20 | e-depth", "sweep plate 0.75 pose 0 | n",
    "sweep fin 0.75 pose 0 | n", "auto: mechpart", "B channel06 | n-auto", "B channel06 | e-auto",
    "adaptive: block pocket 0.1%", "A shaft | n-err", "B channel06 | n-err", "B channel06 | e-err",
    "E nnoise20_channel06 | n-err", "adaptive: fandisk 0.1%", "C drill06 | n-err", "F openbox | n-err", "A clevis | n-err")
MORE = ("noisy sphere d4", "bunny one scan d6", "range map, no normals d6", "E noise1_clevis | e-depth", "C hinge | n-err",
        "E noise1_clevis | n-err")
SHOWN = re.compile(r"HSDM_TUNED ([\w:]+) (\w+) = ([^;]+);")


def values():
    """Every value, with its stage, unit, meaning and reason."""
    found = []
    for folder in FOLDERS:
        stage, comment = None, []
        files = sorted(glob.glob(os.path.join(HOME, "libhsdm", "hsdm", folder, "*constants.hh")))
        for line in itertools.chain.from_iterable(map(open, files)):
            line = line.strip()
            if line.startswith("namespace hsdm::"):
                stage = line.split("::")[1].split()[0]
            if line.startswith("///"):
                comment.append(line[3:].strip())
                continue
            match = SHOWN.match(line)
            if match:
                text = " ".join(comment)
                unit, rest = text.split(": ", 1)
                meaning, why = rest.split(" Why: ", 1)
                kind, name, shown = match.groups()
                found.append({"folder": folder, "name": stage + "." + name, "type": kind, "shown": shown, "unit": unit,
                              "meaning": meaning, "why": why, "value": evaluated(shown)})
            comment = []
    return found


def evaluated(shown):
    return float(eval(shown, {"__builtins__": {}}))


def half_and_double(value):
    x, unit = value["value"], value["unit"]
    if value["type"] in COUNTS:
        return [max(0, min(int(x) - 1, int(x / 2))), max(int(x) + 1, int(2 * x))]
    if unit == "cosine":
        return [math.cos(math.acos(x) / 2), math.cos(min(math.pi, 2 * math.acos(x)))]
    if unit == "squared cosine":
        angle = math.acos(math.sqrt(x))
        return [math.cos(angle / 2) ** 2, math.cos(min(math.pi / 2, 2 * angle)) ** 2]
    if unit == "sine":
        return [math.sin(math.asin(x) / 2), math.sin(max(-math.pi / 2, min(math.pi / 2, 2 * math.asin(x))))]
    if unit == "radians":
        return [x / 2, min(math.pi, 2 * x)]
    if unit == "factor" and x > 1:
        return [1 + (x - 1) / 2, 1 + (x - 1) * 2]
    return [x / 2, x * 2]


def registry():
    print("// Written by docs/sensitivity.py: sets tuning values before main() from the environment.")
    for folder in FOLDERS:
        print('#include "hsdm/%s/constants.hh"' % folder)
    print("""
#include <cstdio>
#include <cstdlib>
#include <string>
#include <type_traits>

namespace {

struct Setter {
    const char* name;
    void (*set)(double);
};

template <auto& value>
void set(double to) {
    value = static_cast<std::remove_reference_t<decltype(value)>>(to);
}

constexpr Setter setters[] = {""")
    for value in values():
        print('    {"%s", set<hsdm::%s>},' % (value["name"], value["name"].replace(".", "::")))
    print("""};

void set_one(const std::string& text) {
    const std::size_t equals = text.find('=');
    for (const Setter& setter : setters)
        if (equals != std::string::npos && text.substr(0, equals) == setter.name)
            return setter.set(std::strtod(text.c_str() + equals + 1, nullptr));
    std::fprintf(stderr, "HSDM_TUNED: %s: no such value, or none given\\n", text.c_str());
    std::exit(2);
}

const bool are_set = [] {
    const char* const all = std::getenv("HSDM_TUNED");
    std::string rest = all ? all : "";
    while (!rest.empty()) {
        const std::size_t comma = rest.find(',');
        set_one(rest.substr(0, comma));
        rest = comma == std::string::npos ? "" : rest.substr(comma + 1);
    }
    return true;
}();

} // namespace""")


def build():
    configure = ["cmake", "-S", HOME, "-B", TREE, "-G", "Ninja", "-DCMAKE_BUILD_TYPE=Release", "-DHSDM_SENSITIVITY=ON",
                 "-DHSDM_BUILD_BENCHMARKS=OFF", "-DHSDM_BUILD_PLUGINS=OFF",
                 "-DCMAKE_CXX_COMPILER_LAUNCHER=ccache", "-DHSDM_SHARED_DIR=" + SHARED]
    for command in (configure, ["cmake", "--build", TREE, "--target", "hsdm_command", "hsdm_hashes"]):
        if subprocess.run(command, stdout=subprocess.DEVNULL).returncode:
            sys.exit("sensitivity.py: " + " ".join(command) + " failed")


def chosen_cases(is_chosen):
    """Per suite and name what the suite says."""
    cases = {}
    for suite in SUITES:
        path = os.path.join(SHARED, suite)
        listed = json.load(open(path))
        root = os.path.normpath(os.path.join(os.path.dirname(path), listed.get("root", ".")))
        for case in listed["cases"]:
            if is_chosen(case["name"]):
                cases[suite + " " + case["name"]] = dict(case, root=root)
    return cases


def is_adaptive(case):
    return "--max-error" in case["args"]


def hashes(cases, setting, seconds):
    """Per case its mesh's hash; a word if the program refused the setting, crashed or did not end in time."""
    names, out = os.path.join(TREE, "cases.txt"), os.path.join(TREE, "hashes.txt")
    with open(names, "w") as file:
        file.writelines(name + "\n" for name in cases)
    if os.path.exists(out):
        os.remove(out)
    environment = dict(os.environ, HSDM_TUNED=setting, HSDM_HASHES_OF=names, HSDM_WRITE_HASHES=out)
    program = os.path.join(TREE, "tests", "hashes", "hsdm_hashes")
    try:
        ended = subprocess.run([program, "the measurement suites' meshes have the bits that are kept"], env=environment,
                               stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=seconds)
    except subprocess.TimeoutExpired:
        return "does not end"
    if not os.path.exists(out):
        return "is refused" if ended.returncode > 0 else "crashes"
    lines = [line.split(" ", 2) for line in open(out).read().splitlines() if line[0] != "#"]
    return {name: geometry + features for geometry, features, name in lines}


def judge_program(suite):
    """meshjudge, with a tenth of its samples: it is the same judge before and after."""
    path = os.path.join(TREE, "judge.sh")
    with open(path, "w") as file:
        file.write('#!/bin/sh\nexec "%s" --samples %d "$@"\n' % (suite.judge_binary(), SAMPLES))
    os.chmod(path, 0o755)
    return path


def judged(cases, setting):
    """Per case: does it come out sound, and within all limits?"""
    sys.path.insert(0, os.path.join(SHARED, "tools"))
    import suite
    os.environ["HSDM_TUNED"] = setting
    judge, kept, result = judge_program(suite), os.path.join(TREE, "kept"), {}
    os.makedirs(kept, exist_ok=True)
    for name, case in cases.items():
        row = suite.run_case(case, [os.path.join(TREE, "apps", "hsdm", "hsdm")], judge, case["root"], kept, 60)
        topological = [f for f in row["fail"] if any(word in f for word in TOPOLOGICAL)]
        result[name] = {"sound": bool(row.get("manifold")) and not topological, "good": not row["fail"],
                        "fail": row["fail"]}
    os.environ["HSDM_TUNED"] = ""
    return result


def load():
    return json.load(open(TRIALS)) if os.path.exists(TRIALS) else {"trials": {}}


def save(known):
    with open(TRIALS + ".new", "w") as file:
        json.dump(known, file, indent=1)
    os.replace(TRIALS + ".new", TRIALS)


def trial(value, to, cases, base, limit):
    """What a setting changes."""
    setting = "%s=%r" % (value["name"], to)
    tried = {n: c for n, c in cases.items()
             if value["folder"] in ("core", "pipeline") or is_adaptive(c) == (value["folder"] == "simplify")}
    found = hashes(tried, setting, limit)
    if isinstance(found, str):
        return {"failure": found}
    changed = {n: c for n, c in tried.items() if found.get(n) != base["hashes"][n]}
    result = {"tried": len(tried), "changed": len(changed), "differences": {}}
    for name, now in judged(changed, setting).items():
        before = base["judged"][name]
        if (now["sound"], now["good"]) != (before["sound"], before["good"]):
            result["differences"][name] = {"before": before, "now": now}
    return result


def as_it_is(cases):
    """Hashes and judgements without a setting."""
    found = hashes(cases, "", 3600)
    if isinstance(found, str):
        sys.exit("sensitivity.py: hsdm_hashes " + found)
    return found


def run(options):
    build()
    first = chosen_cases(lambda name: re.search(options.cases, name) if options.cases else name in SUBSET)
    more = chosen_cases(lambda name: not options.cases and name in MORE)
    cases, known = dict(first, **more), load()
    begin = time.time()
    found = as_it_is(cases)
    seconds = time.time() - begin
    base = known.setdefault("base", {"hashes": {}, "judged": {}})
    if any(base["hashes"].get(name, hash) != hash for name, hash in found.items()):
        known = {"base": {"hashes": {}, "judged": {}}} # results are others now
        base = known["base"]
    base["judged"].update(judged({n: c for n, c in cases.items() if n not in base["judged"]}, ""))
    base["hashes"].update(found)
    trials = known.setdefault("trials", {})
    save(known)
    print("%d cases, %d adaptive; %.1f s a pass" % (len(cases), sum(map(is_adaptive, cases.values())), seconds), flush=True)
    listed = [v for v in values() if re.search(options.only, v["name"])]
    for number, value in enumerate(listed):
        for to in half_and_double(value):
            key = "%s=%r" % (value["name"], to)
            if options.until and datetime.datetime.now().strftime("%H:%M") >= options.until:
                return
            begin = time.time()
            if key not in trials:
                trials[key] = trial(value, to, first, base, 60 + 20 * seconds)
            elif trials[key].get("changed") != 0 or "more" in trials[key]:
                continue
            if trials[key].get("changed") == 0 and more:
                trials[key]["more"] = trial(value, to, more, base, 60 + 20 * seconds)
            save(known)
            print("%3d of %d  %-45s %5.1f s  %s" % (number + 1, len(listed), key, time.time() - begin, cell(trials[key])),
                  flush=True)


def cell(result):
    if result is None or "changed" not in result:
        return (result or {}).get("failure", "not tried")
    if result["changed"]:
        return counts(result)
    more = result.get("more", {})
    if more.get("changed"):
        return "none; of %d more, %s" % (more["tried"], counts(more))
    return "none; " + more["failure"] if "failure" in more else "no case changed"


def counts(result):
    text = "%d" % result["changed"]
    for key, word in (("sound", "sound"), ("good", "limits")):
        won = sum(d["now"][key] > d["before"][key] for d in result["differences"].values())
        lost = sum(d["now"][key] < d["before"][key] for d in result["differences"].values())
        if won or lost:
            text += ", %s %s" % (word, " ".join(["+%d" % won] * (won > 0) + ["-%d" % lost] * (lost > 0)))
    return text


def rounded(x):
    return "%.4g" % x


def told(value):
    """What the table says of a value itself."""
    return "| `%s` | %s | %s | %s *%s*" % (value["name"], rounded(value["value"]), value["unit"], sentence(value["meaning"]),
                                        sentence(value["why"]))


def cells_before():
    """Per name what the table has of half and double."""
    rows = [line.split(" | ") for line in open(PAGE) if line.startswith("| `")]
    return {row[0][3:-1]: [cell.rstrip(" |\n") for cell in row[-2:]] for row in rows}


def table():
    """Cells of what is not known here stay, if the value is the same."""
    trials, before, lines = load()["trials"], cells_before(), []
    for folder in FOLDERS:
        lines += ["", "## %s/" % folder, "",
                  "| name | value | unit | what, and *why this value* | half: cases | double: cases |",
                  "|---|---|---|---|---|---|"]
        for v in values():
            if v["folder"] != folder:
                continue
            cells = []
            for side, to in enumerate(half_and_double(v)):
                result = trials.get("%s=%r" % (v["name"], to))
                text = "%s: %s" % (rounded(to), cell(result))
                old = before.get(v["name"], ["", ""])[side]
                cells.append(old if result is None and old.startswith(rounded(to) + ":") else text)
            lines.append(told(v) + " | " + " | ".join(cells) + " |")
    head = open(PAGE).read().split("<!-- table -->")[0]
    with open(PAGE, "w") as file:
        file.write(head + "<!-- table -->\n" + "\n".join(lines).rstrip() + "\n")


def check():
    rows = open(PAGE).read().splitlines()
    stale = [v["name"] for v in values() if not any(row.startswith(told(v) + " |") for row in rows)]
    if stale:
        sys.exit("docs/constants.md is older than " + ", ".join(stale) + ": run docs/sensitivity.py run, then table")


def sentence(text):
    return text[0].upper() + text[1:]


def main():
    a = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    a.add_argument("what", choices=("list", "registry", "run", "table", "check"))
    a.add_argument("--cases", default="", help="names of cases that are tried, in place of SUBSET")
    a.add_argument("--only", default="", help="values that are tried")
    a.add_argument("--until", help="no trial begins after this time of day")
    options = a.parse_args()
    if options.what == "list":
        for v in values():
            print("%-12s %-40s %-10s %-14s %s" % (v["folder"], v["name"], rounded(v["value"]), v["unit"],
                                                 " ".join(rounded(x) for x in half_and_double(v))))
    elif options.what == "registry":
        registry()
    elif options.what == "run":
        run(options)
    else:
        {"table": table, "check": check}[options.what]()


if __name__ == "__main__":
    main()
