# SPDX-License-Identifier: Apache-2.0
# Drives `candelabra view` ($PROGRAM) with keys and mouse, in an empty folder (tests/gpu/test_viewer.cpp).
# It waits for every image that it saves: once the image exists, all earlier keys have been processed.
. "$(dirname "$0")/viewer_log.sh"
log=err.txt
shot=0
save() { # [key extension]
    shot=$((shot + 1))
    xdotool key ${1:-p}
    for i in $(seq 600); do
        [ -f "$(printf "candelabra-%03d.${2:-png}" $shot)" ] && return
        kill -0 $viewer 2>/dev/null || fail "the viewer ended before file $shot"
        sleep 0.1
    done
    fail "file $shot never came"
}
# Waits until the picture is complete after the last line of the log that matches a text, which tells of a
# change. Pictures that are compared must have their samples summed, or must all be without.
complete() { # text
    logged "$1"
    for i in $(seq 1200); do
        sed -n "/$1/h; /$1/!H; \${x; p}" $log | grep -q "^picture: complete" && return
        kill -0 $viewer 2>/dev/null || fail "the viewer ended before the picture was complete: $1"
        sleep 0.1
    done
    fail "the picture was never complete after: $1"
}
"$PROGRAM" view rooms --lights 40 --size 320x200 --exposure 4 --shadows off --validate --no-overlay --verbose \
    ${CANDELABRA_TEST_DEVICE:+--device "$CANDELABRA_TEST_DEVICE"} &
viewer=$!
logged "F2 lists keys" # the scene is there
window=$(timeout 120 xdotool search --sync --onlyvisible --name '^candelabra$' | head -n 1)
xdotool windowfocus --sync $window
complete "F2 lists keys"
save # 1
xdotool mousemove --window $window 120 185 click 1
logged " selected, of material "
xdotool key n
logged "^light 40 added"
# By its handle y, upwards.
xdotool mousemove --window $window 120 145 mousedown 1 mousemove --window $window 120 105 mouseup 1
logged "^light 40 moved"
xdotool key period period period Up
logged "^light 40 moved" 2
complete "^light 40 moved"
save # 2: a light in front of the camera
xdotool key Delete
complete "^light 40 removed"
save # 3: the light removed again
xdotool keydown w
sleep 0.5
xdotool keyup w
save # 4: after moving the camera
xdotool key o mousemove 200 100 mousedown 1 mousemove 230 110 mouseup 1 key o
xdotool key c
complete "^light culling: brute"
save # 5: brute force
xdotool key c h h h h h F1 F2
complete "^heat map: none"
save # 6: through all heat maps, panel and help
xdotool key b bracketright
logged "^rooms: 80 lights" # the other scene has taken the place of the first
save # 7: comparison wipe, twice the lights
for i in $(seq 20); do
    xdotool windowsize $window $((200 + i * 13 % 170)) $((150 + i * 29 % 110))
done
xdotool windowsize --sync $window 260 180
save # 8
xdotool key F1 F2 b mousemove --window $window 130 150
save # 9: without the panel, which would take mouse clicks over it
xdotool key k
save F5 json # 10: prints the lights of the pixel, then saves the scene
xdotool key F1
save # 11: the panel shows the pixel and the metering
xdotool key Escape
wait $viewer
