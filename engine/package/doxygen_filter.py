#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Doxygen's input filter: the headers' comments, which are plain //, as documentation.

A comment behind a declaration is about what stands before it, and so are the lines that go on with it;
any other is about what follows, the first of a file about the file."""
import re
import sys


def documented(lines):
    behind = None  # column of the comment behind a declaration that may go on
    head = True    # in the comment that opens the file
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


with open(sys.argv[1], encoding="utf-8") as header:
    if sys.argv[1].endswith(".md"):
        sys.stdout.write(header.read())
    else:
        print("\n".join(documented(header.read().splitlines())))
