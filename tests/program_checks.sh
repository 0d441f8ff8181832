# Checks of the program for shell tests, which source this file from the top of the checkout. They are counted in $passed and
# $failed in the same way as in tests/checks.f90: a name without its numbers is one assertion, which has passed if it holds each
# time. $work is a temporary folder that is removed at the end; $subcommand is the subcommand with which `refused` runs the program.
subcommand=
passed=0
failed=0
work=$(mktemp -d)
trap 'chmod -R u+w "$work" 2>/dev/null; rm -rf "$work"' EXIT
gudgeon=$(scripts/build.sh) || { echo "0 passed, 1 failed"; exit 1; }

awk() { LC_ALL=C command awk "$@"; }   # numbers have decimal points in every locale

check() {   # check NAME COMMAND...: the command must succeed
  name=$1
  shift
  if "$@"; then turn=passed; else turn=failed; echo "FAILED: $name"; fi
  printf '%s\n' "$turn $name" | tr '\n' ' ' | sed -E 's/(^|[^A-Za-z_0-9])[-+.]*[0-9][-0-9.+eEdD]*/\1#/g' >>"$work/assertions"
  echo >>"$work/assertions"
  passed=$(cut -d ' ' -f 2- "$work/assertions" | sort -u | wc -l)
  failed=$(grep '^failed ' "$work/assertions" | sort -u | wc -l)
  passed=$((passed - failed))
}

run() {   # run ARGUMENTS...: sets status, $work/out and $work/err
  "$gudgeon" "$@" >"$work/out" 2>"$work/err" </dev/null
  status=$?
}

refused() {   # refused NAME STATUS PATTERN ARGUMENTS...: one line on standard error that matches the pattern, no files
  name=$1
  want=$2
  pattern=$3
  shift 3
  run $subcommand -o "$work/refused" "$@"
  check "$name: exit status $want, got $status" [ "$status" = "$want" ]
  check "$name: one line, got $(cat "$work/err")" [ "$(wc -l <"$work/err")" = 1 ]
  check "$name: message $(cat "$work/err")" grep -q "^gudgeon: .*$pattern" "$work/err"
  check "$name: nothing written" [ ! -e "$work/refused" ]
  check "$name: nothing on standard output" [ ! -s "$work/out" ]
}
