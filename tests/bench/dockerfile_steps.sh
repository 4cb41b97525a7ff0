#!/usr/bin/env bash
# The steps of packaging/Dockerfile without Docker, each stage in a bare Debian 12 of its own:
#
#     tests/bench/dockerfile_steps.sh [FOLDER]      FOLDER: out/docker
#
# Reads FROM, WORKDIR, COPY, RUN and ENTRYPOINT as they are used there, and fails at any other word. As
# root, with mounts allowed; builds the program from nothing, 3 GB. With CCACHE_DIR set, by that cache.
set -euo pipefail
root=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
out=$(realpath -m "${1:-$root/out/docker}")
mkdir -p "$out"
[ "$(id -u)" = 0 ] || { echo "dockerfile_steps.sh: needs root: chroot and mounts" >&2; exit 2; }
fail() { echo "dockerfile_steps.sh: $*" >&2; exit 1; }

# in_stage STAGE FOLDER COMMAND...: there, in that folder
in_stage() {
    # shellcheck disable=SC2016  # the inner shell's
    unshare --mount --pid --fork bash -c '
        stage=$0 folder=$1; shift
        mount -t proc proc "$stage/proc"
        settings=()
        if [ -n "${CCACHE_DIR:-}" ] && [ -x "$stage/usr/bin/ccache" ]; then
            mkdir -p "$stage/ccache"
            mount --bind "$CCACHE_DIR" "$stage/ccache"
            settings=(CCACHE_DIR=/ccache CCACHE_BASEDIR=/src CCACHE_NOHASHDIR=1
                CMAKE_CXX_COMPILER_LAUNCHER=ccache)
        fi
        exec chroot "$stage" env -i -C "$folder" PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/root \
            LANG=C.UTF-8 DEBIAN_FRONTEND=noninteractive "${settings[@]}" "$@"' "$@"
}

stage='' name='' folder=/ entry=''
while read -r word rest; do
    case $word in
    '' | '#'*) continue ;;
    esac
    echo "== $word $rest"
    case $word in
    FROM)
        name=${rest##* AS } folder=/
        [ "${rest%% *}" = debian:12-slim ] || fail "only debian:12-slim is known"
        stage=$out/$name
        [ "$name" != "$rest" ] || stage=$out/last
        rm -rf "$stage"
        mmdebstrap --quiet --variant=minbase bookworm "$stage" /etc/apt/sources.list.d/debian.sources
        if [ -n "${CCACHE_DIR:-}" ] && [ "$name" = build ]; then
            in_stage "$stage" / sh -c 'apt-get update -q && apt-get install -y -q ccache' >"$out/ccache.log" 2>&1
        fi
        ;;
    WORKDIR)
        folder=$rest
        mkdir -p "$stage$folder"
        ;;
    COPY)
        read -r first second third <<<"$rest"
        if [ "$first" = --from=build ]; then
            # shellcheck disable=SC2086  # a pattern
            cp "$out/build"$second "$stage$third"
        else # what git has is what is left of the folder by .dockerignore
            git -C "$root" ls-files -z -- "$first" | tar -C "$root" --null -T - -c | tar -x -C "$stage$folder/$second"
        fi
        ;;
    RUN) in_stage "$stage" "$folder" sh -c "$rest" >"$out/run.log" 2>&1 || fail "see $out/run.log" ;;
    ENTRYPOINT) entry=$(tr -d '[]"' <<<"$rest") ;;
    *) fail "$word is not known here" ;;
    esac
done <"$root/packaging/Dockerfile"

cp "$root/data/blob.off" "$stage$folder/"
in_stage "$stage" "$folder" "$entry" bake blob.off -o blob.ply
du -sh "$stage"
