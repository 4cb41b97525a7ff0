#!/bin/sh
# report_views.sh FOLDER REPORT.html...: how reports look in chromium on a desktop and on a
# phone, light and dark: FOLDER/NAME-desktop.png, NAME-phone.png, NAME-dark.png, to be looked at.
# NAME: the folder of the report. Installs chromium where it is missing.
set -eu
[ $# -ge 2 ] || { sed -n '2,4s/^# //p' "$0" >&2; exit 2; }
folder=$1
shift
command -v chromium > /dev/null || apt-get install -y --no-install-recommends chromium
mkdir -p "$folder"
profile=$(mktemp -d)
trap 'rm -rf "$profile"' EXIT

# view PICTURE WIDTH HEIGHT PAGE [OPTION...]
view() {
    picture=$1 size=$2,$3 page=$4
    shift 4
    chromium --headless --no-sandbox --disable-gpu --hide-scrollbars --user-data-dir="$profile" \
        --window-size="$size" --screenshot="$picture" "$@" "file://$page" 2> /dev/null
}

for report in "$@"; do
    page=$(realpath "$report")
    name=$(basename "$(dirname "$page")")
    view "$folder/$name-desktop.png" 1280 2600 "$page"
    view "$folder/$name-phone.png" 390 2600 "$page"
    view "$folder/$name-dark.png" 1280 2600 "$page" --force-dark-mode --enable-features=WebContentsForceDark
done
ls "$folder"
