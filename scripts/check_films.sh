#!/bin/sh
# Compares the forces of the film of finite length with tables from an independent solver (data/film); release build; see
# check_films.f90.
#
#   scripts/check_films.sh                          the program's solver at its three accuracy levels (a minute)
#   scripts/check_films.sh 33 64                    force tables of 33 values in each direction, solved with 64 nodes
#   scripts/check_films.sh 65 192 0.75 reynolds     the same for one bearing (L/D = 0.75) and one cavitation condition
cd "$(dirname "$0")/.." || exit 1
exec "$(scripts/build.sh check_films)" "$@"
