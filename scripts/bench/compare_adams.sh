#!/bin/sh
# scripts/bench/compare_adams.sh [scenes | standard | coordinates]
# Compares the Adams method with a published Shampine-Gordon code: first on the standard battery of non-stiff problems, then on scenes
# of the program (evaluations and errors at five tolerances); last the accuracy of the eccentricity in several coordinates. The
# references are integrated first, by a copy of the program that computes with 80 bits. The output is Markdown;
# scripts/bench/record.py compare_adams "Adams method" scripts/bench/compare_adams.sh writes it to data/measured/compare_adams.md.
cd "$(dirname "$0")/../.." || exit 1
set -e
copy=build/extended_precision
reference() {   # reference WHAT FILE
  program=$copy/$("$copy/scripts/build.sh" integrator_battery) || exit 1
  "$program" "$1" >"$2.new"
  grep '^[0-9]* .*E' "$2.new" >"$2"
  rm "$2.new"
}
table() {   # table WHAT [FILE]: indented, which Markdown shows as it is
  program=$(scripts/build.sh integrator_battery) || exit 1
  "$program" "$@" >build/table.txt
  sed 's/^/    /;s/ *$//' build/table.txt
}
if [ "$1" != coordinates ]; then
  mkdir -p "$copy"
  cp -rp fpm.toml fpm.rsp src tests cases scripts "$copy"
  sed -i 's/dp = real64 .*/dp = selected_real_kind(18)/' "$copy/src/base/kinds.f90"
fi
if [ "$1" != scenes ] && [ "$1" != coordinates ]; then
  reference standard_reference build/standard_references.txt
  cat <<'END'
## Standard problems

The non-stiff problems of Hull, Enright, Fellen and Sedgwick (1972). "error/tol" is the largest |difference| / (1 + |y|) from the
reference at 20 instants over the tolerance, "by condition" the same over the factor by which the problem itself magnifies a change of its
state. "local" are the errors of each step by itself, over the tolerance: the largest of a step, the largest over the length of its
step, and the share of the steps in which it exceeds the tolerance ("deceived"). "stability-bound" is the share of the steps whose
length is limited by stability, "mean h rho" the mean product of step and stiffness.

END
  table standard build/standard_references.txt
  echo
fi
if [ "$1" != standard ] && [ "$1" != coordinates ]; then
  reference reference build/references.txt
  cat <<'END'
## Scenes

Evaluations and largest relative error of the state at the end of the run, and error of the eccentricity ratio, beside those of a
published Shampine-Gordon code in the same equations. "ratio" is evaluations over its evaluations.

END
  table scenes build/references.txt
  echo
fi
if [ -z "$1" ] || [ "$1" = coordinates ]; then
  cat <<'END'
## Coordinates

The largest error of the eccentricity ratio, and the evaluations, in half a revolution: in the program's own coordinates (crank angle
q and eccentricity e) and in absolute ones (crank angle q, rod angle A and piston position x), whose tolerances go by the size of
each coordinate or by the clearance.

END
  table coordinates
fi
