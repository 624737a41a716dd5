#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Checks the documents: links and anchors resolve, figures are the measured ones, tests build the listings,
decisions have their four parts, the names that documents cite exist, and DESIGN.md has all kernels and
folders.
Usage: test_documents.py REPOSITORY"""
import fnmatch
import itertools
import pathlib
import re
import subprocess
import sys
import textwrap

sys.dont_write_bytecode = True  # the source may be read-only
import test_includes

root = pathlib.Path(sys.argv[1]).resolve()
failures = []


def fail(path, why):
    failures.append(f"{path.relative_to(root)}: {why}")


def files(pattern):
    """Returns the files of the repository with names that match, without build folders and .git."""
    return [p for p in sorted(root.rglob(pattern))
            if p.relative_to(root).parts[0] not in ("build", "out", ".git") and p.is_file()]


README, DECISIONS = root / "README.md", root / "engine/DECISIONS.md"
RESULTS, DESIGN = root / "tools/bench/RESULTS.md", root / "engine/DESIGN.md"
DOCUMENTS = files("*.md")
SOURCES = [p for p in files("*") if p.suffix in (".c", ".comp", ".cpp", ".frag", ".glsl", ".h", ".hpp", ".py", ".vert")]


def without_code(text):
    """Returns the text without fenced listings and inline code, where brackets are not links."""
    return re.sub(r"`[^`\n]*`", "code", re.sub(r"^```.*?^```$", "", text, flags=re.DOTALL | re.MULTILINE))


def anchors(path):
    """Returns the anchors that GitHub gives to the headings of a document."""
    taken = set()
    text = re.sub(r"^```.*?^```$", "", path.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE)
    for heading in re.findall(r"^#{1,6} (.*)", text, re.MULTILINE):
        words = re.sub(r"\[([^\]]*)\]\([^)]*\)", r"\1", heading).replace("`", "").strip().lower()
        slug = re.sub(r"[^\w\- ]", "", words).replace(" ", "-")
        numbered = (f"{slug}-{number}" for number in itertools.count(1))
        taken.add(slug if slug not in taken else next(name for name in numbered if name not in taken))
    return taken


def check_link(document, target):
    if re.match(r"[a-z]+:", target):  # a link to the web, which only a network could check
        return
    place, _, anchor = target.partition("#")
    path = (document.parent / place).resolve() if place else document
    if not path.exists() or root not in [path, *path.parents]:
        fail(document, f"links to {target}, which does not exist")
    elif anchor and (path.suffix != ".md" or anchor not in anchors(path)):
        fail(document, f"links to {target}, but {path.name} has no such heading")


for document in DOCUMENTS:
    text = without_code(document.read_text(encoding="utf-8"))
    for target in re.findall(r"\]\(\s*([^)\s]+)[^)]*\)", text) + re.findall(r"^\[[^\]]+\]:\s*(\S+)", text, re.MULTILINE):
        check_link(document, target)

# The front page stays short.
MAX_README_LINES, MAX_LISTING_LINES = 160, 20
lines = README.read_text().count("\n")
if lines > MAX_README_LINES:
    fail(README, f"has {lines} lines, at most {MAX_README_LINES}")

# The listing in README.md is part of a sample that the package tests build and run.
sample = root / "samples/embed_minimal/main.cpp"
parts = sample.read_text().split("// [readme]\n")
if len(parts) != 3 or f"```cpp\n{textwrap.dedent(parts[1]).rstrip()}\n```" not in README.read_text():
    fail(README, f"does not hold the listing of {sample.relative_to(root)}")
elif parts[1].count("\n") > MAX_LISTING_LINES:
    fail(sample, f"its listing has {parts[1].count(chr(10))} lines, at most {MAX_LISTING_LINES}")

# SCENE_JSON.md has a row for every key of a scene description and for no other, and a row for every type of light.
SCENES, PROGRAM = root / "tools/SCENE_JSON.md", root / "tools/candelabra"
page = SCENES.read_text(encoding="utf-8")
loader = "".join(p.read_text(encoding="utf-8") for p in sorted((PROGRAM / "json").glob("scene_json*.cpp")))
lists = re.findall(r"(?:refuseOtherKeys\(|known)\{(.*?)\}|known\.push_back\((.*?)\)", loader, re.DOTALL)
keys = set(re.findall(r'"(\w+)"', str(lists)))
kinds = (PROGRAM / "scene/light_types.cpp").read_text(encoding="utf-8")
named = dict(re.findall(r"std::string> (\w+) = \{([^}]*)\}", kinds))
for kind in kinds.split('.name = "')[1:]:
    emission = re.search(r"\.emission = (\w+|\{[^}]*\})", kind)[1]
    own = set(re.findall(r'\{"(\w+)", ', kind) + re.findall(r'"(\w+)"', named.get(emission, emission)))
    keys |= own
    name = kind.split('"')[0]
    row = re.search(rf'^\| `"{name}"` \|(.*)$', page, re.MULTILINE)
    if not row or set(re.findall(r"`(\w+)`", row[1])) != own:
        fail(SCENES, f"does not say that the keys of a light of type {name} are {', '.join(sorted(own))}")
rows = set(re.findall(r"`(\w+)`", " ".join(re.findall(r"^\| (`\w+`.*?) \|", page, re.MULTILINE))))
if rows != keys:
    fail(SCENES, f"its rows and the loader's keys differ by {', '.join(sorted(rows ^ keys))}")

# The figures in the documents are the measured ones.
check = subprocess.run([sys.executable, root / "tools/update_results", "--check"],
                       capture_output=True, text=True)
if check.returncode:
    failures.append((check.stdout + check.stderr).strip())

# Decisions: an index of all of them, numbered without gaps, and four parts in at most 15 lines each.
PARTS = ["Question.", "Choice.", "Evidence.", "Reopen when"]
MAX_ENTRY_LINES, MAX_ENTRY_COLUMNS = 15, 120
head, *entries = re.split(r"^## ", DECISIONS.read_text(encoding="utf-8"), flags=re.MULTILINE)
titles = [entry.split("\n", 1)[0] for entry in entries]
for number, (title, entry) in enumerate(zip(titles, entries), 1):
    if not title.startswith(f"{number}. "):
        fail(DECISIONS, f'"{title}" should have the number {number}')
    if f"- [{title}](#" not in head:
        fail(DECISIONS, f'"{title}" is not in the index')
    body = entry.rstrip().split("\n")[1:]
    if re.findall(r"^- \*\*([^*]+)\*\*", entry, re.MULTILINE) != PARTS:
        fail(DECISIONS, f'"{title}" does not have the parts {", ".join(PARTS)}, in this order')
    if len(body) > MAX_ENTRY_LINES:
        fail(DECISIONS, f'"{title}" has {len(body)} lines, at most {MAX_ENTRY_LINES}')
    for line in body:
        if len(line) > MAX_ENTRY_COLUMNS:
            fail(DECISIONS, f'"{title}" has a line of {len(line)} columns, at most {MAX_ENTRY_COLUMNS}')
if len(re.findall(r"^- \[", head, re.MULTILINE)) != len(entries):
    fail(DECISIONS, "its index has a line too many")

# Decisions that sources and documents cite by number exist.
for path in SOURCES + DOCUMENTS:
    for number in re.findall(r"DECISIONS(?:\.md)?`?,? (\d+)", path.read_text(encoding="utf-8")):
        if not 1 <= int(number) <= len(entries):
            fail(path, f"cites decision {number}, which does not exist")

# Source files, functions and tests that these documents name exist.
source_names = {p.relative_to(root).as_posix() for p in SOURCES}
source_texts = [p.read_text(encoding="utf-8") for p in SOURCES]
tests = {f"{suite}.{name}" for path in files("test_*.cpp")
         for suite, name in re.findall(r"^TEST(?:_F|_P)?\((\w+),\s*(\w+)\)", path.read_text(), re.MULTILINE)}
for document in (DECISIONS, DESIGN, RESULTS):
    text = document.read_text(encoding="utf-8")
    for name in re.findall(r"`([\w/.]+\.(?:c|comp|cpp|frag|glsl|h|hpp|py|vert))`", text):
        if not any(("/" + s).endswith("/" + name.replace("../", "")) for s in source_names):
            fail(document, f"names {name}, which does not exist")
    for name in re.findall(r"`([A-Z]\w+\.\w+)`", text):
        if name not in tests and not re.search(r"\.(md|txt)$", name):
            fail(document, f"names the test {name}, which does not exist")
    for name in re.findall(r"`(?:\w+::)*(\w+)\(\)`", text):
        if not any(re.search(rf"\b{name}\(", source) for source in source_texts):
            fail(document, f"names the function {name}, which does not exist")
    for pattern in re.findall(r"--gtest_filter=([\w.*]+)", text):
        if not fnmatch.filter(tests, pattern):
            fail(document, f"runs {pattern}, which no test is named like")

# DESIGN.md names every kernel. Its table has a row for every folder of the engine and of the shaders. The folders
# in the last column, and those that these may include in turn, are the ones that test_includes.py allows. Public
# headers and headers that the build generates are not compared.
design = DESIGN.read_text(encoding="utf-8")
for kernel in sorted((root / "shaders").glob("kernels/*.comp")) + sorted((root / "shaders").glob("gbuffer/*.comp")):
    if not re.search(rf"\b{kernel.stem}\b", design):
        fail(DESIGN, f"does not name the kernel {kernel.stem}")


def design_path(name):
    """Returns the path from the root of the repository to a file or folder that DESIGN.md names relative to itself."""
    return (DESIGN.parent / name).resolve().relative_to(root).as_posix()


def includable(folder, folders):
    """Returns the folders that a folder, or the folders that it may include, may include."""
    direct = set(folders.get(folder, []))
    return direct.union(*(includable(other, folders) for other in direct))


def check_folders(folders):
    """Compares the table of DESIGN.md, lists of folders by folder, with FOLDERS of test_includes.py."""
    for folder, allowed in test_includes.FOLDERS:
        if "." in folder or not folder.startswith(("engine/", "shaders/")):
            continue
        expected = {other for other in allowed
                    if not other.startswith((test_includes.PUBLIC, "candelabra_", "shaders/lib/forward.glsl"))}
        if folder not in folders:
            fail(DESIGN, f"has no row for {folder}")
        elif includable(folder, folders) != expected:
            fail(DESIGN, f"says that {folder} may include {', '.join(sorted(includable(folder, folders))) or 'nothing'}, "
                         f"but it may include {', '.join(sorted(expected)) or 'nothing'}")
    for folder in folders.keys() - dict(test_includes.FOLDERS).keys():
        fail(DESIGN, f"has a row for {folder}, which test_includes.py does not list")


check_folders({design_path(folder): [design_path(name) for name in re.findall(r"`([^`]+)`", last)]
               for folder, last in re.findall(r"^\| `([^`]+)` \|[^|]*\|([^|]*)\|$", design, re.MULTILINE)})

# Every name of the API that these documents cite is in the public headers, or without its prefix in the
# GLSL of which hosts get copies with prefixes (shaders/host_shaders.cmake).
headers = "".join(p.read_text() for p in (root / "engine/include/candelabra").iterdir())
glsl = "".join(p.read_text() for folder in ("lib", "shared", "shading", "kernels/common")
               for p in sorted((root / "shaders" / folder).rglob("*")) if p.is_file())


def without_prefix(word):
    """CndSurface -> Surface, cndLitSurface -> litSurface, CND_LIGHT_SPHERE -> LIGHT_SPHERE"""
    rest = word[4:] if word.startswith("CND_") else word[3:]
    return rest[0].lower() + rest[1:] if word.startswith("cnd") and rest else rest


for guide in (README, DESIGN, *(root / "engine" / name for name in ("CHANGELOG.md", "CONCEPTS.md", "DEFERRED.md", "INTEGRATION.md",
                                                          "LIGHTING_MODEL.md", "UPDATE.md"))):
    text = guide.read_text()
    fields = re.findall(r"[{,]\s*\.(\w+) =", "".join(re.findall(r"```cpp\n(.*?)```", text, re.DOTALL)))
    for word in sorted(set(re.findall(r"\b(?:Cnd|cnd|CND_)\w+", text) + fields)):
        own = re.match(r"cnd|Cnd|CND_", word) and without_prefix(word)
        if not re.search(rf"\b{word}\b", headers) and not (own and re.search(rf"\b{own}\b", glsl)):
            fail(guide, f"names {word}, which is neither in the headers nor in the GLSL for hosts")

print("\n".join(failures) or f"{len(DOCUMENTS)} documents keep the rules")
sys.exit(1 if failures else 0)
