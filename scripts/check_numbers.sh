#!/bin/sh
# Compares the decimal conversion of the traces with formatted writes, release build, and times both.
#
#   scripts/check_numbers.sh [NUMBERS]      (10000000: some 20 s)
#
# The exit status is 0 if all agree and the conversion is at least 8 times faster.
cd "$(dirname "$0")/.." || exit 1
exec "$(scripts/build.sh check_numbers)" "$@"
