#!/bin/sh
# Sets up the tool chain and runs the tests: those in Fortran with every check of the compiler and warnings as errors, and the released
# program as users run it, two stages side by side. Ends with the line "N passed, N failed"; the exit status is 0 if nothing failed.
#
#   scripts/test.sh                     what every change must pass
#   scripts/test.sh --all               the rest too: Fortran tests as released, the independent judge, more extreme scenes, other roundings
#   scripts/test.sh contact friction    the Fortran suites test_contact and test_friction alone, with all checks of the compiler;
#                                       with --times, the processor time of each
cd "$(dirname "$0")/.." || exit 1
. scripts/setup.sh || { echo "0 passed, 1 failed"; exit 1; }
if [ "$1" = --stage ]; then   # --stage FOLDER NAME|COMMAND: run the command, print its output and add its counts to those in the folder
  log=$(mktemp "$2/log.XXXXXX")
  began=$(date +%s)
  # processor time of a process and time: none takes a third of that; signals as at a terminal, although nohup or a shell in the background
  # started the tests
  timeout 4800 env --default-signal sh -c "ulimit -t 1200; ${3#*|}" >"$log" 2>&1
  status=$?
  seconds=$(($(date +%s) - began))
  times >"$log.times"
  processor=$(tail -n 1 "$log.times" | tr 'ms' '  ' | LC_ALL=C awk '{ printf "%.0f", 60*($1 + $3) + $2 + $4 }')
  {
    echo "== ${3%%|*}"
    echo "   $seconds s, $processor s of processor time"
    grep -av '^\[ *[0-9]*%\]' "$log"
  } >"$log.said"
  cat "$log.said"
  LC_ALL=C awk -v status=$status '/^[0-9]+ passed, [0-9]+ failed$/ { passed = $1; failed = $3; counted = 1 }
    END { print passed + 0, failed + 0, (!counted || (status && !failed)) }' "$log" >>"$2/counts"   # not built, or crashed: wrong
  exit 0
fi
all=false
[ "$1" = --all ] && all=true && shift

run_suites() {   # run_suites PROGRAM FOLDER SUITE...: build a Fortran test program, units or runs, of the package in this folder
  program=$1
  folder=$2
  shift 2
  said=$(fpm @strict --directory "$folder" --target "$program" --runner echo 2>&1) || { printf '%s\n' "$said" >&2; return 1; }
  "$folder/$(printf '%s\n' "$said" | grep "^build/.*/$program\$" | tail -n 1)" "$@"
}

if [ $# -gt 0 ]; then
  times=
  units=
  runs=
  for name; do
    if [ "$name" = --times ]; then times=$name
    elif grep -q "run_test_$name\$" tests/units.f90; then units="$units $name"
    else runs="$runs $name"; fi
  done
  status=0
  # shellcheck disable=SC2086  # names
  [ -z "$units" ] || run_suites units tests $times $units || status=1
  # shellcheck disable=SC2086
  [ -z "$runs" ] || run_suites runs . $times $runs || status=1
  exit $status
fi

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT

# Run stages, two at a time, from lines NAME|COMMAND: each prints its output when it has ended, and adds a line
# `passed failed wrong` to the counts.
run_stages() { tr '\n' '\0' | xargs -0 -n 1 -P 2 scripts/test.sh --stage "$work"; }

# Programs are built and packages are installed first, so that later stages find them.
run_stages <<'END'
programs|scripts/build.sh && fpm @strict --runner true && echo "1 passed, 0 failed"
Python packages, browser|scripts/setup.sh --python --browser --studies --manual --lint --embedding && echo "1 passed, 0 failed"
END

# Film tables, fonts and the like are kept for these tests alone: those of earlier versions hide nothing, and a home folder may be missing.
export XDG_CACHE_HOME="$work/cache"

stages() {   # the longest first
  cat <<'END'
manual|tests/test_manual.py
Fortran tests of cases|fpm @strict --target runs
extreme scenes|tests/judge/extremes --scenes 60 --seed 5 --evaluations 100000 --judged 12 --limit 120 --known tests/judge/known_findings.csv --quiet
parameter studies|tests/test_sweep.sh
pictures|tests/test_plots.py
random changes of case files|tests/test_fuzz.py
sensitivity and cluster studies|tests/test_studies.py
C interface, Python package, mock-up units|tests/test_embedding.sh
statements of the dissertation|.venv/bin/python scripts/bench/check_findings.py --check
analysis of settled cycles|.venv/bin/python tests/test_orders.py
summaries against traces|tests/test_summaries.py
pages of runs in a browser|tests/test_report.py
effects of single models|.venv/bin/python tests/test_models.py
answers of cycles|tests/test_cycle_answers.py
Fortran tests of single models|fpm @strict --target units
force tables of films|tests/test_film_tables.py
command line|tests/test_program.sh
bearing cases|python3 tests/test_bearing_cases.py
bearings under load|python3 tests/test_bearings.py
build scripts|tests/test_build.sh
states and runs that go on from them|tests/test_state_file.py
layers, linters|tests/test_layers.py
failures of the machine|tests/test_faults.py --kills 10
heat and work of the gas|.venv/bin/python tests/test_gas.py
several cylinders|.venv/bin/python tests/test_cylinders.py
heating of films|.venv/bin/python tests/test_film_heat.py
floating piston pin|.venv/bin/python tests/test_pin.py
statistics of columns|.venv/bin/python tests/test_column_statistics.py
END
  $all && cat <<'END'
README's first command|fpm run -- -q cases/sim_I.nml && echo "1 passed, 0 failed"
independent judge of runs|tests/test_judge.py
many extreme scenes|tests/judge/extremes --scenes 240 --seed 5 --evaluations 100000 --judged 48 --limit 120 --known tests/judge/known_findings.csv --quiet
Fortran tests, release build|fpm @release_tests
address sanitizer|tests/test_sanitized.sh
END
}
stages | run_stages

# Everything that computes once more with other roundings of sine, exponential and the like, as other processors have them: with those
# that the C library keeps for processors without AVX2, and with some results changed by one unit in the last place.
if $all; then
  cc -O1 -fno-builtin -shared -fPIC -o "$work/rounding.so" tests/rounding.c -ldl -lm || exit 1
  for rounding in GLIBC_TUNABLES=glibc.cpu.hwcaps=-AVX2_Usable,-FMA_Usable,-AVX2,-FMA "LD_PRELOAD=$work/rounding.so"; do
    stages | grep -v -e '^manual|' -e '^pages of' -e '^build scripts|' -e '^layers' -e '^failures' -e '^random' -e '^address' -e '^README' |
      sed "s#|#, with ${rounding%%=*}|env $rounding #" | run_stages
  done
fi

LC_ALL=C awk '{ passed += $1; failed += $2 + $3 } END { print passed " passed, " failed " failed"; exit failed > 0 }' "$work/counts"
