#!/bin/sh
# Sets up the tool chain and runs every test twice: with all checks of the compiler, warnings as errors, and as released.
# Ends with the line "N passed, N failed"; the exit status is 0 if nothing failed.
#
#   scripts/test.sh                     all tests
#   scripts/test.sh contact friction    the Fortran suites test_contact and test_friction alone, with all checks of the compiler
cd "$(dirname "$0")/.." || exit 1
. scripts/setup.sh || { echo "0 passed, 1 failed"; exit 1; }
[ $# -gt 0 ] && exec fpm @strict -- "$@"

log=$(mktemp)
trap 'rm -f "$log"' EXIT
passed=0
failed=0
wrong=0

count() {   # count NAME COMMAND...: run the command and add up its counts
  name=$1
  shift
  echo "== $name"
  "$@" >"$log" 2>&1
  status=$?
  grep -v '^\[ *[0-9]*%\]' "$log"
  counts=$(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$log" | tail -n 1)
  if [ -n "$counts" ]; then
    passed=$((passed + ${counts% *}))
    failed=$((failed + ${counts#* }))
    [ "$status" != 0 ] && [ "${counts#* }" = 0 ] && wrong=$((wrong + 1))
  else
    wrong=$((wrong + 1))   # did not build, or crashed
  fi
}

count "every module and program compiles" sh -c 'fpm build --no-prune && fpm build --directory scripts && echo "1 passed, 0 failed"'
count "builds" tests/test_build.sh
count "layers" tests/test_layers.py
count "tests, strict" fpm @strict
count "case files, fuzzed" tests/test_fuzz.py
count "tests, release" fpm @release_tests
count "the program" tests/test_program.sh
count "studies" tests/test_sweep.sh
count "the judge of runs" tests/test_judge.py
count "extreme scenes" scripts/extremes --scenes 120 --seed 5 --evaluations 100000 --judged 24 --known tests/known_findings.csv --quiet
count "summaries" tests/test_summaries.py
count "tables of films" tests/test_film_tables.py
count "faults" tests/test_faults.py --kills 10
count "runs taken up again" tests/test_resume.py --kills 10
count "the plots" sh -c 'scripts/setup.sh --python && tests/test_plots.py'
count "orders and cycles" sh -c 'scripts/setup.sh --python && .venv/bin/python tests/test_orders.py'
count "what each model changes" sh -c 'scripts/setup.sh --python && .venv/bin/python tests/test_models.py'
count "the pages of runs, in a browser" sh -c 'scripts/setup.sh --browser && tests/test_report.py'
count "the manual" sh -c 'scripts/setup.sh --manual && tests/test_manual.py'
count "what holds of the dissertation" sh -c 'scripts/setup.sh --python && .venv/bin/python scripts/check_findings.py --check'
count "studies past the program" sh -c 'scripts/setup.sh --studies && tests/test_studies.py'

failed=$((failed + wrong))
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
