#!/bin/sh
# The methods adams, radau and auto side by side on the shipped scenes: error against evaluations and wall time at
# tolerances 1e-3 to 1e-12, as a table and a picture.
#
#   scripts/compare_integrators.sh [DIR]      writes DIR/integrators.csv, .png and .svg (default: results)
#
# Takes about a minute, nearly all of it Adams in stiff films.
cd "$(dirname "$0")/.." || exit 1
scripts/setup.sh --python || exit 1
out=${1:-results}
mkdir -p "$out" || exit 5
program=$(scripts/build.sh integrator_comparison) || exit 1
"$program" >"$out/integrators.csv.part" || exit 1
mv "$out/integrators.csv.part" "$out/integrators.csv"
exec .venv/bin/python scripts/compare_integrators.py "$out/integrators.csv"
