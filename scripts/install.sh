#!/bin/sh
# Builds the fast program and installs it, by default into ~/.local/bin.
#
#   scripts/install.sh [DIR]
folder=${1:-$HOME/.local/bin}
mkdir -p "$folder" && folder=$(cd "$folder" && pwd) || exit 1
cd "$(dirname "$0")/.." || exit 1
program=$(scripts/build.sh) || exit 1
cp "$program" "$folder/gudgeon.part" && mv "$folder/gudgeon.part" "$folder/gudgeon" || exit 1
echo "$folder/gudgeon"
case ":$PATH:" in
  *":$folder:"*) ;;
  *) echo "install: $folder is not on the PATH: add it with  export PATH=\"$folder:\$PATH\"" >&2 ;;
esac
