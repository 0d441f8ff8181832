#!/bin/sh
# Builds the fast program (`fpm @release`) and prints its path, relative to the top of the checkout. The tool chain is set up first
# if it is missing.
#
#   scripts/build.sh                     builds gudgeon
#   scripts/build.sh PROGRAM             builds one of the programs of scripts/bench/fpm.toml: check_numbers, measure_costs, ...
#   scripts/build.sh --native [PROGRAM]  the same for this processor alone (`fpm @native`)
#
# Nothing else is printed on standard output. If the build fails, the exit status is 1 and the messages of fpm are on standard
# error.
cd "$(dirname "$0")/.." || exit 1
. scripts/setup.sh || exit 1
profile=@release
[ "$1" = --native ] && profile=@native && shift
folder= found=
[ $# -gt 0 ] && folder=scripts/bench/

build() {
  # shellcheck disable=SC2086  # options or nothing
  said=$(fpm $profile ${folder:+--directory scripts/bench} --runner echo "$@" 2>&1) &&
    found=$folder$(printf '%s\n' "$said" | grep "^build/.*/${1:-gudgeon}\$" | tail -n 1) &&
    [ -f "$found" ] && [ -x "$found" ]
}

build "$@" && echo "$found" && exit 0
if printf '%s\n' "$said" | grep -q -e 'multiple definition of' -e 'Mismatch in components of derived type'; then
  rm -rf build/gfortran_* scripts/bench/build/gfortran_*   # objects of earlier sources are in the way
  build "$@" && echo "$found" && exit 0
elif [ -n "$found" ] && [ -f "$found" ] && [ ! -x "$found" ]; then
  rm -f "$found"   # what a link left that was interrupted, and that fpm takes for the program
  build "$@" && echo "$found" && exit 0
fi
printf '%s\n' "$said" >&2
echo "build: cannot build ${1:-gudgeon}" >&2
exit 1
