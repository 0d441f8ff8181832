#!/bin/sh
# The shared library in the hands of others: a C program, the Python package, the explorer, functional mock-up units, what shells and editors read.
#
#   tests/test_embedding.sh [--all]     --all: every shipped case, ten scenes of FMI, and the C program under valgrind
#
# Ends with `N passed, N failed`; the exit status is 0 if nothing failed.
cd "$(dirname "$0")/.." || exit 1
program=$(scripts/build.sh) || exit 1
library=$(scripts/python/build_library.py) || exit 1
export GUDGEON_LIBRARY="$library"
passed=0
failed=0

add() {   # add NAME COMMAND...: add up the counts of a test
  name=$1
  shift
  said=$("$@" 2>&1)
  counts=$(printf '%s\n' "$said" | sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' | tail -n 1)
  printf '%s\n' "$said" | grep -v ' passed, '
  if [ -z "$counts" ]; then
    echo "FAILED: $name"
    failed=$((failed + 1))
    return
  fi
  passed=$((passed + ${counts% *}))
  failed=$((failed + ${counts#* }))
}

others=$(nm -D --defined-only "$library" | awk '{print $3}' | grep -v -e '^gudgeon_' -e '^fmi[23]')
if [ -z "$others" ]; then passed=$((passed + 1)); else echo "FAILED: the library exports $others"; failed=$((failed + 1)); fi
gcc -std=c99 -D_GNU_SOURCE -Wall -Wextra -Werror -O1 -g -Isrc/api tests/api/test_c.c -o build/test_c "$library" \
  -Wl,-rpath,"$(dirname "$library")" -lpthread -lm
add "C program" build/test_c cases
if [ "$1" = --all ] && command -v valgrind >/dev/null; then
  add "C program under valgrind" valgrind -q --error-exitcode=9 --leak-check=full build/test_c cases alone
fi

# the program of the page on C
sed -n '/^    #include/,/^    }/s/^    //p' data/manual/c.md >build/turn.c
if gcc -Wall -Wextra -Werror -Isrc/api build/turn.c "$library" -Wl,-rpath,"$(dirname "$library")" -o build/turn &&
  build/turn | grep -q '^status,done,'; then passed=$((passed + 1)); else echo "FAILED: the page on C"; failed=$((failed + 1)); fi
add "examples" .venv/bin/python tests/test_examples.py "$@"
add "Python package" .venv/bin/python tests/test_python.py "$program" "$@"
add "periodic orbits" .venv/bin/python tests/test_orbits.py "$program" "$@"
add "functional mock-up units" .venv/bin/python tests/test_fmu.py "$@"
add "server of the explorer" .venv/bin/python tests/test_explore_server.py
add "explorer in a browser" .venv/bin/python tests/test_explore.py --program "$program"
add "shell and editor" .venv/bin/python tests/test_shell_pages.py "$program"
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
