#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Validates JSON by a schema of tools/candelabra/schemas, with the package jsonschema.
Usage: json_schema.py SCHEMA [PART] < JSON
SCHEMA is the path of a schema, PART a place in it such as "#/properties/points". Prints what is wrong
and where, one line per fault, and exits with 1 if there is any."""
import json
import pathlib
import sys
import warnings

# RefResolver is deprecated since jsonschema 4.18; Debian 12, which has 4.10, knows nothing else.
warnings.filterwarnings("ignore", category=DeprecationWarning)
import jsonschema


def integer(_, value):
    """JSON Schema takes 1.0 for an integer, but whoever reads a report may not."""
    return isinstance(value, int) and not isinstance(value, bool)


Validator = jsonschema.validators.extend(
    jsonschema.Draft202012Validator,
    type_checker=jsonschema.Draft202012Validator.TYPE_CHECKER.redefine("integer", integer))


def refuse(constant):
    raise ValueError(f"{constant} is not JSON")


def parsed(text):
    return json.loads(text, parse_constant=refuse)


def load(path):
    return parsed(path.read_text(encoding="utf-8"))


def faults(value, path, part="#"):
    """Returns what is wrong with a value, as one line per fault."""
    resolver = jsonschema.RefResolver(path.resolve().as_uri(), load(path))
    errors = Validator({"$ref": part}, resolver=resolver).iter_errors(value)
    return [f"{e.json_path}: {e.message}"[:1000] for e in errors]


if __name__ == "__main__":
    found = faults(parsed(sys.stdin.buffer.read().decode("utf-8")), pathlib.Path(sys.argv[1]), *sys.argv[2:])
    for fault in found:
        print(fault)
    sys.exit(1 if found else 0)
