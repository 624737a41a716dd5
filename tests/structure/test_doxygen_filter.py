#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""What Doxygen's input filter makes of pages and headers. Usage: test_doxygen_filter.py REPOSITORY"""
import pathlib
import subprocess
import sys
import tempfile

root = pathlib.Path(sys.argv[1]).resolve()
failures = []


def require_filtered(name, given, expected):
    """Compares what the filter makes of a file with such a name and content."""
    with tempfile.TemporaryDirectory() as folder:
        path = pathlib.Path(folder) / name
        path.write_text(given, encoding="utf-8")
        out = subprocess.run([sys.executable, root / "engine/package/doxygen_filter.py", path],
                             capture_output=True, text=True, check=True).stdout
    for number, (line, wanted) in enumerate(zip(out.split("\n"), expected.split("\n"), strict=True), 1):
        if line != wanted:
            failures.append(f"line {number} of {name} becomes\n  {line}\nand not\n  {wanted}")


# Every heading has a label, the first of them that of the page. What listings and inline code hold stays as it is,
# also before the first heading.
require_filtered("GUIDE.md", """\
```sh
# no heading, and [no link](OTHER.md)
```
# A guide
See [the rest](OTHER.md), [a part of it](OTHER.md#2-some-part), [what follows](#say-it-twice), and
`[no link](OTHER.md)` but [one](OTHER.md) beside it; [the web](https://example.com/a.md#b) stays, and
[a folder](../OTHER.md) does too.
## Say `it`, twice!
### Say it twice
```cpp
#include <a.h> // [no link](#say-it-twice)
# no heading
```
###### The [last](OTHER.md) one
""", """\
```sh
# no heading, and [no link](OTHER.md)
```
# A guide {#page_GUIDE}
See [the rest](@ref page_OTHER), [a part of it](@ref OTHER_2-some-part), [what follows](@ref GUIDE_say-it-twice), and
`[no link](OTHER.md)` but [one](@ref page_OTHER) beside it; [the web](https://example.com/a.md#b) stays, and
[a folder](../OTHER.md) does too.
## Say `it`, twice! {#GUIDE_say-it-twice}
### Say it twice {#GUIDE_say-it-twice-1}
```cpp
#include <a.h> // [no link](#say-it-twice)
# no heading
```
###### The [last](@ref page_OTHER) one {#GUIDE_the-last-one}
""")

require_filtered("a.h", """\
// SPDX-License-Identifier: Apache-2.0
// A header.
#pragma once // stays

// A structure.
struct A {
    int b; // a number,
           // of which there is one
    // Another one.
    int c;
};
""", """\
/// @file
/// A header.
#pragma once // stays

/// A structure.
struct A {
    int b; ///< a number,
           ///< of which there is one
    /// Another one.
    int c;
};
""")

print("\n".join(failures) or "the filter does what Doxygen needs")
sys.exit(1 if failures else 0)
