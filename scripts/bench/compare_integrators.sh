#!/bin/sh
# Compares the program's integrators with public codes on the program's own right-hand side, coordinates and scales: SciPy's DOP853,
# Radau and LSODA, SUNDIALS CVODE (Debian: apt-get install libsundials-dev) and Hairer's RADAU5 as compiled in the R package deSolve
# (apt-get install --no-install-recommends r-cran-desolve). The last two are left out if they are not installed.
#
#   scripts/bench/compare_integrators.sh [DIR]                writes DIR/integrators.md, .csv, .png, .svg (default: data/measured)
#   scripts/bench/compare_integrators.sh [DIR] --compiled     measures all but SciPy again
#   scripts/bench/compare_integrators.sh [DIR] --draw         measures nothing, draws the picture again from DIR/integrators.csv
#
# With --language pt the picture has Portuguese texts. The comparison takes about three minutes of processor time, including one
# minute for the build. Other programs that run on the machine make the times too long; the numbers of evaluations depend on the
# compiler only.
cd "$(dirname "$0")/../.." || exit 1
scripts/setup.sh --python || exit 1
options=
part=
out=data/measured
while [ $# -gt 0 ]; do
  case $1 in
    --compiled | --draw) part=$1 ;;
    --language)
      options="--language ${2-}"
      [ $# -gt 1 ] && shift
      ;;
    -*)
      echo "compare_integrators: usage: scripts/bench/compare_integrators.sh [DIR] [--compiled|--draw] [--language pt]" >&2
      exit 2
      ;;
    *) out=$1 ;;
  esac
  shift
done
mkdir -p "$out" || exit 5
# shellcheck disable=SC2086  # options or nothing
[ "$part" = --draw ] && exec .venv/bin/python scripts/bench/compare_integrators.py "$out" --draw $options
scripts/bench/build_scene_library.sh >&2 || exit 1
folder=build/scene_library
if [ -e /usr/include/cvode/cvode.h ]; then
  cc -O2 -shared -fPIC scripts/bench/scene_library/cvode_run.c -o $folder/cvode_run.so -lsundials_cvode -lsundials_nvecserial \
    -lsundials_sunmatrixdense -lsundials_sunlinsoldense -lm || exit 1
else
  rm -f $folder/cvode_run.so
  echo "compare_integrators: CVODE is not installed and is left out (apt-get install libsundials-dev)" >&2
fi
desolve=/usr/lib/R/site-library/deSolve/libs
if [ -e $desolve/deSolve.so ]; then
  cc -O2 -shared -fPIC scripts/bench/scene_library/radau5_run.c -o $folder/radau5_run.so $desolve/deSolve.so -Wl,--disable-new-dtags,-rpath,$desolve:/usr/lib/R/lib \
    -Wl,--allow-shlib-undefined -lm || exit 1
else
  rm -f $folder/radau5_run.so
  echo "compare_integrators: RADAU5 is not installed and is left out (apt-get install --no-install-recommends r-cran-desolve)" >&2
fi
# shellcheck disable=SC2086  # options or nothing
exec .venv/bin/python scripts/bench/compare_integrators.py "$out" $part $options
