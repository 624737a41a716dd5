# SPDX-License-Identifier: Apache-2.0
"""Tables of measured figures: from the JSON that the program writes, and from the CSV files of tools/bench/results.
tools/update_results writes them into the documents, and report.py into the page of `candelabra report`."""
import csv
import re
import textwrap


def number(text):
    """Returns a number if the text is one, otherwise the text."""
    if not re.fullmatch(r"-?[0-9][0-9.]*(e[-+]?[0-9]+)?", text):
        return text
    return float(text) if re.search("[.e]", text) else int(text)


class Record:
    """A CSV file: `head` holds the lines before the columns, `rows` a dictionary for each row."""

    def __init__(self, path):
        self.path = path
        lines = path.read_text(encoding="utf-8").splitlines()
        self.head = dict(line[2:].split(": ", 1) for line in lines if line.startswith("# "))
        self.head |= {key: number(value) for key, value in self.head.items() if key != "commit"}
        self.rows = [{key: number(value) for key, value in row.items()}
                     for row in csv.DictReader(line for line in lines if not line.startswith("# "))]

    def command(self, columns=120):
        """Says how to measure the table again, and where its figures are."""
        return textwrap.fill(f"Command: `{self.head['command']}`, on {self.head['date'][:10]} at commit "
                             f"{self.head['commit']}; figures: [{self.path.name}](results/{self.path.name}).",
                             columns, break_long_words=False, break_on_hyphens=False)


PARTS = {"raster": ["cull_instances", "compact_instances", "cull_emitters", "cull_triangles",
                    "gbuffer_raster"],
         "culling": None,  # all passes that are not named here
         "shading": ["shade_tiles", "shade_unlisted"],
         "exposure": ["luminance_histogram", "adapt_exposure", "tone_map"]}


def part_times(passes):
    """Returns the milliseconds of each part of a frame."""
    part_of = {p: part for part, names in PARTS.items() for p in names or []}
    ms = dict.fromkeys((f"{part}Ms" for part in PARTS), 0)
    for p in passes:
        ms[part_of.get(p["name"], "culling") + "Ms"] += p["medianMs"]
    return ms


def place(value, path):
    """Returns the value at a path such as "fresnel1/all/meanPercent"."""
    for key in path.split("/"):
        value = value[key]
    return value


def chosen(value, paths):
    return {path.replace("/", "."): place(value, path) for path in paths}


def import_culling(data):
    rows = []
    for p in data["points"]:
        own = next(c for c in p["contenders"] if c["name"] == "candelabra")
        walk = next((k["medianMs"] for k in own["passes"] if k["name"] == "shade_unlisted"), 0)
        rows.append(chosen(p, ["scene", "widthPixels", "heightPixels", "lights", "overlaps", "ratioToBestBaseline",
                               "bestBaseline", "ratioToFloor", "cullingOverShading", "contributingOverListed",
                               "contributingOverListedToTiles", "unlistedClusters"])
                    | {"unlistedOverTime": walk / own["medianMs"] if own["medianMs"] else 0})
    return {"culling": ({"rounds": data["rounds"]}, rows)}


ERRORS = ["fresnel1/all/meanPercent", "fresnel1/all/p99Percent", "fresnel1/all/maxPercent",
          "fresnel1/above/meanPercent", "fresnel1/above/p99Percent", "F0_0.04/all/meanPercent",
          "F0_0.04/all/p99Percent", "F0_0.04/all/maxPercent"]
THIN_ERRORS = [f"fresnel1/{where}/{figure}" for where in ("above", "crossing")
               for figure in ("samples", "meanPercent", "p99Percent", "maxPercent")]
PART_ERRORS = [f"{part}/fresnel1/{figure}" for part in ("formulaAgainstTruth", "float32AgainstFormula")
               for figure in ("meanPercent", "p99Percent", "maxPercent")]
TIMES = ["above", "near", "general"]
THIN = [1, 0.1, 0.001, 1e-5]  # sizes and thicknesses of the table of thin lights


def import_accuracy(data):
    kernels, images = data["kernels"], data["images"]
    thin = data.get("thinLights", {"groups": 0, "points": []})  # reports have none
    points = kernels["points"]
    lights = [chosen(p, ["light", "method"]) for p in points]
    return {"accuracy": ({"groups": kernels["groups"]},
                         [light | chosen(p["error"], ERRORS) for light, p in zip(lights, points)]),
            "rounding": ({"groups": kernels["groups"]},
                         [light | chosen(p["error"], PART_ERRORS) for light, p in zip(lights, points)
                          if "formulaAgainstTruth" in p["error"]]),
            "price": ({"rounds": kernels["timing"]["rounds"]},
                      [light | {t: p["time"].get(t, {}).get("ratioToKaris") or "" for t in TIMES}
                       for light, p in zip(lights, points)]),
            "thin-lights": ({"groups": thin["groups"]},
                            [chosen(p, ["light", "size", "thickness"]) | chosen(p["error"], THIN_ERRORS)
                             for p in thin["points"] if p["size"] in THIN and p["thickness"] in THIN]),
            "images": (chosen(images, ["widthPixels", "heightPixels"]),
                       [{"scene": s["name"]} | chosen(p["error"], ["lit/relMse", "lit/meanRel", "flip"])
                        for s in images["scenes"] for p in s["points"] if p["method"] == "conic"])}


def import_stability(data):
    name = "inexact-stability" if data["inexactDivision"] else "stability"
    return {name: (chosen(data, ["configurations", "invalid"]),
                   [chosen(c, ["evaluation", "meanPercent", "p99Percent", "maxPercent"])
                    for c in data["formulaAgainstQuadrature"]])}


