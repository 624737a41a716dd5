#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No comment begins with "Of", "Those", "That of" or "As of": such a comment leaves out what it is
about. Usage: test_comments.py REPOSITORY"""
import pathlib
import re
import sys

root = pathlib.Path(sys.argv[1]).resolve()

BEGINNING = re.compile(r"(Of|Those|That of|As of)\b")
SLASHES = {".c", ".comp", ".cpp", ".frag", ".glsl", ".h", ".hpp", ".inc", ".vert"}
HASHES = {".cmake", ".py", ".sh", ".txt", ".yml"}


def sources():
    for path in sorted(root.rglob("*")):
        parts = path.relative_to(root).parts
        if parts[0] in ("build", "out", ".git") or not path.is_file():
            continue
        if path.suffix in SLASHES:
            yield path, "//"
        elif path.suffix in HASHES or path.suffix == "" and path.read_bytes()[:2] == b"#!":
            yield path, "#"


def beginnings(path, mark):
    """Yields the line number and the text of the first line of every comment. A line that has only a
    comment, in the same column as the comment of the line before, continues that comment."""
    previous = -1  # column of the comment on the line before
    for number, line in enumerate(path.read_text(encoding="utf-8").split("\n"), 1):
        comment = re.search(rf"(?<![:\"'\w/]){mark}+!?<? ?(.*)", line)
        column = comment.start() if comment else -1
        if comment and (line[:column].strip() or column != previous):
            yield number, comment[1]
        previous = column


found = [(path.relative_to(root).as_posix(), number, text) for path, mark in sources()
         for number, text in beginnings(path, mark) if BEGINNING.match(text)]
for name, number, text in found:
    print(f'{name}:{number}: the comment begins with "{BEGINNING.match(text)[1]}": {text}')
print(f"{len(found)} comments begin with one of these words")
sys.exit(1 if found else 0)
