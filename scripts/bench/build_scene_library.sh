#!/bin/sh
# Builds a library of scenes that C and Python can call (scripts/bench/scene_library/scene_library.f90, optimised like the program) and
# prints the path of the library. Its objects must be position-independent, so they have their own build folder,
# build/scene_library. Without -fno-semantic-interposition the compiler would not include procedures of one module in another: every
# procedure of a library can be replaced when it is loaded.
cd "$(dirname "$0")/../.." || exit 1
. scripts/setup.sh || exit 1
folder=build/scene_library
flags="-O3 -flto=auto -fno-ipa-modref -fno-tree-vectorize --param max-inline-insns-auto=150 -fPIC -fno-semantic-interposition"
mkdir -p "$folder" || exit 1
if [ "$(cat "$folder/flags" 2>/dev/null)" != "$flags" ]; then   # objects made with other flags must not be linked too
  rm -rf "$folder/build" && printf '%s\n' "$flags" >"$folder/flags" || exit 1
fi
ln -sfn ../../src "$folder/src"
cat >"$folder/fpm.toml" <<'TOML'
name = "gudgeon"
[build]
auto-executables = false
[dependencies]
openmp = "*"
[library]
source-dir = "src"
TOML
said=$(fpm build --directory "$folder" --no-prune --flag "$flags" --c-flag -fPIC 2>&1) &&
  modules=$(dirname "$(find "$folder/build" -name scene_builder.mod | head -n 1)") &&
  objects=$(find "$folder/build" -name '*.o' ! -name '*main.f90.o') &&
  said=$(gfortran $flags -shared -fopenmp -I "$modules" -J "$folder" tests/state_watcher.f90 tests/event_watcher.f90 \
    scripts/bench/scene_library/scene_library.f90 $objects -o "$folder/scene_library.so" 2>&1) &&
  echo "$folder/scene_library.so" && exit 0
printf '%s\n' "$said" >&2
echo "build_scene_library: cannot build the library of scenes" >&2
exit 1
