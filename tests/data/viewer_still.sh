# SPDX-License-Identifier: Apache-2.0
# Shows scenes in `candelabra view` ($PROGRAM) that stand still, and moves in one, in an empty folder that has
# the scene wide.json (tests/gpu/test_viewer.cpp). `candelabra render` makes the pictures to compare with.
device=${CANDELABRA_TEST_DEVICE:+--device "$CANDELABRA_TEST_DEVICE"}
size="--size 200x150 --shadows off"
set -e

"$PROGRAM" render wide.json --aa 16 $size -o wide.png $device
for frames in 2 24; do
    "$PROGRAM" view wide.json $size --no-overlay --verbose --validate $device \
        --frames $frames --screenshot $frames.png 2>$frames.txt
done
"$PROGRAM" view hall --lights 40 --moving $size --frames 20 --verbose --validate $device 2>lights.txt

set +e
. "$(dirname "$0")/viewer_log.sh"
log=session.txt
"$PROGRAM" view wide.json $size --no-overlay --while-moving half --verbose --validate $device \
    2>$log &
viewer=$!
logged "^picture: complete"
window=$(timeout 120 xdotool search --sync --onlyvisible --name '^candelabra$' | head -n 1)
xdotool windowfocus --sync $window
xdotool click --repeat 25 5 # the camera becomes so slow that it stays in the hall while frames take a second
xdotool keydown w
logged "^picture: 100x75 pixels"
xdotool key p
logged "^wrote candelabra-001.png"
xdotool mousemove --window $window 100 120 key k
logged "^pixel 100,120"
xdotool keyup w
logged "^picture: complete" 2
xdotool key p
logged "^wrote candelabra-002.png"
xdotool key x
logged "^wrote candelabra-003.exr"
camera=$(grep -o -- "^--camera .*" $log | tail -n 1)
# Only the panel is drawn.
xdotool key F1
logged "^the panel is shown"
xdotool mousemove --window $window 30 15 mousemove --window $window 40 12 mousemove --window $window 100 100
xdotool key F1
logged "^the panel is hidden"
xdotool key Escape
wait $viewer || exit
"$PROGRAM" render wide.json --aa 16 $size $camera -o moved.png -o moved.exr $device
