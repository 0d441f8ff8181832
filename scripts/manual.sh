#!/bin/sh
# Builds the manual into build/manual with FORD from the pages of data/manual, the measured tables of data/measured, the reference
# pages that the program prints, and the comments of the source. Any warning of FORD is an error: the exit status is then 1.
#
#   scripts/manual.sh [PROGRAM]      PROGRAM: the gudgeon that prints the reference pages (default: that of scripts/build.sh)
cd "$(dirname "$0")/.." || exit 1
scripts/setup.sh --manual || exit 1
program=${1:-$(scripts/build.sh)} || exit 1
[ -x "$program" ] || exit 1
rm -rf build/manual build/manual_pages
log=$(mktemp)
trap 'rm -f "$log"' EXIT
.venv/bin/python scripts/manual/pages.py collect "$program" || exit 1
.venv/bin/ford README.md >"$log" 2>&1
status=$?
if [ "$status" != 0 ] || grep -qiwE 'warnings?|errors?' "$log"; then
  cat "$log" >&2
  echo "manual: FORD failed or warned" >&2
  exit 1
fi
.venv/bin/python scripts/manual/pages.py link || exit 1
echo build/manual/index.html
