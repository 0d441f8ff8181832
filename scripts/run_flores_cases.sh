#!/bin/sh
# Runs the cases of Flores's benchmark (appendix B of the dissertation): dry, with friction, lubricated, ideal. Options are passed
# to gudgeon.
cd "$(dirname "$0")/.." || exit 1
set -- "$@" cases/flores/ideal.nml cases/flores/dry_0010um.nml cases/flores/dry_0100um.nml cases/flores/dry_0500um.nml \
  cases/flores/friction_010.nml cases/flores/friction_050.nml cases/flores/friction_100.nml \
  cases/flores/lubricated_400cP.nml
exec scripts/run_cases.sh "$@"
