# SPDX-License-Identifier: Apache-2.0
# Runs `candelabra view` ($PROGRAM) in an empty folder, with scenes that cannot be loaded, and closed before
# its scene is there (tests/gpu/test_viewer_loading.cpp). Prints a line for each run.
device=${CANDELABRA_TEST_DEVICE:+--device "$CANDELABRA_TEST_DEVICE"}
view() { "$PROGRAM" view "$@" --size 320x200 --validate $device; }
windowed() { timeout 120 xdotool search --sync --onlyvisible --name '^candelabra$' | head -n 1; }

for i in 1 2; do
    view hall --lights 40 --no-overlay --frames 3 --screenshot $i.png 2>>err.txt
    echo "picture $i: $?"
done
view missing.glb --frames 3 2>>err.txt
echo "missing, with a number of frames: $?"

"$PROGRAM" view missing.glb --size 320x200 --validate $device 2>missing.txt &
viewer=$!
xdotool windowfocus --sync $(windowed)
until [ "$closed" ]; do # the window stays, with the message, until a key closes it
    xdotool key Escape
    kill -0 $viewer 2>/dev/null || closed=yes
done
wait $viewer
echo "missing, until closed: $?"

"$PROGRAM" view hall --lights 1000000 --size 320x200 --validate $device 2>closed.txt &
viewer=$!
xdotool windowfocus --sync $(windowed) key Escape
wait $viewer
echo "closed while loading: $?"
