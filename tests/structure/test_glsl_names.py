#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""The shaders that hosts' GLSL is compiled together with (shaders/host_shaders.cmake) declare no name
outside functions that does not begin with cnd, Cnd, CND_ or CANDELABRA_. Usage: test_glsl_names.py
REPOSITORY"""
import pathlib
import re
import subprocess
import sys
import tempfile

root = pathlib.Path(sys.argv[1]).resolve()
PREFIXED = re.compile(r"(cnd|Cnd|CND_|CANDELABRA_)[A-Z0-9_]")
# Names that GLSL and the functions of hosts define.
GIVEN = {"main", "candelabraVisibility", "candelabraReadSurface", "candelabraVisiblePoints"}
TOKEN = re.compile(r"[A-Za-z_]\w*|##|\S")
failures = []


def words(code):
    return re.sub(r"//[^\n]*", "", code).replace("\\\n", " ")


def group(tokens, at, opening, closing):
    """The index after the bracket that closes the one at `at`."""
    depth = 0
    while True:
        depth += (tokens[at] == opening) - (tokens[at] == closing)
        at += 1
        if not depth:
            return at


def declared(tokens):
    """Yields the names that tokens outside functions declare: of functions, structs, variables, blocks, the
    members of blocks without an instance name, and the arguments of macros that stand alone."""
    at = 0
    while at < len(tokens):
        if tokens[at] == ";":
            at += 1
        elif tokens[at] == "layout":
            at = group(tokens, at + 1, "(", ")")
        elif tokens[at] == "struct":
            yield tokens[at + 1]
            at = group(tokens, at + 2, "{", "}")
        elif tokens[at].isupper():  # a macro
            end = at + 1
            if tokens[end:end + 1] == ["("]:
                end = group(tokens, end, "(", ")")
            yield from (t for t in tokens[at + 2:end] if re.match("[a-z]", t))
            at = end
        else:
            head = at
            while tokens[at] not in ("(", "{", ";", "=", ",", "["):
                at += 1
            if at - head == 1 and tokens[at] == ";":  # "layout(local_size_x = 8) in;"
                continue
            if tokens[at] == "[" and re.match(r"\w", tokens[group(tokens, at, "[", "]")]):
                at = group(tokens, at, "[", "]")  # the brackets of an array type
                continue
            yield tokens[at - 1]
            if tokens[at] == "(":
                at = group(tokens, at, "(", ")")
                if tokens[at] == "{":
                    at = group(tokens, at, "{", "}")
            elif tokens[at] == "{":
                end = group(tokens, at, "{", "}")
                if tokens[end] == ";":
                    yield from (a for a, b in zip(tokens[at:end], tokens[at + 1:end])
                                if b in (";", "[", ",") and a != "]")
                else:
                    yield tokens[end]
                    end += 1
                at = end
            else:  # a variable, and others after commas
                while tokens[at] != ";":
                    if tokens[at] in "([{":
                        at = group(tokens, at, tokens[at], {"(": ")", "[": "]", "{": "}"}[tokens[at]])
                    elif tokens[at] == "," and tokens[at + 2] in (",", ";", "=", "["):
                        at += 1
                        yield tokens[at]
                    else:
                        at += 1


def names_of(path):
    """The names that a file declares outside functions, macros included."""
    code = words(path.read_text(encoding="utf-8"))
    for macro, parameters, body in re.findall(r"^ *# *define (\w+)(\([^)]*\))?(.*)$", code, re.MULTILINE):
        yield macro
        tokens = TOKEN.findall(body)
        pasted = (a for a, b in zip(tokens, tokens[1:]) if b == "##")
        yield from (p for p in pasted if p not in re.findall(r"\w+", parameters))
    yield from declared(TOKEN.findall(re.sub(r"^ *#.*$", "", code, flags=re.MULTILINE)))


def members_of(path, struct):
    body = re.search(rf"struct {struct} {{(.*?)}};", words(path.read_text(encoding="utf-8")), re.DOTALL)
    return re.findall(r"(\w+)\s*[;,]", body[1])


with tempfile.TemporaryDirectory() as folder:
    copies = pathlib.Path(folder)
    subprocess.run(["cmake", f"-DDESTINATION={copies}", "-P", root / "shaders/host_shaders.cmake"], check=True)
    files = [p for p in sorted(copies.rglob("*")) if p.is_file()]
    count = 0
    for file in files:
        for name in names_of(file):
            count += 1
            if not PREFIXED.match(name) and name not in GIVEN:
                failures.append(f"{file.relative_to(copies)}: {name} has no prefix for hosts; "
                                "shaders/host_shaders.cmake does not see its declaration")
    # Hosts read and write members, whose names must stay.
    for name, struct in {"lib/surface.glsl": "Surface", "lib/shadow_query.glsl": "ShadowQuery",
                         "lib/visibility_query.glsl": "VisibilityQuery",
                         "shading/forward_lights.glsl": "LightCursor"}.items():
        ours, theirs = members_of(root / "shaders" / name, struct), members_of(copies / name, "Cnd" + struct)
        if ours != theirs:
            failures.append(f"{name}: the members {ours} of {struct} are {theirs} for hosts; a name that is "
                            "declared outside functions must not be the name of such a member")
    if len(files) < 50 or count < 600:
        failures.append(f"only {len(files)} files with {count} names were found")

print("\n".join(failures) or f"{count} names in {len(files)} files have their prefix")
sys.exit(1 if failures else 0)
