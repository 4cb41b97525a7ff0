#!/usr/bin/env bash
# The Debian package from building to removal:
#
#     tests/bench/package_debian.sh [FOLDER]      FOLDER: out/package
#
# Builds it, asks lintian, mandoc and the shells what they think of it, installs it on a bare Debian 12
# (mmdebstrap, with this machine's sources of packages), bakes, draws, opens the window on a display of
# this machine, imports the Python module, removes it and compares all files with those of before.
# As root, with mounts allowed. Takes some minutes and 1.5 GB; leaves FOLDER/window.png to be looked at.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=$(realpath -m "${1:-$root/out/package}")
bare=$out/debian
mkdir -p "$out"
[ "$(id -u)" = 0 ] || { echo "package_debian.sh: needs root: chroot and mounts" >&2; exit 2; }

step() { printf '\n== %s\n' "$*"; }
fail() { echo "package_debian.sh: $*" >&2; exit 1; }

# in_bare COMMAND...: in the bare system; what is mounted there ends with the command
in_bare() {
    # shellcheck disable=SC2016  # $0 and $@ are the inner shell's
    unshare --mount --pid --fork --kill-child bash -c '
        mount -t proc proc "$0/proc"
        mkdir -p /tmp/.X11-unix "$0/tmp/.X11-unix"
        mount --bind /tmp/.X11-unix "$0/tmp/.X11-unix"
        # Mesa does not ask HOME where its cache of shaders goes
        exec chroot "$0" env -i PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/tmp XDG_CACHE_HOME=/tmp \
            LC_ALL=C.UTF-8 DEBIAN_FRONTEND=noninteractive DISPLAY="$DISPLAY" "$@"' "$bare" "$@"
}

# every file but those that installing anything changes, what is mounted, and what is the user's (/tmp)
files_of_bare() {
    (cd "$bare" && find . \( -path ./proc -o -path ./tmp -o -path ./var/cache -o -path ./var/lib/apt \
        -o -path ./var/lib/dpkg -o -path ./var/log \) -prune -o -print) | sort
}

step "tools"
apt-get install -y -q --no-install-recommends lintian mmdebstrap mandoc man-db groff zsh fish xvfb \
    imagemagick desktop-file-utils libxml2-utils >"$out/apt.log" 2>&1 || fail "see $out/apt.log"

step "the package"
"$root/run" package
deb=$(ls "$root"/build/package/surfelao_*.deb)
[ "$(wc -w <<<"$deb")" = 1 ] || fail "several packages: $deb"

step "lintian"
lintian --allow-root --fail-on error,warning "$deb" || fail "lintian finds faults"

step "pages, completions, desktop files"
share=$root/build/package/share
for page in "$share"/man/man1/*.1; do
    mandoc -T lint -W warning "$page" || fail "mandoc finds faults in $page"
    said=$(LC_ALL=C.UTF-8 MANWIDTH=80 man --warnings -l "$page" 2>&1 >/dev/null)
    [ -z "$said" ] || fail "man: $page: $said"
done
bash -n "$share/bash-completion/completions/surfelao"
zsh -n "$share/zsh/vendor-completions/_surfelao"
fish -n "$share/fish/vendor_completions.d/surfelao.fish"
desktop-file-validate "$root/packaging/surfelao.desktop"
xmllint --noout "$root/packaging/surfelao.xml" "$root/packaging/surfelao.svg"

step "a bare Debian 12"
rm -rf "$bare"
mmdebstrap --quiet --variant=minbase --aptopt='Acquire::Languages "none"' bookworm "$bare" \
    /etc/apt/sources.list.d/debian.sources
DISPLAY='' in_bare apt-get update -q >"$out/apt.log" 2>&1 || fail "see $out/apt.log"
files_of_bare >"$out/before.txt"

step "apt install"
cp "$deb" "$bare/tmp/"
DISPLAY='' in_bare apt-get install -y -q --no-install-recommends "/tmp/$(basename "$deb")" \
    >"$out/install.log" 2>&1 || fail "see $out/install.log"
echo "$(grep -c '^Setting up' "$out/install.log") packages"
DISPLAY='' in_bare dpkg -L surfelao >"$out/contents.txt"

step "use"
examples=/usr/share/doc/surfelao/examples
use() { DISPLAY='' in_bare "$@"; }
use surfelao --version
use surfelao bake $examples/room.obj -o /tmp/room.ply
use surfelao bake $examples/bracket.obj -o /tmp/bracket.obj --at texels --size 256
use surfelao render $examples/robot.glb -o /tmp/robot.png --width 320 --height 240
[ "$(identify -format %k "$bare/tmp/robot.png")" -gt 100 ] || fail "the picture is empty"
# shellcheck disable=SC2016  # the inner shell's
use bash -c 'source /usr/share/bash-completion/completions/surfelao
    COMP_WORDS=(surfelao bake --engine "") COMP_CWORD=3; _surfelao; [ "${COMPREPLY[*]}" = "masks disks rays" ]'
if grep -q dist-packages "$out/contents.txt"; then
    use python3 -c 'import surfelao; print("module", surfelao.__file__)'
else
    echo "built without the Python module"
fi

step "the window"
exec 3>"$out/display.txt"
Xvfb -ac -screen 0 1280x800x24 -displayfd 3 2>/dev/null &
display=$!
trap 'kill $display' EXIT
until [ -s "$out/display.txt" ]; do sleep .2; done
DISPLAY=:$(cat "$out/display.txt")
export DISPLAY
in_bare surfelao view $examples/robot.glb &
window=$!
for _ in $(seq 300); do  # software OpenGL on a busy machine: until the model stands beside the panel
    sleep 1
    import -window root "$out/window.png"
    colors=$(convert "$out/window.png" -crop 840x800+440+0 -format %k info:)
    [ "$colors" -lt 100 ] || break
done
[ "$colors" -ge 100 ] || fail "the model in the window has $colors colours"
echo "$colors colours, $out/window.png"
kill -KILL $window  # and what it has started
wait $window || true

step "removal"
DISPLAY='' in_bare apt-get purge -y -q --autoremove surfelao >"$out/purge.log" 2>&1 || fail "see $out/purge.log"
while read -r file; do
    [ -d "$bare$file" ] || [ ! -e "$bare$file" ] || fail "$file is left"
done <"$out/contents.txt"
files_of_bare >"$out/after.txt"
diff "$out/before.txt" "$out/after.txt" || fail "what stands above is left"
echo "nothing is left"
