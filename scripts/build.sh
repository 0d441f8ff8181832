#!/bin/sh
# Builds a fast program (fpm @release, set up where needed) and prints its path, relative to the top of the checkout.
#
#   scripts/build.sh            gudgeon
#   scripts/build.sh PROGRAM    one of scripts/fpm.toml: check_numbers, measure_costs, ...
#
# Nothing else goes to standard output. The exit status is 1, with what fpm said, if it cannot be built.
cd "$(dirname "$0")/.." || exit 1
. scripts/setup.sh || exit 1
folder=
[ $# -gt 0 ] && folder=scripts/

build() {
  # shellcheck disable=SC2086  # options or nothing
  said=$(fpm @release ${folder:+--directory scripts} --runner echo "$@" 2>&1) &&
    found=$folder$(printf '%s\n' "$said" | grep "^build/.*/${1:-gudgeon}\$" | tail -n 1) &&
    [ -x "$found" ]
}

build "$@" && echo "$found" && exit 0
if printf '%s\n' "$said" | grep -q -e 'multiple definition of' -e 'Mismatch in components of derived type'; then
  rm -rf build/gfortran_* scripts/build/gfortran_*   # left by an earlier state of the sources
  build "$@" && echo "$found" && exit 0
fi
printf '%s\n' "$said" >&2
echo "build: cannot build ${1:-gudgeon}" >&2
exit 1
