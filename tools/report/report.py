#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the page of `candelabra report`, which runs it. Usage: report.py FOLDER [RESULTS]
FOLDER has report.json and the pictures and charts that it names. The page, index.html, needs no other file.
RESULTS is a folder of CSV files of earlier results; default: those of the project."""
import base64
import html
import json
import math
import os
import sys
from pathlib import Path
from types import SimpleNamespace

import figures

here = Path(__file__).resolve().parent
# A figure differs from the committed one if that lies outside its 95% interval by more than this share of it.
FAR = 0.25

STYLE = """
:root { color-scheme: light dark; --line: #8884; --soft: #8881; --dim: #666; }
@media (prefers-color-scheme: dark) { :root { --dim: #aaa; } svg { filter: invert(0.9) hue-rotate(180deg); } }
body { font: 15px/1.5 "DejaVu Sans", Helvetica, Arial, sans-serif; margin: 2em auto; max-width: 1100px; padding: 0 1em; }
p { max-width: 48em; }
h2 { margin-top: 2em; border-bottom: 1px solid var(--line); }
table { border-collapse: collapse; font-size: 13px; font-variant-numeric: tabular-nums; margin: 1em 0; }
th, td { text-align: left; vertical-align: top; padding: 3px 14px 3px 0; border-bottom: 1px solid var(--line); }
tbody tr:nth-child(even) { background: var(--soft); }
.scroll { overflow-x: auto; }
.answers { font-size: 15px; }
figure { display: inline-block; margin: 0 10px 14px 0; vertical-align: top; }
figure img { display: block; image-rendering: pixelated; }
figcaption, .made { font-size: 12.5px; color: var(--dim); max-width: 320px; }
.made { max-width: none; }
svg { max-width: 100%; height: auto; }
"""

CHAPTERS = {
    "profile": ("Where the time of a frame goes", "Times are medians over the frames, on the device. gbuffer_raster draws "
                "the surfaces, cluster_lists finds the lights of groups of pixels, and shade_tiles evaluates them."),
    "accuracy": ("How far the light is from the truth", "The truth is quadrature in double precision. Errors are in percent "
                 "of the largest true response of such a light on such a surface. `conic` is Candelabra's formula, `karis` the "
                 "representative point of Karis (2013), and `ltc` are linearly transformed cosines (Heitz et al. 2016). The "
                 "second table has the time of `conic` over that of `karis`, for lights above, near and across the horizon of "
                 "the surface. FLIP (Andersson et al. 2020) is the difference that a person sees, from 0 to 1."),
    "culling": ("How culling compares", "The same frame is lit in five ways in turn: by Candelabra, with lists for 16x16 "
                "tiles, with lists for froxels, by brute force, and without looking for lights (floor). List efficiency is the "
                "share of listed lights that add light to the pixel."),
    "stability": ("Inputs that are hard for formulas", "The formulas were fed with random inputs and with inputs at the "
                  "limits of float32: contact, grazing views, extreme sizes. The table compares them with quadrature, in "
                  "percent of the response on the mirror axis."),
}


def to_html(markdown):
    """Converts paragraphs, tables and `code`."""
    def inline(text):
        parts = html.escape(text).split("`")
        return "".join(f"<code>{part}</code>" if i % 2 else part for i, part in enumerate(parts))

    out = []
    for block in markdown.split("\n\n"):
        if not block.startswith("|"):
            out.append(f"<p>{inline(block)}</p>")
            continue
        rows = [[inline(cell.strip()) for cell in line.strip("|").split("|")] for line in block.splitlines()]
        head, *body = ["".join(f"<{tag}>{cell}</{tag}>" for cell in row)
                       for row, tag in [(rows[0], "th")] + [(row, "td") for row in rows[2:]]]
        out.append(f'<div class="scroll"><table><thead><tr>{head}</tr></thead><tbody>'
                   + "".join(f"<tr>{row}</tr>" for row in body) + "</tbody></table></div>")
    return "\n".join(out)


def records(report):
    """Returns the tables of the report by their names: objects with `head` and `rows`, as those of CSV files."""
    tables = {}
    for part, take in (("culling", figures.import_culling), ("accuracy", figures.import_accuracy),
                       ("stability", figures.import_stability)):
        tables |= take(report[part]) if part in report else {}
    date = report["provenance"]["utc"]
    return {name: SimpleNamespace(head={"date": date} | head, rows=rows) for name, (head, rows) in tables.items()}


# --- Answers ------------------------------------------------------------------------------------------------------


def times_range(values):
    low, high = (f"{value:,.0f}" if value >= 10 else f"{value:.2g}" for value in (min(values), max(values)))
    return low if low == high else f"{low} to {high}"


NO_TIMES = "the device has no timestamps, or all times are 0"


def verdict_of(report, verdict):
    """Returns the verdict on culling, unless an image was wrong."""
    return "WRONG IMAGE, see there" if report["culling"]["failures"] else verdict


def speed(report):
    run = report["profile"]
    if not run["time"]["gpu"]["medianMs"]:
        return ("How fast is a frame?", NO_TIMES, "-", "profile")
    ms = figures.part_times(run["time"]["passes"])
    lighting, frame = ms["cullingMs"] + ms["shadingMs"], run["time"]["gpu"]["medianMs"]
    verdict = f"{1000 / frame:.3g} frames/s" + (" on a CPU" if report["provenance"]["deviceType"] == "CPU" else "")
    return ("How fast is a frame?", f"{run['scene']['name']}, {run['scene']['lights']:,} lights, "
            f"{figures.image_size(run['image'])}: lighting takes {lighting:.3g} of {frame:.3g} ms of GPU time", verdict, "profile")


def brute_force(report):
    question, drawn = "What does culling save?", []
    for p in report["culling"]["points"]:
        ms = {c["name"]: c.get("medianMs") for c in p["contenders"]}
        if ms["candelabra"] and ms.get("brute force"):
            drawn.append((p, ms["brute force"] / ms["candelabra"]))
    if not drawn:
        return question, "brute force took too long to be drawn, or had no time", "-", "culling"
    p, ratio = max(drawn, key=lambda entry: entry[0]["lights"])
    return (question, f"{p['scene']}, {p['lights']:,} lights, {figures.image_size(p)}: brute force takes "
            f"{times_range([ratio])} times as long", verdict_of(report, "faster" if ratio > 1 else "slower"), "culling")


def best_other(report):
    points = report["culling"]["points"]
    if not any(p["ratioToBestBaseline"] for p in points):
        return ("Is another way of culling faster?", NO_TIMES, "-", "culling")
    faster = sum((p["ratioToBestBaselineHigh"] or 9) < 1 for p in points)
    slower = sum((p["ratioToBestBaselineLow"] or 0) > 1 for p in points)
    ratios = times_range([p["ratioToBestBaseline"] for p in points])
    return ("Is another way of culling faster?", f"Candelabra takes {ratios} times as long as the best other way",
            verdict_of(report, f"faster in {faster}, slower in {slower} of {len(points)}"), "culling")


def accurate(report):
    error = {(p["light"], p["method"]): p["error"]["fresnel1"]["all"]["meanPercent"]
             for p in report["accuracy"]["kernels"]["points"]}
    own = {light: value for (light, method), value in error.items() if method == "conic"}
    karis = [error[light, "karis"] / value for light, value in own.items() if (light, "karis") in error]
    return ("How accurate are highlights?", "mean error of metal, % of the peak: "
            + ", ".join(f"{light} {figures.percent(value)}" for light, value in own.items()),
            f"karis errs {times_range(karis)} times as much", "accuracy")


def visible(report):
    flip = {method: [p["error"]["flip"] for s in report["accuracy"]["images"]["scenes"] for p in s["points"]
                     if p["method"] == method] for method in ("conic", "karis")}
    return ("Would I see the errors?", f"mean FLIP of each scene {times_range(flip['conic'])}; by karis {times_range(flip['karis'])}",
            "hardly" if max(flip["conic"]) < 0.01 else "in places", "accuracy")


def price(report):
    ratios = [t["ratioToKaris"] for p in report["accuracy"]["kernels"]["points"] if p["method"] == "conic"
              for t in p["time"].values() if t["ratioToKaris"] > 0]
    return ("What does accuracy cost?", f"one light at one pixel takes {times_range(ratios)} times as long as by karis",
            "slower" if max(ratios) > 1 else "nothing", "accuracy") if ratios else (
            "What does accuracy cost?", NO_TIMES, "-", "accuracy")


def stable(report):
    s = report["stability"]
    return ("Can bad inputs break it?", f"{s['invalid']:,} of {s['configurations']:,} gave NaN, infinite, negative or "
            "impossibly bright light", "no" if s["invalid"] == 0 else "YES", "stability")


def committed(folder, origin, tables):
    """Returns rows (figure, this run, earlier run, whether they differ) for all figures that both have."""
    earlier = {}
    for path in sorted(folder.glob("*.csv")):
        record = figures.Record(path)
        if (record.head.get("device"), record.head.get("driver")) == (origin["device"], origin["driver"]):
            earlier.setdefault(path.name.split("-")[0], record)
    out = []
    for table, column in (("accuracy", "fresnel1.all.meanPercent"), ("price", "above")):
        old = {(row["light"], row["method"]): row[column] for row in earlier[table].rows} if table in earlier else {}
        for row in tables[table].rows if table in tables else []:
            before, now = old.get((row["light"], row["method"]), ""), row[column]
            if "" in (before, now) or before == now == 1:  # the price of karis is 1 by definition
                continue
            low, high = row["interval"]
            far = max(low - before, before - high) > FAR * abs(before)
            out.append((f"{table}, {row['light']}, {row['method']}", now, before, far))
    return out


def same_as_committed(rows):
    if not rows:
        return "Same as earlier runs?", "nothing to compare: this run or the committed ones of this device lack accuracy", "-", "committed"
    far = sum(row[3] for row in rows)
    return ("Same as earlier runs?", f"{len(rows) - far} of {len(rows)} figures agree with the committed ones",
            "yes" if not far else "look", "committed")


def add_intervals(report, tables):
    """Gives the rows that are compared with earlier results an interval."""
    if "accuracy" not in report:
        return
    for row, price, p in zip(tables["accuracy"].rows, tables["price"].rows, report["accuracy"]["kernels"]["points"]):
        mean, margin = row["fresnel1.all.meanPercent"], 1.96 * p["error"]["groupStandardErrorPercent"]
        row["interval"] = (mean - margin, mean + margin)
        time = p["time"].get("above", {})
        # JSON has no infinity: null is no upper bound.
        low, high = time.get("ratioToKarisLow") or 0, time.get("ratioToKarisHigh")
        price["interval"] = (low, math.inf if high is None else high)


# --- The page -----------------------------------------------------------------------------------------------------


def answers(report, compared):
    makers = {"profile": [speed], "culling": [brute_force, best_other], "accuracy": [accurate, visible, price],
              "stability": [stable]}
    rows = [make(report) for part, functions in makers.items() if part in report for make in functions]
    rows.append(same_as_committed(compared))
    cells = "".join(f'<tr><td>{html.escape(question)}</td><td>{html.escape(answer)}</td><td><b>{html.escape(verdict)}</b>'
                    f'</td><td><a href="#{chapter}">more</a></td></tr>\n' for question, answer, verdict, chapter in rows)
    return f'<div class="scroll"><table class="answers"><tbody>\n{cells}</tbody></table></div>'


def pictures(report, folder, chapter):
    out = []
    for picture in report["pictures"]:
        if picture["chapter"] == chapter:
            data = base64.b64encode((folder / picture["file"]).read_bytes()).decode()
            title = html.escape(picture["title"])
            out.append(f'<figure><img alt="{title}" src="data:image/png;base64,{data}"/>'
                       f"<figcaption>{title}</figcaption></figure>")
    return "\n".join(out)


def charts(report, folder, chapter):
    return "\n".join(f'<div class="scroll">{(folder / c["file"]).read_text(encoding="utf-8")}</div>'
                     for c in report["charts"] if c["chapter"] == chapter)


def passes(run):
    rows = [[p["name"], f"{p['medianMs']:.3g}", f"{p['p95Ms']:.3g}"] for p in run["time"]["passes"]]
    rows.append(["all passes", f"{run['time']['gpu']['medianMs']:.3g}", f"{run['time']['gpu']['p95Ms']:.3g}"])
    lights = [[str(l["light"]), l["type"], f"{l['influenceRadius']:.3g}", f"{l['pixels']:,}", f"{100 * l['share']:.1f}%"]
              for l in run["lightCosts"]["lights"][:10]]
    return (figures.table(["pass", "median ms", "p95 ms"], rows) + "\n\nThe lights that take the most shading time:\n\n"
            + figures.table(["light", "type", "influence radius m", "pixels", "share of shading"], lights))


def chapter(report, tables, folder, name):
    title, text = CHAPTERS[name]
    make = {"profile": lambda: passes(report["profile"]),
            "accuracy": lambda: "\n\n".join([figures.accuracy(tables["accuracy"]), figures.price(tables["price"]),
                                             figures.images(tables["images"])]),
            "culling": lambda: "\n\n".join([figures.culling(tables["culling"]), *report["culling"]["failures"]]),
            "stability": lambda: figures.stability(tables["stability"])}
    made = f'<p class="made">made by <code>{html.escape(report[name]["command"])}</code> in {report[name]["seconds"]:.0f} s</p>'
    return "\n".join([f'<h2 id="{name}">{html.escape(title)}</h2>', to_html(text), charts(report, folder, name),
                      to_html(make[name]()), made])


def comparison(rows):
    text = (f"A figure differs if the committed one lies outside its 95% interval by more than {100 * FAR:.0f}%. That is a "
            "reason to look, and no proof of a fault. Accuracy is the mean error in percent. Price is the time of one light at "
            "one pixel over that by karis. Culling is not compared, because this run's pictures are smaller.")
    table = figures.table(["figure", "this run", "committed", ""],
                          [[name, f"{now:.3g}", f"{before:.3g}", "differs" if far else ""] for name, now, before, far in rows])
    return f'<h2 id="committed">This run and the committed results</h2>\n{to_html(text)}\n' + (to_html(table) if rows else "")


def page(report, folder, results):
    tables = records(report)
    add_intervals(report, tables)
    origin = report["provenance"]
    compared = committed(results, origin, tables)
    parts = [name for name in CHAPTERS if name in report]
    title = "Candelabra: how fast and how accurate"
    shown = "\n".join(pictures(report, folder, name) for name in ("profile", "accuracy") if name in report)
    measured = (f"Candelabra {origin['candelabra']} (commit {origin['commit']}) on {origin['device']}, driver "
                f"{origin['driver']}, {origin['utc'][:10]}.")
    if origin["deviceType"] == "CPU":
        measured += (" This device is a CPU: errors are those of any device up to rounding, ratios of times hint at a GPU's, "
                     "and milliseconds do not.")
    return "\n".join([
        f'<!DOCTYPE html>\n<html lang="en"><head><meta charset="utf-8"/><meta name="viewport" '
        f'content="width=device-width, initial-scale=1"/><link rel="icon" href="data:,"/><title>{title}</title>'
        f"<style>{STYLE}</style></head><body>\n<h1>{title}</h1>",
        f"<p>{html.escape(measured)}</p>", answers(report, compared),
        f'<h2 id="pictures">Pictures</h2>\n{shown}' if shown else "",
        *(chapter(report, tables, folder, name) for name in parts), comparison(compared),
        f'<p class="made">made by <code>{html.escape(origin["commandLine"])}</code></p>\n</body></html>\n'])


def main(folder, results=None):
    folder = Path(folder)
    if results is None:  # installed beside this script, or in the source tree
        results = here if list(here.glob("*.csv")) else here.parent / "bench/results"
    report = json.loads((folder / "report.json").read_text(encoding="utf-8"))
    text = page(report, folder, Path(results))
    temporary = folder / f"index.html.{os.getpid()}"
    try:
        temporary.write_text(text, encoding="utf-8")
        temporary.replace(folder / "index.html")
    except OSError as error:
        temporary.unlink(missing_ok=True)
        sys.exit(f"{folder / 'index.html'}: {error.strerror}")


if __name__ == "__main__":
    main(*sys.argv[1:])
