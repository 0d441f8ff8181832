#!/bin/sh
# Runs the shipped parameter studies with the fast program, draws their pictures and prints their results. The studies find where a
# film carries the pin without contact, which motion the mechanism settles to, what restitution and contact laws change, and which
# parameters determine film thickness and contact.
#
#   scripts/run_studies.sh [-o DIR] [-j N] [--fresh]     -j: number of processes; --fresh: discard the runs of an earlier call
#
# Results, tables and pictures are in DIR (default: results/studies); the numbers are written to data/measured/studies.md and
# data/measured/sensitivity.md. If the script is interrupted, the same command continues it.
cd "$(dirname "$0")/.." || exit 1
scripts/setup.sh --studies || exit 1
PATH="$PWD/.venv/bin:$PATH"

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
for study in map_I map_IV map_I_oscillating map_IV_oscillating bifurcation_clearance bifurcation_speed restitution contact_laws \
  pin_ticking pin_sliding offset_crank; do
  more=
  case $study in bifurcation_*) more='-s run.lyapunov_revolutions=20' ;; esac   # for the colours of the picture
  # shellcheck disable=SC2086  # options are words
  "$program" sweep -o "$out" $options $more "cases/studies/$study.nml" || status=$?
done
gudgeon-plot study --results "$out" --format png --format svg || status=1
gudgeon-plot study "$out/pin_ticking.runs.csv" --format png --format svg --columns small_end_eccentricity_rate_x_max_abs small_end_min_film_thickness \
  --title "A wide clearance ticks; thick oil cures a tight pin, not a worn one" || status=1
gudgeon-plot study "$out/pin_sliding.runs.csv" --format png --format svg --columns pin_speed_rms small_end_asperity_force_max \
  --title "Where asperities carry in the small end, the pin turns with the rod" || status=1
gudgeon-plot study "$out/offset_crank.runs.csv" --format png --format svg --columns guide_force_max_abs guide_friction_power_mean \
  --title "An offset of 9.5 mm has the least side force, one of 14 mm the least friction" || status=1

sensitivity() {   # sensitivity STUDY TITLE OUTPUT...
  study=$1
  title=$2
  shift 2
  # shellcheck disable=SC2086  # options are words
  gudgeon-plot sensitivity --program "$program" -o "$out/sensitivity" --format png --format svg $options --convergence --title "$title" \
    "cases/studies/$study.nml" --outputs "$@" || status=1
}
sensitivity sensitivity_I "Clearance and viscosity decide the thinnest film of simulation I" log:min_film_thickness contact_time_fraction
sensitivity sensitivity_IV "Which parameters decide the thinnest film of simulation IV" log:min_film_thickness contact_time_fraction
sensitivity sensitivity_I_oscillating "With an oscillating film the speed decides, and chance" min_film_thickness contact_time_fraction
sensitivity sensitivity_IV_oscillating "Which parameters decide simulation IV with an oscillating film" min_film_thickness contact_time_fraction
if [ "$status" = 0 ]; then
  scripts/bench/record.py studies "Parameter studies" gudgeon-plot study --results "$out" --numbers || status=1
  scripts/bench/record.py sensitivity "Sensitivity of films and contacts" gudgeon-plot sensitivity --table -o "$out/sensitivity" \
    cases/studies/sensitivity_I.nml cases/studies/sensitivity_IV.nml cases/studies/sensitivity_I_oscillating.nml \
    cases/studies/sensitivity_IV_oscillating.nml || status=1
fi
exit $status
