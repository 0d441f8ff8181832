#!/bin/sh
# Compares the forces of the film of finite length with tables from an independent solver (data/film); release build; see
# check_films.f90.
#
#   scripts/bench/check_films.sh                          the program's solver at its three accuracy levels (a minute)
#   scripts/bench/check_films.sh 33 64                    force tables of 33 values in each direction, solved with 64 nodes
#   scripts/bench/check_films.sh 65 192 0.75 reynolds     the same for one bearing (L/D = 0.75) and one cavitation condition
#   scripts/bench/check_films.sh tables                   force tables as the accuracy levels make them (half a minute)
#
# scripts/bench/record.py film_accuracy "..." scripts/bench/check_films.sh and scripts/bench/record.py film_tables "..." scripts/bench/check_films.sh tables
# write data/measured/film_accuracy.md and data/measured/film_tables.md.
cd "$(dirname "$0")/../.." || exit 1
program=$(scripts/build.sh check_films) || exit 1
if [ $# = 0 ]; then
  cat <<'END'
Worst relative errors of the film of finite length against all rows of `data/film/phi_LD*.csv` (up to eps = 0.99, and the force at 0.999
too), by nodes round the film: 64 draft, 128 standard, 192 reference. Table 0: the equation is solved in every row.

END
fi
if [ "$1" != tables ]; then
  exec "$program" "$@"
fi
cat <<'END'
Worst relative errors of the tables of the law `finite_bearing`, interpolated, against all rows of `data/film/phi_LD*.csv` (up to eps = 0.99,
and the force at 0.999 too). "table, nodes": values in each direction, nodes round the film of the solutions that are tabulated. The levels
draft (33 values from 64 nodes), standard (Reynolds 65 from 128, Gumbel 97 from 128) and reference (Reynolds 65, Gumbel 97, from 192; with
Reynolds' condition two bearings); Gumbel with 65 values for comparison.

END
lines=1   # of the first comparison also the head of the table
for bearing in 0.25 0.5 0.75 1 2; do
  for values in "33 64 $bearing gumbel" "65 128 $bearing gumbel" "97 128 $bearing gumbel" "97 192 $bearing gumbel" \
    "33 64 $bearing reynolds" "65 128 $bearing reynolds"; do
    # shellcheck disable=SC2086  # four words
    "$program" $values | tail -n "+$lines"
    lines=3
  done
done
for bearing in 0.5 0.75; do
  "$program" 65 192 "$bearing" reynolds | tail -n 1   # with the mean of four grids
done
