#!/bin/sh
# Builds the manual into build/manual, from the pages of data/manual, the measured tables of data/measured, the reference pages that the
# program prints, and the comments of the source. It opens without a network. Any warning is an error: the exit status is then 1.
#
#   scripts/manual.sh [PROGRAM]          PROGRAM: the gudgeon that prints the reference pages (default: that of scripts/build.sh)
#   scripts/manual.sh --pdf [PROGRAM]    also as one file to print, build/manual/gudgeon.pdf (needs Chromium: scripts/setup.sh --browser)
cd "$(dirname "$0")/.." || exit 1
pdf=false
[ "$1" = --pdf ] && pdf=true && shift
scripts/setup.sh --manual || exit 1
program=${1:-$(scripts/build.sh)} || exit 1
[ -x "$program" ] || exit 1
rm -rf build/manual
work=$(mktemp -d)
log=$work/log
trap 'rm -rf "$work" 2>/dev/null' EXIT   # Chromium may still be writing

quietly() {   # run a command; stop with what it said if it failed or warned
  "$@" >"$log" 2>&1 && ! grep -v '━' "$log" | grep -qiwE 'warnings?|errors?' && return   # lines of progress name variables
  cat "$log" >&2
  echo "manual: $* failed or warned" >&2
  exit 1
}

.venv/bin/python scripts/manual/pages.py collect "$program" || exit 1
quietly .venv/bin/ford scripts/manual/api.md
.venv/bin/python scripts/manual/pages.py local || exit 1
quietly env NO_MKDOCS_2_WARNING=1 .venv/bin/mkdocs build --strict -f scripts/manual/mkdocs.yml </dev/null   # without standard input it finds no folder
echo build/manual/index.html
$pdf || exit 0

printed() {   # print.html as a PDF; with a profile of its own, beside a Chromium of the user; TMPDIR may be too long for its socket
  TMPDIR=/tmp chromium --headless --no-sandbox --disable-gpu --user-data-dir="$work/profile" --no-pdf-header-footer \
    --print-to-pdf=build/manual/gudgeon.pdf build/manual/print.html >"$log" 2>&1   # it complains of a machine without a desktop
  [ -s build/manual/gudgeon.pdf ] || { cat "$log" >&2; exit 1; }
}

printed
.venv/bin/python scripts/manual/pages.py number || exit 1
printed   # now with the numbers of the pages in its contents
echo build/manual/gudgeon.pdf
