#!/bin/sh
# The program's methods beside public codes on its own right-hand side, in its own coordinates and scales: SciPy's DOP853, Radau and
# LSODA, SUNDIALS CVODE (Debian: apt-get install libsundials-dev; left out where it is missing).
#
#   scripts/compare_integrators.sh [DIR]                writes DIR/integrators.md, .csv and .png (default: data/measured)
#   scripts/compare_integrators.sh [DIR] --compiled     measures only the program's own methods and CVODE anew
#   scripts/compare_integrators.sh [DIR] --draw         measures nothing: draws the picture again, from DIR/integrators.csv
#
# With --language pt the texts of the picture are Portuguese. Takes about three minutes of processor time, one of them to build, and
# asks nothing. Other programs on the machine falsify the times; evaluations are the same on any machine with this compiler.
cd "$(dirname "$0")/.." || exit 1
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
      echo "compare_integrators: usage: scripts/compare_integrators.sh [DIR] [--compiled|--draw] [--language pt]" >&2
      exit 2
      ;;
    *) out=$1 ;;
  esac
  shift
done
mkdir -p "$out" || exit 5
# shellcheck disable=SC2086  # options or nothing
[ "$part" = --draw ] && exec .venv/bin/python scripts/compare_integrators.py "$out" --draw $options
scripts/build_scene_library.sh >&2 || exit 1
folder=build/scene_library
if [ -e /usr/include/cvode/cvode.h ]; then
  cc -O2 -shared -fPIC scripts/scene_library/cvode_run.c -o $folder/cvode_run.so -lsundials_cvode -lsundials_nvecserial \
    -lsundials_sunmatrixdense -lsundials_sunlinsoldense -lm || exit 1
else
  rm -f $folder/cvode_run.so
  echo "compare_integrators: no CVODE: apt-get install libsundials-dev" >&2
fi
# shellcheck disable=SC2086  # options or nothing
exec .venv/bin/python scripts/compare_integrators.py "$out" $part $options
