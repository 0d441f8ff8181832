#!/bin/sh
# Runs case files with the release build, in parallel on all processor cores. Prints one line for each case when it ends, then a
# table.
#
#   scripts/run_cases.sh [-o DIR] [-j N] [-s GROUP.KEY=VALUE] CASE.nml|FOLDER...      (options are passed to gudgeon)
#   scripts/run_cases.sh cases                     the simulations of chapter 6 of the dissertation, which are in cases/ itself
#   scripts/run_cases.sh cases/flores              the cases of Flores's benchmark (appendix B)
#
# The exit status is that of gudgeon: not 0 if any case failed.
cd "$(dirname "$0")/.." || exit 1

out=results
previous=
for argument in "$@"; do
  shift
  case $argument in --out=*) out=${argument#--out=} ;; esac
  case $previous in -o | --out) out=$argument; set -- "$@" "$argument" ;;
    *) if [ -d "$argument" ]; then set -- "$@" "$argument"/*.nml; else set -- "$@" "$argument"; fi ;;
  esac
  previous=$argument
done

program=$(scripts/build.sh) || exit 1
"$program" "$@"
status=$?
[ "$status" = 2 ] && exit 2

number() {   # number FORMAT QUANTITY: prints a value of $summary; prints nothing if the summary lacks it
  found=$(value "$2" "$summary")
  [ -z "$found" ] || printf "$1" "$found"
}

value() { sed -n "s/^$1,\([^,]*\),.*/\1/p" "$2"; }   # value QUANTITY SUMMARY: prints a value of a summary

printf '\n%-24s %9s %9s %12s %12s %11s %10s %9s  %s\n' case contacts contact 'min film' 'peak pin' 'mean speed' residual \
  time status
printf '%-24s %9s %9s %12s %12s %11s %10s %9s\n' '' '' fraction m 'force N' rad/s '' s
for argument in "$@"; do
  case $argument in *.nml) ;; *) continue ;; esac
  name=$(basename "$argument" .nml)
  summary=$out/$name.summary.csv
  if [ ! -f "$summary" ]; then
    printf '%-24s no result\n' "$name"
    continue
  fi
  printf '%-24s %9s %9s %12s %12.4e %11.3f %10.1e %9.2f  %s\n' "$name" "$(value contacts "$summary")" \
    "$(number %.4f contact_time_fraction)" "$(number %.4e min_film_thickness)" \
    "$(value max_pin_force "$summary")" "$(value mean_crank_speed "$summary")" \
    "$(value max_energy_residual_relative "$summary")" "$(value wall_time "$summary")" \
    "$(sed -n '/^status,/{s/^status,"\{0,1\}//;s/"\{0,1\},$//;p;}' "$summary")"
  [ -n "$(value crank_pin_contacts "$summary")" ] && printf '%-24s %9s %9s %12s %12s\n' '  its crank pin' \
    "$(value crank_pin_contacts "$summary")" "$(number %.4f crank_pin_contact_time_fraction)" \
    "$(number %.4e crank_pin_min_film_thickness)" "$(number %.4e crank_pin_max_pin_force)"
done
exit $status
