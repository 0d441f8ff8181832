#!/bin/sh
# Runs all shipped cases as they are, and some rows of a study, with the address sanitizer of the compiler, which also finds memory that
# is not freed. Ends with the line "N passed, N failed". The first build takes some ten minutes.
cd "$(dirname "$0")/.." || exit 1
. scripts/setup.sh || { echo "0 passed, 1 failed"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
said=$(fpm run gudgeon --flag "-O1 -g -fno-omit-frame-pointer -fsanitize=address" --runner echo 2>&1) ||
  { printf '%s\n' "$said"; echo "0 passed, 1 failed"; exit 1; }
gudgeon=$(printf '%s\n' "$said" | grep '^build/.*/gudgeon$' | tail -n 1)
passed=0
failed=0

clean() {   # clean ARGUMENTS...: the program succeeds and the sanitizer finds nothing; one process, since others end without its report
  if timeout 300 "$gudgeon" "$@" -q -j 1 -o "$work" >"$work/said" 2>&1 && ! grep -q Sanitizer "$work/said"; then
    passed=$((passed + 1))
  else
    failed=$((failed + 1))
    echo "FAILED: $*"
    grep -A 12 Sanitizer "$work/said"
  fi
}

for case in $(grep -rlE '^&(mechanism|bearing_load)' cases --include='*.nml'); do clean "$case"; done
clean sweep --rows 1:2 cases/studies/map_I.nml
clean sweep --rows 1:2 -s integrator.method=auto cases/studies/map_IV.nml
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
