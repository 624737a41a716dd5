#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Tests the page of `candelabra report` with made-up results. Usage: test_report.py REPOSITORY"""
import json
import pathlib
import sys
import tempfile
import xml.dom.minidom

sys.path.insert(0, str(pathlib.Path(sys.argv[1]) / "tools/report"))
sys.dont_write_bytecode = True
import report  # noqa: E402

ORIGIN = {"candelabra": "1", "commit": "c <&>", "utc": "2026-01-01T00:00:00Z", "device": "gpu", "deviceType": "discrete GPU",
          "driver": "driver 1", "commandLine": "candelabra report"}
failures = []


def expect(condition, what):
    if not condition:
        failures.append(what)


def culling(ratio, low, high):
    point = {"scene": "hall", "widthPixels": 480, "heightPixels": 270, "lights": 1000, "overlaps": 8,
             "ratioToBestBaseline": ratio, "ratioToBestBaselineLow": low, "ratioToBestBaselineHigh": high,
             "bestBaseline": "froxels", "ratioToFloor": 2.0, "cullingOverShading": 0.3, "contributingOverListed": 0.5,
             "contributingOverListedToTiles": 3.0, "unlistedClusters": 0,
             "contenders": [{"name": "candelabra", "medianMs": 2.0, "passes": []}, {"name": "brute force", "medianMs": 30.0}]}
    return {"rounds": 6, "points": [point], "failures": [], "command": "candelabra bench culling", "seconds": 3.0}


def accuracy(mean, error):
    def point(method, factor):
        figures = {"samples": 9, "meanPercent": factor * mean, "p99Percent": 1.0, "maxPercent": 2.0}
        places = {"all": figures, "above": figures}
        return {"light": "sphere", "method": method, "error": {"fresnel1": places, "F0_0.04": places,
                "groupStandardErrorPercent": factor * error},
                "time": {"above": {"ratioToKaris": 2.0, "ratioToKarisLow": 1.9, "ratioToKarisHigh": 2.1}}}
    scene = {"name": "a < b", "points": [{"method": m, "error": {"flip": flip, "lit": {"relMse": 1e-4, "meanRel": 0.01}}}
                                         for m, flip in (("conic", 0.004), ("karis", 0.05))]}
    return {"kernels": {"groups": 9, "timing": {"rounds": 6}, "points": [point("conic", 1), point("karis", 20)]},
            "images": {"widthPixels": 4, "heightPixels": 3, "scenes": [scene]},
            "command": "candelabra report", "seconds": 3.0}


def page_of(folder, **parts):
    document = {"provenance": ORIGIN, "pictures": [], "charts": []} | parts
    (folder / "report.json").write_text(json.dumps(document), encoding="utf-8")
    report.main(folder, folder)
    xml.dom.minidom.parse(str(folder / "index.html"))  # throws if it is not well-formed
    return (folder / "index.html").read_text(encoding="utf-8")


with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    for ratio, interval, verdict in ((0.5, (0.4, 0.6), "faster in 1, slower in 0 of 1"),
                                     (1.5, (1.4, 1.6), "faster in 0, slower in 1 of 1"),
                                     (0.9, (0.7, 1.1), "faster in 0, slower in 0 of 1"),
                                     (0.5, (None, None), "faster in 0, slower in 0 of 1")):
        page = page_of(folder, culling=culling(ratio, *interval))
        expect(verdict in page, f"ratio {ratio} in {interval}: the page lacks \"{verdict}\"")
    expect("brute force takes 15 times as long" in page, "brute force is compared")
    expect("nothing to compare" in page, "a device without earlier results is not compared")
    no_times = culling(0, None, None)
    no_times["points"][0]["contenders"] = [{"name": "candelabra", "medianMs": 0.0, "passes": []}]
    expect("the device has no timestamps" in page_of(folder, culling=no_times), "times of 0 are no answer")
    wrong = culling(0.5, 0.4, 0.6) | {"failures": ["an image differs"]}
    expect("WRONG IMAGE" in page_of(folder, culling=wrong), "a wrong image is no success")
    expect("Would I see the errors?" not in page, "what was not measured has no answer")

    (folder / "accuracy-x.csv").write_text("# device: gpu\n# driver: driver 1\nlight,method,fresnel1.all.meanPercent\n"
                                           "sphere,conic,0.2\nsphere,karis,4.0\n", encoding="utf-8")
    (folder / "accuracy-y.csv").write_text("# device: other\n# driver: driver 1\nlight,method,fresnel1.all.meanPercent\n"
                                           "sphere,conic,9\n", encoding="utf-8")
    page = page_of(folder, accuracy=accuracy(0.2, 0.01))
    hidden = accuracy(0.2, 0.01)  # by noise
    hidden["kernels"]["points"][0]["time"]["above"]["ratioToKaris"] = 0
    expect("<td>0.00</td>" not in page_of(folder, accuracy=hidden), "a time hidden by noise is no ratio")
    expect("karis errs 20 times as much" in page, "errors of karis are compared with those of conic")
    expect("2 of 2 figures agree" in page and "differs" not in page.split("id=\"committed\"")[1].split("</p>")[1],
           "equal figures agree")
    expect("2 of 2 figures agree" in page_of(folder, accuracy=accuracy(0.3, 0.04)), "figures near the interval agree")
    page = page_of(folder, accuracy=accuracy(0.3, 0.01))
    expect("0 of 2 figures agree" in page and "<td>differs</td>" in page, "figures far from their interval differ")
    questions = page.split("<h2")[0].count("<tr>")
    expect(questions <= 8, f"at most eight questions, not {questions}")

print("\n".join(failures))
sys.exit(1 if failures else 0)
