#!/bin/sh
# Compares the program's own conversion of numbers to decimal text with Fortran's formatted writes, and measures the time of both
# (release build).
#
#   scripts/bench/check_numbers.sh [NUMBERS]      number of values that are converted (default: 10000000, about 20 s)
#
# The exit status is 0 if all texts agree and the program's conversion is at least 8 times as fast.
cd "$(dirname "$0")/../.." || exit 1
exec "$(scripts/build.sh check_numbers)" "$@"
