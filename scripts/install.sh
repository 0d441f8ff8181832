#!/bin/sh
# Builds the fast program and installs it, by default into ~/.local/bin.
#
#   scripts/install.sh [--native] [DIR]     --native: for this processor alone; it may not run on others
native=
[ "$1" = --native ] && native=$1 && shift
case $1 in -*) echo "install: usage: scripts/install.sh [--native] [DIR]" >&2; exit 2 ;; esac
folder=${1:-$HOME/.local/bin}
mkdir -p "$folder" && folder=$(cd "$folder" && pwd) || exit 1
cd "$(dirname "$0")/.." || exit 1
program=$(scripts/build.sh $native) || exit 1
cp "$program" "$folder/gudgeon.part" && mv "$folder/gudgeon.part" "$folder/gudgeon" || exit 1
echo "$folder/gudgeon"
case ":$PATH:" in
  *":$folder:"*) ;;
  *) echo "install: $folder is not on the PATH: add it with  export PATH=\"$folder:\$PATH\"" >&2 ;;
esac
