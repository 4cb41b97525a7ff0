#!/usr/bin/env bash
# The window clicked through on a virtual display of 96 and 192 dpi, a picture after every click.
#
#   window_click.sh BUILD OUT [START...]
#
# BUILD holds bin/viewer_test; pictures go to OUT/96 and OUT/192, where a person looks at them, and
# what was said beside them to OUT/96.log and OUT/192.log. START: with what the window begins, of
# those that are listed below; all without it. Exit code 0: every control was clicked, and nothing
# was said to have gone wrong. Needs xvfb, x11-utils (xprop); takes some minutes a start, both
# displays at once.
set -euo pipefail
build=$1 out=$2
shift 2
here=$(cd "$(dirname "$0")/../../.." && pwd)
starts=("$@")
[ ${#starts[@]} -gt 0 ] || starts=(disks map screen animated nothing grid maps)

click_all() # DPI
{
    local start failed=0
    mkdir -p "$out/$1"
    for start in "${starts[@]}"; do
        # the window system tells the scale as desktops do: by a resource of the root window
        SURFELAO_PICTURES=$out/$1 SURFELAO_DATA=$here/data SURFELAO_START=$start dpi=$1 build=$build \
            xvfb-run -a -s "-screen 0 1600x2100x24 -noreset" bash -c '
            xprop -root -f RESOURCE_MANAGER 8s -set RESOURCE_MANAGER "Xft.dpi: $dpi"
            "$build/bin/viewer_test" --gtest_also_run_disabled_tests \
                --gtest_filter=Window.DISABLED_EveryControlIsClicked' || failed=1
    done
    echo "$1 dpi: $(find "$out/$1" -name "*.png" | wc -l) pictures"
    return $failed
}

mkdir -p "$out"
click_all 96 > "$out/96.log" 2>&1 &
first=$!
click_all 192 > "$out/192.log" 2>&1 &
second=$!
code=0
wait $first || code=1
wait $second || code=1
tail -n 1 "$out/96.log" "$out/192.log"
exit $code
