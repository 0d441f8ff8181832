#!/bin/sh
# Sets up the tool chain and runs the tests: those in Fortran with every check of the compiler and warnings as errors, then the released
# program as users run it. Ends with the line "N passed, N failed"; the exit status is 0 if nothing failed.
#
#   scripts/test.sh                     what every change must pass
#   scripts/test.sh --all               the rest too: Fortran tests as released, tests of the independent judge
#   scripts/test.sh contact friction    the Fortran suites test_contact and test_friction alone, with all checks of the compiler
cd "$(dirname "$0")/.." || exit 1
. scripts/setup.sh || { echo "0 passed, 1 failed"; exit 1; }
all=false
[ "$1" = --all ] && all=true && shift
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
  began=$(date +%s)
  timeout 1200 "$@" >"$log" 2>&1   # none takes a third of that
  status=$?
  echo "   $(($(date +%s) - began)) s"
  grep -v '^\[ *[0-9]*%\]' "$log"
  counts=$(sed -n 's/^\([0-9]*\) passed, \([0-9]*\) failed$/\1 \2/p' "$log" | tail -n 1)
  if [ -n "$counts" ]; then
    passed=$((passed + ${counts% *}))
    failed=$((failed + ${counts#* }))
    [ "$status" != 0 ] && [ "${counts#* }" = 0 ] && wrong=$((wrong + 1))
  else
    wrong=$((wrong + 1))   # the program was not built, or crashed
  fi
}

count "all modules and programs compile" sh -c 'fpm build --no-prune && fpm build --directory scripts/bench && echo "1 passed, 0 failed"'
count "build scripts" tests/test_build.sh
count "layers, linters" sh -c 'scripts/setup.sh --lint && tests/test_layers.py'
count "Fortran tests, all compiler checks" fpm @strict
count "random changes of case files" tests/test_fuzz.py
$all && count "Fortran tests, release build" fpm @release_tests
count "command line" tests/test_program.sh
count "parameter studies" tests/test_sweep.sh
$all && count "independent judge of runs" tests/test_judge.py
count "extreme scenes" tests/judge/extremes --scenes 120 --seed 5 --evaluations 100000 --judged 24 --limit 120 --known tests/judge/known_findings.csv --quiet
count "states and runs that go on from them" tests/test_state_file.py
count "summaries against traces" tests/test_summaries.py
count "answers of cycles" tests/test_cycle_answers.py
count "force tables of films" tests/test_film_tables.py
count "failures of the machine" tests/test_faults.py --kills 10
count "pictures" sh -c 'scripts/setup.sh --python && tests/test_plots.py'
count "analysis of settled cycles" sh -c 'scripts/setup.sh --python && .venv/bin/python tests/test_orders.py'
count "heat and work of the gas" sh -c 'scripts/setup.sh --python && .venv/bin/python tests/test_gas.py'
count "bearing cases" python3 tests/test_bearing_cases.py
count "effects of single models" sh -c 'scripts/setup.sh --python && .venv/bin/python tests/test_models.py'
count "pages of runs in a browser" sh -c 'scripts/setup.sh --browser && tests/test_report.py'
count "manual" sh -c 'scripts/setup.sh --manual && tests/test_manual.py'
count "statements of the dissertation" sh -c 'scripts/setup.sh --python && .venv/bin/python scripts/bench/check_findings.py --check'
count "sensitivity and cluster studies" sh -c 'scripts/setup.sh --studies && tests/test_studies.py'

failed=$((failed + wrong))
echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
