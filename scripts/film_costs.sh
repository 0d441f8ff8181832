#!/bin/sh
# What the film of finite length costs: a force, its table, a run; release build; see film_costs.f90. On a quiet computer:
#
#   scripts/record.py film_costs "What the film of finite length costs" scripts/film_costs.sh
cd "$(dirname "$0")/.." || exit 1
program=$(scripts/build.sh film_costs) || exit 1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
"$program" "$folder"
