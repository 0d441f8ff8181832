#!/bin/sh
# Builds the program with several compilers, runs the Fortran tests of each with every check, and compares the results of all cases,
# byte for byte, with those of the first compiler.
#
#   scripts/bench/compare_compilers.sh gfortran-12 gfortran-14...     names of commands; on Debian: apt-get install gfortran-14
#
# Runs are stopped after 300,000 evaluations. Prints a line for each compiler and the names of the files that differ (rounding may
# differ; a chaotic motion then differs after its horizon). The exit status is 1 if a program cannot be built or a test fails.
cd "$(dirname "$0")/../.." || exit 1
[ $# -gt 0 ] || { sed -n '2,8s/^# \{0,1\}//p' "$0" >&2; exit 2; }
. scripts/setup.sh || exit 1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
trap 'exit 1' HUP INT TERM

first=
status=0
for compiler in "$@"; do
  version=$("$compiler" -dumpfullversion) || exit 1
  export FPM_FC="$compiler"
  program=$(scripts/build.sh) || exit 1
  tests=$(fpm @strict 2>&1 | LC_ALL=C awk '/ passed, / { p += $1; f += $3 } END { if (NR) print p " passed, " f " failed" }')
  case $tests in *' 0 failed') ;; *) status=1 ;; esac
  for group in cases cases/*/; do
    name=$(basename "$group")
    case $name in studies) continue ;; esac
    "$program" -q -o "$folder/$compiler/$name" -s integrator.max_evaluations=300000 "$group"/*.nml 2>"$folder/said"
    [ $? -le 4 ] || { cat "$folder/said" >&2; exit 1; }   # 4: stopped by this limit
  done
  [ -n "$first" ] || first=$compiler
  files=$(cd "$folder/$first" && find . -name '*.csv' ! -name '*.summary.csv' | sort)
  different=$(for file in $files; do cmp -s "$folder/$first/$file" "$folder/$compiler/$file" || echo "$file"; done)
  echo "$compiler ($version): ${tests:-the tests cannot be built}; of $(echo "$files" | wc -l) files $(echo "$different" |
    grep -c .) differ from $first" $different
done
exit $status