def short_name(origin):
    """Returns the end of the names of tables: device and driver, as in llvmpipe-mesa-22.3.6."""
    words = []
    for text in (origin["device"], origin["driver"]):
        words += [w for w in re.sub(r"\(.*?\)", "", text).lower().split() if w not in words]
    return re.sub(r"[^a-z0-9.-]+", "-", "-".join(words))


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join(lines + ["| " + " | ".join(row) + " |" for row in rows])


# (end, name): records made before `end` show the hall of that name (RESULTS.md, "Terms"). Later ones show today's hall.
HALLS = [("2026-11-23T06:21", "the hall before 2026-11-23"), ("2026-11-27T16:17", "the hall of 2026-11-23")]


def hall(record):
    """Returns the name of the hall that a record shows: "the hall", or that of an earlier one."""
    return next((name for until, name in HALLS if record.head["date"] < until), "the hall")


def hall_note(record):
    """Returns a sentence that follows a table if it shows an earlier hall."""
    name = hall(record)
    return "" if name == "the hall" else f"\n\nMeasured in {name}."


def image_size(row):
    return f"{row['widthPixels']}x{row['heightPixels']}"


def culling(data):
    rows = [[f"{p['scene']}, {p['lights']:,}", str(p["overlaps"]), f"{p['ratioToBestBaseline']:.2f}",
             f"{p['ratioToFloor']:.2f}", f"{100 * p['cullingOverShading']:.0f}%",
             f"{p['contributingOverListed']:.2f}", f"{p['contributingOverListedToTiles']:.1f}"]
            for p in data.rows]
    best = [p["bestBaseline"] for p in data.rows]
    text = (f"{', '.join(dict.fromkeys(map(image_size, data.rows)))}, medians of {data.head['rounds']} interleaved rounds. "
            "The best other method: "
            + ", ".join(f"{name} in {best.count(name)}" for name in dict.fromkeys(best)) + f" of {len(best)} rows.")
    for row, p in zip(rows, data.rows):
        if p["unlistedClusters"]:
            text += (f" In the row \"{row[0]}\", {row[1]} overlaps, {p['unlistedClusters']:,} clusters have too many lights "
                     f"for a list. Their pixels walk the light tree, which takes "
                     f"{100 * p['unlistedOverTime']:.0f}% of the time.")
    return table(["scene, lights", "overlaps", "time / best other method", "time / floor",
                  "culling / shading", "list efficiency", "list efficiency / that of 16x16 tiles"],
                 rows) + "\n\n" + textwrap.fill(text, 118) + hall_note(data)


LIGHT_NAMES = {"distant_sphere": "distant sphere"}


def percent(value):
    """Formats a percentage with three digits, or two if it is below 1."""
    for most, text in ((1, f"{value:.2g}"), (10, f"{value:.2f}"), (100, f"{value:.1f}")):
        if value < most:
            return text
    return f"{value:,.0f}"


def errors_by_light(data):
    return {(row["light"], row["method"]): row for row in data.rows}


def column(path):
    return path.replace("/", ".")


def accuracy(data):
    points = errors_by_light(data)
    shown = [("sphere", m) for m in ("conic", "conic-full", "ltc", "karis", "kx")]
    shown += [("distant_sphere", "conic"), ("distant_sphere", "karis")]
    others = dict.fromkeys(light for light, _ in points if light not in ("sphere", "distant_sphere"))
    shown += [(light, m) for light in others for m in ("conic", "ltc", "karis")]
    rows = [[f"{LIGHT_NAMES.get(light, light)}, `{method}`"]
            + [percent(points[light, method][column(path)]) for path in ERRORS]
            for light, method in shown if (light, method) in points]
    return table(["light, method", "F = 1: mean", "p99", "largest", "above the horizon: mean",
                  "above the horizon: p99", "F0 = 0.04: mean", "p99", "largest"], rows)


def conic_times(data):
    """Yields a light type, the place of the light, and the time of conic over that of karis."""
    for row in data.rows:
        if row["method"] == "conic":
            for where in TIMES:
                if row[where] != "":
                    yield row["light"], where, row[where]


def price(data):
    ratios = {}
    for light, where, ratio in conic_times(data):
        ratios.setdefault(light, {})[where] = f"{ratio:.2f}"
    rows = [[LIGHT_NAMES.get(light, light)] + [r.get(where, "") for where in TIMES] for light, r in ratios.items()]
    return table(["one light at one pixel", "above the horizon", "near it", "across it"], rows)


def images(data):
    return table(["scene", "lit relMSE", "lit mean relative error", "FLIP"],
                 [[p["scene"], f"{p['lit.relMse']:.1e}", f"{100 * p['lit.meanRel']:.2g}%", f"{p['flip']:.4f}"]
                  for p in data.rows])


def stability(data):
    checks = {c["evaluation"]: c for c in data.rows}
    rows = [[f"{LIGHT_NAMES.get(light, light)}, `{method}`"]
            + [percent(checks[f"{light} {method}"][k + "Percent"]) for k in ("mean", "p99", "max")]
            for light, method in [(l, "conic") for l in dict.fromkeys(c.split()[0] for c in checks)]
            + [("sphere", "karis")]]
    return (f"{data.head['configurations']:,} configurations, {data.head['invalid']:,} responses NaN, infinite, "
            "negative or above the bound.\n\n" + table(["light, method", "mean", "p99", "largest"], rows))
