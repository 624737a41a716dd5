#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""No function of C, C++ or GLSL is longer than the limit of its folder. Usage: test_functions.py REPOSITORY"""
import pathlib
import re
import sys

# By folder, from the first line of a function's head to its closing brace.
MAX_LINES = {"engine": 60, "samples": 80, "shaders": 60, "tests": 80, "tools": 80}

SUFFIXES = {".c", ".comp", ".cpp", ".frag", ".glsl", ".h", ".hpp", ".vert"}

# Text in which braces are not counted: comments, preprocessor lines, raw strings, strings, numbers with
# digit separators (whose quotes are not character literals) and characters.
SKIPPED = re.compile(r"""//[^\n]*|/\*.*?\*/|^[ \t]*\#(?:[^\n\\]|\\.)*|R"(\w*)\(.*?\)\1"|"(?:[^"\\\n]|\\.)*"
                         |\b\d[\w']*|'(?:[^'\\\n]|\\.)*'""", re.DOTALL | re.MULTILINE | re.VERBOSE)
# Heads of blocks that contain functions. A head with a parenthesis belongs to a function, which may
# return a struct.
SCOPE = re.compile(r"^(?:inline |typedef |template\s*<.*?>\s*)*"
                   r"(?:namespace|class|struct|union|enum|extern)\b(?!.*\))|^layout\b", re.DOTALL)
# Text before the brace of an initialiser. The formatter puts a space before the brace of a block.
INITIALISED = re.compile(r"[\w>\]]\Z|[=(,]\s*\Z")


def functions(text):
    """Yields first line, number of lines and head of every function that is not inside another."""
    code = SKIPPED.sub(lambda m: re.sub(r"[^\n]", " ", m[0]), text)
    head_from, start = 0, None
    blocks = []  # the kinds of the blocks that are open
    for token in re.finditer(r"[{};]", code):
        outside = all(block == "scope" for block in blocks)
        if token[0] == "{":
            head = code[head_from:token.start()]
            stripped = re.sub(r"^(?:\s*(?:public|private|protected):)*\s*", "", head)
            if INITIALISED.search(head):
                blocks.append("initialiser")
                continue
            blocks.append("scope" if outside and SCOPE.match(stripped) else "body")
            if outside and blocks[-1] == "body":
                start = token.start() - len(stripped)
        elif token[0] == "}":
            if not blocks:
                raise ValueError("a brace closes what none has opened")
            closed = blocks.pop()
            if closed == "initialiser":
                continue
            if closed == "body" and all(block == "scope" for block in blocks):
                first = code.count("\n", 0, start) + 1
                head = " ".join(code[start:code.index("{", start)].split())
                yield first, code.count("\n", 0, token.end()) + 2 - first, head
        if all(block == "scope" for block in blocks):
            head_from = token.end()
    if blocks:
        raise ValueError(f"{len(blocks)} braces stay open")


def faults(path, text):
    most = MAX_LINES[path.split("/")[0]]
    try:
        for line, length, head in functions(text):
            if length > most:
                yield f"{path}:{line}: {length} lines, at most {most}: {head}"
    except ValueError as error:
        yield f"{path}: {error}"


def test_the_test():
    """Finds a function that is one line too long, and none that is as long as it may be."""
    def body(lines):
        return "{\n" + "    x('{', \"}\", 1'000); // {\n" * (lines - 3) + "}\n"

    def lengths(text):
        return [length for _, length, _ in functions(text)]

    assert lengths("int f(int a)\n" + body(80)) == [80]
    assert lengths("namespace a\n{\nclass B\n{\npublic:\n    B() : x{1}, y(2)\n    " + body(81) + "};\n}\n") == [81]
    assert lengths("template <typename T>\nvoid f()\n" + body(30) + "struct A g()\n" + body(20)) == [31, 20]
    assert lengths("typedef struct A {\n    int b;\n} A;\nint f()\n" + body(20)) == [20]
    assert lengths("const Entry list[] = {f({1, 2}),\n{3, 4}};\nvoid h()\n{\n    [&] {\n    }();\n}\n") == [5]
    assert lengths("#define F(x) {\nauto text = R\"({{{)\";\nvoid k() const\n{\n}\n") == [3]
    assert list(faults("tools/a.cpp", "int f(int a)\n" + body(80))) == []
    assert list(faults("tools/a.cpp", "int f(int a)\n" + body(81))) == \
        ["tools/a.cpp:1: 81 lines, at most 80: int f(int a)"]
    assert list(faults("engine/a.cpp", "int f(int a)\n" + body(61))) == \
        ["engine/a.cpp:1: 61 lines, at most 60: int f(int a)"]
    assert list(faults("tools/a.cpp", "int f()\n{\n")) == ["tools/a.cpp: 1 braces stay open"]


def main():
    test_the_test()
    root = pathlib.Path(sys.argv[1]).resolve()
    failures, count = [], 0
    for folder in MAX_LINES:
        for path in sorted((root / folder).rglob("*")):
            if path.suffix in SUFFIXES:
                text = path.read_text(encoding="utf-8")
                failures += faults(path.relative_to(root).as_posix(), text)
                count += 1
    print("\n".join(failures) or f"no function of {count} files is too long")
    return 1 if failures else 0


sys.exit(main())
