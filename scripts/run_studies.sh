#!/bin/sh
# Runs the shipped studies with the release build, draws them and prints what they say: when a film carries the pin, what
# the mechanism settles to, what restitution and contact laws change, which parameters the films depend on.
#
#   scripts/run_studies.sh [-o DIR] [-j N] [--fresh]     threads; forget what was run before
#
# Results, tables and pictures are in DIR (default: results/studies). Goes on where it was interrupted.
cd "$(dirname "$0")/.." || exit 1
scripts/setup.sh --studies || exit 1

out=results/studies
options=
while [ $# -gt 0 ]; do
  case $1 in
    -o) out=$2; shift ;;
    -j) options="$options --jobs $2"; shift ;;
    --fresh) options="$options --fresh" ;;
    *) echo "run_studies: usage: scripts/run_studies.sh [-o DIR] [-j N] [--fresh]" >&2; exit 2 ;;
  esac
  shift
done

program=$(scripts/build.sh) || exit 1

status=0
for study in map_I map_IV map_I_oscillating map_IV_oscillating bifurcation_clearance bifurcation_speed restitution contact_laws; do
  more=
  case $study in bifurcation_*) more='-s run.lyapunov_revolutions=20' ;; esac   # which colours the picture
  # shellcheck disable=SC2086  # options are words
  "$program" sweep -o "$out" $options $more "cases/studies/$study.nml" || status=$?
done
scripts/plot_study.py --results "$out" --format png --format svg || status=1

sensitivity() {   # sensitivity STUDY OUTPUT...
  study=$1
  shift
  # shellcheck disable=SC2086  # options are words
  scripts/sensitivity.py --program "$program" --out "$out/sensitivity" $options --convergence \
    "cases/studies/$study.nml" --outputs "$@" || status=1
}
sensitivity sensitivity_I log:min_film_thickness contact_time_fraction
sensitivity sensitivity_IV log:min_film_thickness contact_time_fraction
sensitivity sensitivity_I_oscillating min_film_thickness contact_time_fraction
sensitivity sensitivity_IV_oscillating min_film_thickness contact_time_fraction
exit $status
