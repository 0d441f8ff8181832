#!/bin/sh
# Tests of scripts/build.sh: source files that are moved, and objects of an earlier build that make the build fail; and whether the
# programs of scripts/bench compile. The test uses a small separate project. Run from the top of the checkout; ends with the line
# "N passed, N failed".
. scripts/setup.sh || { echo "0 passed, 1 failed"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0
failed=0

check() {   # check NAME COMMAND...: the command must succeed
  name=$1
  shift
  if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $name"; fi
}

source_with() {   # source_with FOLDER NUMBER: put the module's file, with this number, into this folder only
  rm -rf "$work/src/one" "$work/src/other"
  mkdir -p "$work/src/$1"
  printf 'module shown\n  implicit none\n  integer, parameter :: number = %s\nend module shown\n' "$2" >"$work/src/$1/shown.f90"
}

mkdir -p "$work/src" "$work/tests"
cp -r scripts "$work/scripts"
rm -rf "$work/scripts/bench/build"
cp fpm.toml fpm.rsp "$work"
sed -i '/^\[\[test\]\]/,$d' "$work/fpm.toml"
printf 'program main\n  use shown, only: number\n  implicit none\n  print "(i0)", number\nend program main\n' >"$work/src/main.f90"

source_with one 1
program=$(cd "$work" && scripts/build.sh)
check "a program is built, $program" [ "$("$work/$program")" = 1 ]
source_with other 2
program=$(cd "$work" && scripts/build.sh)
check "a source file moved and changed" [ "$("$work/$program")" = 2 ]
source_with one 1
program=$(cd "$work" && scripts/build.sh)
check "a source file moved back unchanged" [ "$("$work/$program")" = 1 ]
chmod -x "$work/$program" && : >"$work/$program"
program=$(cd "$work" && scripts/build.sh)
check "a link that was interrupted" [ "$("$work/$program")" = 1 ]
portable=$program
program=$(cd "$work" && scripts/build.sh --native)
check "a program for this processor, $program" [ "$("$work/$program")" = 1 ]
check "it is built with other options, in a folder of its own" [ "$program" != "$portable" ]
installed=$(cd "$work" && scripts/install.sh --native "$work/into" 2>/dev/null)
check "it is installed" cmp -s "$(printf '%s\n' "$installed" | head -n 1)" "$work/$program"
check "an unknown option of the installation" [ "$(cd "$work" && scripts/install.sh --other 2>&1; echo $?)" = "install: usage: scripts/install.sh [--native] [DIR]
2" ]

# an fpm that fails while objects of an earlier build exist
mkdir "$work/bin"
cat >"$work/bin/fpm" <<'END'
#!/bin/sh
[ "$1" = --version ] && exit 0
echo x >>calls
[ -e build/gfortran_left ] && echo "x.o: multiple definition of \`y'" && exit 1
mkdir -p build/gfortran_new/app && touch build/gfortran_new/app/gudgeon && chmod +x build/gfortran_new/app/gudgeon
echo build/gfortran_new/app/gudgeon
END
chmod +x "$work/bin/fpm"
mkdir "$work/build/gfortran_left"
program=$(cd "$work" && PATH="$work/bin:$PATH" scripts/build.sh)
check "a build that failed is repeated, $program" [ "$program" = build/gfortran_new/app/gudgeon ]
check "a build that failed is repeated once" [ "$(wc -l <"$work/calls")" = 2 ]
check "a program that does not exist" [ "$(cd "$work" && PATH="$work/bin:$PATH" scripts/build.sh nothing 2>/dev/null; echo $?)" = 1 ]
sed -i 's/\[ -e build.gfortran_left \]/true/' "$work/bin/fpm"
program=$(cd "$work" && PATH="$work/bin:$PATH" scripts/build.sh 2>"$work/err")
check "a build that fails again is not repeated" [ "$program" = "" -a "$(wc -l <"$work/calls")" = 5 ]
check "a build that fails has a message" grep -q "build: cannot build gudgeon" "$work/err"

# the programs of scripts/bench, with the modules of the strict build: whether they compile; they are built where they measure
modules=$(ls -t build/gfortran_*/absolute_coordinates.mod | head -n 1)
mkdir "$work/modules"
# shellcheck disable=SC2046  # names of files
check "the programs that measure compile" gfortran -fsyntax-only -fimplicit-none -std=f2008 -J "$work/modules" \
  -I "$(dirname "$modules")" $(grep -l '^module' scripts/bench/*.f90) tests/state_watcher.f90 tests/absolute_gas_engine.f90 \
  $(grep -L '^module' scripts/bench/*.f90) tests/integrator_battery.f90 tests/absolute_run.f90

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
