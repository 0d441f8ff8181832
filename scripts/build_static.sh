#!/bin/sh
# Builds the program without shared libraries, which runs on any Linux of its processor, and prints its path.
#
#   scripts/build_static.sh PATH
[ $# = 1 ] || { echo "build_static: usage: scripts/build_static.sh PATH" >&2; exit 2; }
mkdir -p "$(dirname "$1")" && path=$(cd "$(dirname "$1")" && pwd)/$(basename "$1") || exit 1
cd "$(dirname "$0")/.." || exit 1
. scripts/setup.sh || exit 1
said=$(fpm @release --link-flag "-static" --runner echo 2>&1) &&
  found=$(printf '%s\n' "$said" | grep '^build/.*/gudgeon$' | tail -n 1) && cp "$found" "$path" && echo "$path" && exit 0
printf '%s\n' "$said" >&2
exit 1
