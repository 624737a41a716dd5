#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Doxygen's input filter: turns the plain // comments of the headers into documentation comments.

A trailing comment, with the lines that continue it, documents the declaration before it. Any other
comment documents the declaration that follows, and the first comment of a file documents the file. Pages (.md)
and their headings get labels, to which the links of pages are changed: Doxygen does not find a page by a path with
a space, nor a heading by the anchor that GitHub gives it."""
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


def headings(lines):
    """Yields the index of every heading outside listings, and the anchor that GitHub gives it."""
    taken = set()
    listing = False
    for index, line in enumerate(lines):
        listing = listing != line.startswith("```")
        heading = re.match(r"#{1,6} (.*)", line)
        if not heading or listing:
            continue
        text = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading[1]).replace("`", "").strip().lower()
        slug = re.sub(r"[^\w\- ]", "", text).replace(" ", "-")
        anchor, number = slug, 0
        while anchor in taken:
            number += 1
            anchor = f"{slug}-{number}"
        taken.add(anchor)
        yield index, anchor


def label(page, anchor):
    """The label of the page if the anchor is empty, else that of the heading with the anchor."""
    return f"{page}_{anchor}" if anchor else f"page_{page}"


def linked(line, name):
    """Changes the links of a line of the page to pages beside it and to headings, but not in inline code."""
    parts = re.split(r"(`[^`]*`)", line)
    parts[::2] = [re.sub(r"\]\((?:(\w+)\.md)?(?:#([\w-]+))?\)",
                         lambda link: f"](@ref {label(link[1] or name, link[2])})" if link[1] or link[2] else link[0],
                         part) for part in parts[::2]]
    return "".join(parts)


def labelled(lines, name):
    """Yields the lines of the page with labels and links. The first heading labels the page, so that other pages
    link to it without an anchor."""
    labels = {index: label(name, anchor if number else "")
              for number, (index, anchor) in enumerate(headings(lines))}
    listing = False
    for index, line in enumerate(lines):
        listing = listing != line.startswith("```")
        line = line if listing else linked(line, name)
        yield f"{line} {{#{labels[index]}}}" if index in labels else line


if __name__ == "__main__":
    path = pathlib.Path(sys.argv[1])
    lines = path.read_text(encoding="utf-8").splitlines()
    print("\n".join(labelled(lines, path.stem) if path.suffix == ".md" else documented(lines)))
