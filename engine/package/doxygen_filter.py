#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Doxygen's input filter: turns the plain // comments of the headers into documentation comments.

A trailing comment, with the lines that continue it, documents the declaration before it. Any other
comment documents the declaration that follows, and the first comment of a file documents the file. Pages (.md)
get labels, to which their links to each other are changed: Doxygen does not find a page by a path with a space."""
import pathlib
import re
import sys


def documented(lines):
    behind = None  # column of a trailing comment that the next line may continue
    head = True    # inside the comment that opens the file
    for line in lines:
        alone = re.match(r"( *)//( ?)(.*)", line)
        after = re.match(r"(.*\S.*?)//( .*)", line)
        if head and alone:
            text = alone.group(3)
            yield "/// @file" if text.startswith("SPDX") else "/// " + text
            continue
        head = False
        if alone and behind is not None and len(alone.group(1)) >= behind:
            yield alone.group(1) + "///<" + alone.group(2) + alone.group(3)
        elif alone:
            behind = None
            yield alone.group(1) + "///" + alone.group(2) + alone.group(3)
        elif after and not after.group(1).startswith("#"):
            behind = len(after.group(1))
            yield after.group(1) + "///<" + after.group(2)
        else:
            behind = None
            yield line


def labelled(page, name):
    page = re.sub(r"^(# .*)", rf"\1 {{#page_{name}}}", page, count=1)
    return re.sub(r"\]\((\w+)\.md\)", r"](@ref page_\1)", page)


path = pathlib.Path(sys.argv[1])
text = path.read_text(encoding="utf-8")
print(labelled(text, path.stem) if path.suffix == ".md" else "\n".join(documented(text.splitlines())))
