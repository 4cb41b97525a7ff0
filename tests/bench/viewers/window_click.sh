#!/usr/bin/env bash
# The window clicked through on a virtual display of 96 and 192 dpi, a picture after every click.
#
#   window_click.sh BUILD OUT
#
# BUILD holds bin/viewer_test; pictures go to OUT/96 and OUT/192, where a person looks at them. Exit
# code 0: every control was clicked, and nothing was said to have gone wrong. Needs xvfb, x11-utils
# (xprop); takes some minutes a display.
set -euo pipefail
build=$1 out=$2
here=$(cd "$(dirname "$0")/../../.." && pwd)

for dpi in 96 192; do
    mkdir -p "$out/$dpi"
    export SURFELAO_PICTURES=$out/$dpi SURFELAO_DATA=$here/data dpi build
    # the window system tells the scale as desktops do: by a resource of the root window
    xvfb-run -a -s "-screen 0 1600x2100x24 -noreset" bash -c '
        xprop -root -f RESOURCE_MANAGER 8s -set RESOURCE_MANAGER "Xft.dpi: $dpi"
        "$build/bin/viewer_test" --gtest_also_run_disabled_tests \
            --gtest_filter=Window.DISABLED_EveryControlIsClicked'
    echo "$dpi dpi: $(find "$out/$dpi" -name "*.png" | wc -l) pictures"
done
