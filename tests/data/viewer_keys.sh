# SPDX-License-Identifier: Apache-2.0
# Presses random keys in `candelabra view` ($PROGRAM), then every key of its help, in an empty folder that has
# two files (tests/gpu/test_viewer.cpp):
#   inputs.txt  xdotool commands, one a line
#   checks.txt  how often to try, a tabulator, xdotool commands, a tabulator, a regular expression for a line
#               that the viewer then prints
# It fails at the first line of checks.txt for which no such line is printed. Lines about the picture itself
# ("picture: ") come at any time and do not count.
. "$(dirname "$0")/viewer_log.sh"
log=log.txt
lines() { grep -vc '^picture: ' $log; }
# Tells whether a line after line $1 of the log matches $2.
said() {
    awk -v after=$1 -v wanted="$2" '!/^picture: / && ++n > after && $0 ~ wanted { found = 1 }
        END { exit !found }' $log
}
# Waits until one does.
await() {
    for i in $(seq 6000); do
        said $1 "$2" && return 0
        kill -0 $viewer 2>/dev/null || return 1
        sleep 0.05
    done
    return 1
}
"$PROGRAM" view rooms --lights 40 --size 240x160 --exposure 4 --samples 1 --shadows off --verbose --validate \
    ${CANDELABRA_TEST_DEVICE:+--device "$CANDELABRA_TEST_DEVICE"} 2>>$log &
viewer=$!
window=$(timeout 120 xdotool search --sync --onlyvisible --name '^candelabra$' | head -n 1)
xdotool windowfocus --sync $window
xdotool - <inputs.txt
xdotool key p # once the image exists, everything before it has been processed
await 0 '^wrote candelabra-[0-9]*[.]png' || fail "after random keys, P does not save the image"
# A key that is held while the window loses the keyboard does not stay pressed.
before=$(lines)
xdotool keydown w sleep 0.3 windowunmap --sync $window keyup w windowmap --sync $window \
    windowfocus --sync $window
await $before '^--camera ' || fail "the camera does not stop after W was released in no window"
echo "the checks begin" >>$log
while IFS=$'\t' read -r tries commands expected; do
    while :; do
        before=$(lines)
        xdotool $commands
        tries=$((tries - 1))
        # Only the last try waits for the expected line; others wait for any line.
        if [ $tries -gt 0 ]; then
            await $before . || fail "$commands: prints nothing"
            said $before "$expected" && break
        else
            await $before "$expected" && break
            fail "$commands: has no effect, expected: $expected"
        fi
    done
done <checks.txt
wait $viewer
