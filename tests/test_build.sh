#!/bin/sh
# scripts/build.sh with sources that move, and after a build that fails on what an earlier one has left: in a small project of
# its own. Run from the top of the checkout; ends with the line "N passed, N failed".
. scripts/setup.sh || { echo "0 passed, 1 failed"; exit 1; }
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0
failed=0

check() {   # check NAME CONDITION...: a test command
  name=$1
  shift
  if "$@"; then passed=$((passed + 1)); else failed=$((failed + 1)); echo "FAILED: $name"; fi
}

source_with() {   # source_with FOLDER NUMBER: the module's file stands in this folder alone, with this number
  rm -rf "$work/src/one" "$work/src/other"
  mkdir -p "$work/src/$1"
  printf 'module shown\n  implicit none\n  integer, parameter :: number = %s\nend module shown\n' "$2" >"$work/src/$1/shown.f90"
}

mkdir -p "$work/src" "$work/tests"
cp -r scripts "$work/scripts"
rm -rf "$work/scripts/build"
cp fpm.toml fpm.rsp "$work"
sed -i '/^\[\[test\]\]/,$d' "$work/fpm.toml"
printf 'program main\n  use shown, only: number\n  implicit none\n  print "(i0)", number\nend program main\n' >"$work/src/main.f90"

source_with one 1
program=$(cd "$work" && scripts/build.sh)
check "a program, $program" [ "$("$work/$program")" = 1 ]
source_with other 2
program=$(cd "$work" && scripts/build.sh)
check "a file moved and changed" [ "$("$work/$program")" = 2 ]
source_with one 1
program=$(cd "$work" && scripts/build.sh)
check "and moved back as it was" [ "$("$work/$program")" = 1 ]

# an fpm that fails while what an earlier build has left is there
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
check "built once more, $program" [ "$program" = build/gfortran_new/app/gudgeon ]
check "in two calls" [ "$(wc -l <"$work/calls")" = 2 ]
sed -i 's/\[ -e build.gfortran_left \]/true/' "$work/bin/fpm"
program=$(cd "$work" && PATH="$work/bin:$PATH" scripts/build.sh 2>"$work/err")
check "what cannot be built is not tried for ever" [ "$program" = "" -a "$(wc -l <"$work/calls")" = 4 ]
check "and said" grep -q "build: cannot build gudgeon" "$work/err"

echo "$passed passed, $failed failed"
[ "$failed" = 0 ]
