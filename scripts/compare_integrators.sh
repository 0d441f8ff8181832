#!/bin/sh
# The program's methods beside public codes on its own right-hand side, in its own coordinates and scales: SciPy's DOP853, Radau and
# LSODA, SUNDIALS CVODE (Debian: apt-get install libsundials-dev; left out where it is missing).
#
#   scripts/compare_integrators.sh [DIR]                writes DIR/integrators.md, .csv and .png (default: data/measured)
#   scripts/compare_integrators.sh [DIR] --compiled     measures only the program's own methods and CVODE anew
#
# Takes about 15 minutes, most of it Python's. Evaluations are the same on any machine with this compiler; times are the processor's.
cd "$(dirname "$0")/.." || exit 1
scripts/setup.sh --python || exit 1
part=
out=data/measured
for argument; do
  case $argument in
    --compiled) part=--compiled ;;
    -*)
      echo "compare_integrators: usage: scripts/compare_integrators.sh [DIR] [--compiled]" >&2
      exit 2
      ;;
    *) out=$argument ;;
  esac
done
mkdir -p "$out" || exit 5
scripts/build_scene_library.sh >&2 || exit 1
folder=build/scene_library
if [ -e /usr/include/cvode/cvode.h ]; then
  cc -O2 -shared -fPIC scripts/scene_library/cvode_run.c -o $folder/cvode_run.so -lsundials_cvode -lsundials_nvecserial \
    -lsundials_sunmatrixdense -lsundials_sunlinsoldense -lm || exit 1
else
  rm -f $folder/cvode_run.so
  echo "compare_integrators: no CVODE: apt-get install libsundials-dev" >&2
fi
# shellcheck disable=SC2086  # an option or nothing
exec .venv/bin/python scripts/compare_integrators.py "$out" $part
