#!/bin/sh
# Builds the fast programs (fpm @release, set up where needed) and prints the path of one, relative to the top of the checkout.
#
#   scripts/build.sh            gudgeon
#   scripts/build.sh EXAMPLE    an example of fpm.toml: check_numbers, measure_costs, ...
#
# Nothing else goes to standard output. The exit status is 1, with what fpm said, if it cannot be built.
cd "$(dirname "$0")/.." || exit 1
. scripts/setup.sh || exit 1
# shellcheck disable=SC2086  # an option or nothing
said=$(fpm @release ${1:+--example} --runner echo 2>&1) &&
  found=$(printf '%s\n' "$said" | grep "^build/.*/${1:-gudgeon}\$" | tail -n 1) &&
  [ -x "$found" ] && echo "$found" && exit 0
printf '%s\n' "$said" >&2
echo "build: cannot build ${1:-gudgeon}" >&2
exit 1
