# SPDX-License-Identifier: Apache-2.0
# Functions for scripts that drive the viewer. They set `viewer` to its process, and `log` to the file of what it
# prints on stderr.
fail() {
    echo "$1" >&2
    kill $viewer
    exit 99
}
# Waits until the viewer has written a text to its log for the COUNTth time.
logged() { # text [count]
    for i in $(seq 1200); do
        [ "$(grep -c -- "$1" $log)" -ge "${2:-1}" ] && return
        kill -0 $viewer 2>/dev/null || fail "the viewer ended before it wrote: $1"
        sleep 0.1
    done
    fail "the viewer never wrote: $1"
}
