#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The schemas of what --json writes: the committed benchmark results satisfy them, violations are found,
and they say nothing that is not checked. What the commands write is validated where tests run them (tests/gpu).
Usage: test_schemas.py REPOSITORY"""
import copy
import pathlib
import sys

root = pathlib.Path(sys.argv[1]).resolve()
sys.dont_write_bytecode = True  # the sources may be read-only, and are no place for results
sys.path.insert(0, str(root / "tests/harness"))
import json_schema

SCHEMAS = root / "tools/candelabra/schemas"
# jsonschema checks "format" only on request.
KEYWORDS = (json_schema.Validator.VALIDATORS.keys() - {"format"}) | {"$schema", "$defs", "title", "description"}
checked = 0
failures = []


def require(holds, what):
    global checked
    checked += 1
    if not holds:
        failures.append(what)


def faults(value, name, part="#"):
    return json_schema.faults(value, SCHEMAS / f"{name}.schema.json", part)


def name_of(schema):
    """The value that the member "schema" must have."""
    return json_schema.load(SCHEMAS / f"{schema}.schema.json")["properties"]["schema"]["const"]


def committed(kind):
    return json_schema.load(root / f"tools/bench/results/{kind}llvmpipe-mesa-22.3.6.json")


def parts(schema):
    """Yields a schema and all schemas within it."""
    yield schema
    for key, rule in schema.items():
        if key in ("const", "enum"):  # their values are no schemas
            continue
        if key in ("properties", "patternProperties", "dependentSchemas", "$defs"):  # schemas by name
            members = rule.values()
        else:
            members = rule if isinstance(rule, list) else [rule]
        for member in members:
            if isinstance(member, dict):
                yield from parts(member)


def unchecked_keywords(schema):
    """Returns the keywords anywhere in a schema that jsonschema does not check."""
    return {key for part in parts(schema) for key in part.keys() - KEYWORDS}


def committed_results_are_valid():
    for schema, kind in (("stress", ""), ("bench_accuracy", "accuracy-"), ("bench_culling", "culling-"),
                         ("bench_skip", "skip-"), ("bench_stability", "stability-"),
                         ("bench_stability", "inexact-stability-")):
        results = committed(kind)
        results["schema"] = name_of(schema)  # results from before the schemas do not name theirs
        found = faults(results, schema)
        require(not found, f"{schema}: {found}")
        del results["provenance"]
        require(faults(results, schema), f"{schema}: results without provenance are valid")


def schemas_say_nothing_that_is_not_checked():
    schemas = sorted(SCHEMAS.iterdir())
    require(len(schemas) >= 10, f"{len(schemas)} schemas")
    for path in schemas:
        schema = json_schema.load(path)
        json_schema.Validator.check_schema(schema)
        unchecked = unchecked_keywords(schema)
        require(not unchecked, f"{path.name} has {unchecked}, which jsonschema does not check")


def misspelt_keywords_are_found_at_any_depth():
    misspelt = {"type": "number", "minimun": 0}
    places = [{key: [{"type": "string"}, misspelt]} for key in ("allOf", "anyOf", "oneOf", "prefixItems")]
    places += [{key: misspelt} for key in ("items", "additionalProperties", "not", "if")]
    places += [{key: {"title": misspelt}} for key in ("properties", "patternProperties", "dependentSchemas", "$defs")]
    for place in [misspelt, *places, {"properties": {"size": {"items": places[0]}}}]:
        found = unchecked_keywords(place)
        require(found == {"minimun"}, f"the misspelt keyword of {place}: {found}")
    values = {"const": misspelt, "enum": [misspelt]}
    require(not unchecked_keywords(values), "values are taken for schemas")


def figures_have_bounds():
    influence = {"largestError": 0, "meanError": 0, "cutBelowLux": 0, "bruteForceMs": 0}
    for error, valid in ((0.5, True), (1, True), (1.5, False), (0, False)):
        found = faults({"maxError": error, **influence}, "render", "#/properties/influence")
        require((not found) == valid, f"an error of {error}: {found}")


def integers_are_written_as_such():
    skip = committed("skip-")["skips"]
    require(not faults(skip, "bench_skip", "#/properties/skips"), "skips")
    for wrong in (1.0, True, "1", None):
        found = faults({"index": wrong}, "devices", "#/properties/devices/items")
        require(any("$.index" in f for f in found), f"the index {wrong!r}: {found}")


def reports_hold_the_figures_of_their_commands():
    report = {"schema": name_of("report"), "provenance": committed("skip-")["provenance"]}
    for part in ("accuracy", "culling", "skip", "stability"):
        report[part] = committed(part + "-")
        for member in ("provenance", "schema"):
            report[part].pop(member, None)
    found = faults(report, "report")
    require(not found, f"report: {found}")
    wrong = copy.deepcopy(report)
    wrong["culling"]["points"][0]["tiles"] = -1
    found = faults(wrong, "report")
    require(any("tiles" in f for f in found), f"a negative number of tiles: {found}")


committed_results_are_valid()
schemas_say_nothing_that_is_not_checked()
misspelt_keywords_are_found_at_any_depth()
figures_have_bounds()
integers_are_written_as_such()
reports_hold_the_figures_of_their_commands()
for failure in failures:
    print(failure)
print(f"{checked} checks of the schemas, {len(failures)} failed")
sys.exit(1 if failures else 0)
