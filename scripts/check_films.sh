#!/bin/sh
# Compares the film of finite length with the tables of an independent solver (data/film), release build; see check_films.f90.
#
#   scripts/check_films.sh               the solver at its three levels (a minute)
#   scripts/check_films.sh 33 64         tables of 33 values in each direction, solved with 64 nodes
#   scripts/check_films.sh 65 192 0.75 reynolds     of one bearing and condition alone
cd "$(dirname "$0")/.." || exit 1
exec "$(scripts/build.sh check_films)" "$@"
