#!/bin/sh
# Runs the twelve simulations of chapter 6 of the dissertation: I to VI, each with the Pinkus-Sternlicht film and with the
# oscillating film. Options are passed to gudgeon (-o DIR, -j N, -s GROUP.KEY=VALUE, ...).
cd "$(dirname "$0")/.." || exit 1
set -- "$@" cases/sim_V.nml cases/sim_VI.nml cases/sim_IV.nml cases/sim_VI_oscillating.nml cases/sim_V_oscillating.nml \
  cases/sim_IV_oscillating.nml cases/sim_III_oscillating.nml cases/sim_II_oscillating.nml cases/sim_I_oscillating.nml \
  cases/sim_III.nml cases/sim_II.nml cases/sim_I.nml
exec scripts/run_cases.sh "$@"
