#!/bin/sh
# Measures the time of one force of the film of finite length, of its force table, and of a whole run (release build; see
# film_costs.f90). To write data/measured/film_costs.md, on a machine that runs nothing else:
#
#   scripts/bench/record.py film_costs "What the film of finite length costs" scripts/bench/film_costs.sh
cd "$(dirname "$0")/../.." || exit 1
program=$(scripts/build.sh film_costs) || exit 1
folder=$(mktemp -d) || exit 1
trap 'rm -rf "$folder"' EXIT
"$program" "$folder"
