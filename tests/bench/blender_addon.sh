#!/usr/bin/env bash
# The Blender add-on, headless: it bakes a scene to a colour attribute and to images, and the values
# must be those of the program. Installs Debian's Blender where it is missing.
#   blender_addon.sh [BUILD]
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
build=${1:-$root/build/release}

if ! command -v blender >/dev/null; then
    if [ "$(id -u)" = 0 ]; then sudo=; else sudo=sudo; fi
    $sudo apt-get install -y -q --no-install-recommends blender >/dev/null
fi
scratch=$(mktemp -d)
trap 'rm -rf "$scratch"' EXIT
PYTHONPATH=$build/python blender --background --factory-startup --python-use-system-env \
    --python-exit-code 1 --python "$root/tests/bench/blender_addon.py" -- \
    "$root/python/blender/surfelao_ambient_occlusion.py" "$build/bin/surfelao" "$scratch"
