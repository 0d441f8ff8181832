#!/bin/sh
# scripts/compare_adams.sh [scenes | standard | coordinates]
# Compares the Adams method with a published Shampine-Gordon code: first on the standard battery of non-stiff problems, then on scenes
# of the program (evaluations and errors at four tolerances); last the accuracy of the eccentricity in several coordinates. The
# references are integrated first, by a copy of the program that computes with 80 bits.
cd "$(dirname "$0")/.." || exit 1
set -e
copy=build/extended_precision
mkdir -p "$copy"
cp -rp fpm.toml fpm.rsp src tests cases scripts "$copy"
sed -i 's/dp = real64 .*/dp = selected_real_kind(18)/' "$copy/src/base/gudgeon_kinds.f90"
reference() {   # reference WHAT FILE
  "$copy/$("$copy/scripts/build.sh" integrator_battery)" "$1" | grep '^[0-9]* .*E' >"$2"
}
table() {   # table WHAT FILE
  "$(scripts/build.sh integrator_battery)" "$1" "$2"
}
if [ "$1" = coordinates ]; then
  table coordinates
  exit
fi
if [ "$1" != scenes ]; then
  reference standard_reference build/standard_references.txt
  table standard build/standard_references.txt
fi
if [ "$1" != standard ]; then
  reference reference build/references.txt
  table scenes build/references.txt
fi
[ -n "$1" ] || table coordinates
