#!/bin/sh
# Builds the fast program and installs it, by default into ~/.local/bin. Its manual page and the completions of bash, zsh and fish go into
# the folder share beside a folder bin, or in another folder, where man and the shells look for them.
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
case $folder in
  */bin) share=${folder%/bin}/share ;;
  *) share=$folder/share ;;
esac

page() {   # page PATH ARGUMENT...: what the program prints with these arguments, as a file of $share
  path=$share/$1
  shift
  mkdir -p "$(dirname "$path")" && "$folder/gudgeon" "$@" >"$path.part" && mv "$path.part" "$path" || exit 1
  echo "$path"
}

page man/man1/gudgeon.1 --man
page bash-completion/completions/gudgeon --completion bash
page zsh/site-functions/_gudgeon --completion zsh
page fish/vendor_completions.d/gudgeon.fish --completion fish
case ":$PATH:" in
  *":$folder:"*) ;;
  *) echo "install: $folder is not on the PATH: add it with  export PATH=\"$folder:\$PATH\"" >&2 ;;
esac
