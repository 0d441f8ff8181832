#!/bin/sh
# Installs the tool chain, gfortran (Debian package) and fpm (PyPI), where it is missing.
#
#   . scripts/setup.sh          from the top of the checkout; also puts fpm on the PATH of the calling shell
#   scripts/setup.sh            the same for scripts and for later shells
#   scripts/setup.sh --python   also makes, in .venv, gudgeon-plot and the Python package gudgeon of scripts/python, with what they need
#   scripts/setup.sh --browser  as --python, and Chromium (Debian packages), which tests/test_report.py and test_explore.py need
#   scripts/setup.sh --studies  also the packages of gudgeon-plot sensitivity, scripts/run_studies.sh and scripts/cluster
#   scripts/setup.sh --manual   also MkDocs and FORD, which scripts/manual.sh needs
#   scripts/setup.sh --lint     also the linters of Fortran and Python
#   scripts/setup.sh --embedding  also what the tests of the library, the Python package and functional mock-up units need
#   scripts/setup.sh --python --manual ...   several of these
#
# Root or sudo is needed only to install Debian packages. fpm and gudgeon-plot are installed in .venv, with links to them in
# /usr/local/bin or ~/.local/bin. This file is POSIX sh; if it is sourced, it changes no option of the calling shell.

gudgeon_apt() {   # install Debian packages, as root or by sudo
  if [ "$(id -u)" = 0 ]; then
    gudgeon_sudo=
  elif command -v sudo >/dev/null 2>&1; then
    gudgeon_sudo=sudo
  else
    echo "setup: $* must be installed (apt-get install $*), which needs root or sudo" >&2
    return 1
  fi
  $gudgeon_sudo apt-get update -qq >&2 &&
    $gudgeon_sudo env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "$@" >&2
}

gudgeon_link() {   # gudgeon_link COMMAND: link a command of .venv into a folder of the PATH, where later shells find it
  for gudgeon_dir in /usr/local/bin "$HOME/.local/bin"; do
    case ":$PATH:" in *":$gudgeon_dir:"*) ;; *) continue ;; esac
    mkdir -p "$gudgeon_dir" 2>/dev/null
    [ -w "$gudgeon_dir" ] && ln -sf "$PWD/.venv/bin/$1" "$gudgeon_dir/$1" && return 0
  done
  echo "setup: $1 is $PWD/.venv/bin/$1; add $PWD/.venv/bin to PATH for later shells" >&2
}

gudgeon_venv() {   # create .venv, a virtual environment of Python, if it is missing
  [ -x .venv/bin/python ] && .venv/bin/python -m pip --version >/dev/null 2>&1 && return 0
  if ! { command -v python3 >/dev/null 2>&1 && python3 -c 'import venv, ensurepip' >/dev/null 2>&1; }; then
    gudgeon_apt python3 python3-venv || return 1
  fi
  python3 -m venv .venv >&2
}

gudgeon_pip() { .venv/bin/python -m pip install --quiet --disable-pip-version-check -c scripts/python/constraints.txt "$@" >&2; }

gudgeon_python() {   # install the packages of these lists, and gudgeon itself as it stands in scripts/python, without a build
  gudgeon_venv && gudgeon_pip "$@" || return 1
  # their paths are relative, so that the path of the clone may have any letters; each file is replaced as a whole, since programs that
  # read it may be starting
  .venv/bin/python -c 'import os, pathlib, sysconfig
def put(path, text, mode):
    part = path.with_name(f"{path.name}.{os.getpid()}")
    part.write_text(text)
    part.chmod(mode)
    part.replace(path)
packages = sysconfig.get_path("purelib")
put(pathlib.Path(packages, "gudgeon.pth"), os.path.relpath("scripts/python/src", packages) + "\n", 0o644)
put(pathlib.Path(".venv/bin/gudgeon-plot"), """#!/bin/sh
exec "$(dirname "$(readlink -f "$0")")/python" -m gudgeon "$@"
""", 0o755)' || return 1
  gudgeon_file=$(command -v gudgeon-plot) || { gudgeon_link gudgeon-plot; return 0; }
  [ "$(readlink -f "$gudgeon_file")" = "$(readlink -f .venv/bin/gudgeon-plot)" ] ||
    echo "setup: gudgeon-plot on the PATH is $gudgeon_file, not of this clone; this one is $PWD/.venv/bin/gudgeon-plot" >&2
}

# fpm 0.12 still links the objects of source files that have been moved or removed, without a message. Therefore all programs are
# built again if a source file of the last set-up is gone.
gudgeon_sources() {
  gudgeon_list=$(find src tests scripts -name '*.f90' -o -path 'src/*.c' | sort)
  [ "$gudgeon_list" = "$(cat build/sources 2>/dev/null)" ] && return 0
  for gudgeon_file in $(cat build/sources 2>/dev/null || echo none); do
    [ -f "$gudgeon_file" ] || { rm -rf build/gfortran_* scripts/bench/build/gfortran_* tests/build/gfortran_*; break; }
  done
  mkdir -p build && printf '%s\n' "$gudgeon_list" >build/sources
}

gudgeon_setup() {
  if [ ! -f fpm.toml ]; then
    echo "setup: run it from the top of the checkout" >&2
    return 1
  fi
  if ! command -v gfortran >/dev/null 2>&1; then
    # gcc and libc6-dev come with gfortran; fpm uses gcc and ar too
    gudgeon_apt gfortran libc6-dev || return 1
  fi
  gudgeon_sources
  if command -v fpm >/dev/null 2>&1 && fpm --version >/dev/null 2>&1; then
    return 0
  fi
  if [ ! -x .venv/bin/fpm ]; then
    gudgeon_venv && gudgeon_pip 'fpm>=0.12,<0.14' || return 1
  fi
  PATH="$PWD/.venv/bin:$PATH"
  export PATH
  hash -r 2>/dev/null
  gudgeon_link fpm
  return 0
}

gudgeon_setup
gudgeon_status=$?
# if this file is sourced, the positional parameters belong to the caller
case "${0##*/} $#" in
  "setup.sh 0") ;;
  setup.sh*)
    gudgeon_packages="-r scripts/python/requirements.txt"
    for gudgeon_option; do
      case "$gudgeon_option" in
        --python) ;;
        --browser)
          if ! { command -v chromium && command -v chromedriver; } >/dev/null 2>&1; then
            gudgeon_apt chromium chromium-driver || gudgeon_status=1
          fi
          ;;
        --studies | --embedding | --manual | --lint)
          gudgeon_packages="$gudgeon_packages -r scripts/python/requirements-${gudgeon_option#--}.txt"
          ;;
        *)
          echo "setup: usage: scripts/setup.sh [--python] [--browser] [--studies] [--manual] [--lint] [--embedding]" >&2
          gudgeon_status=2
          ;;
      esac
    done
    if [ "$gudgeon_status" = 0 ]; then
      # shellcheck disable=SC2086  # options and their values
      gudgeon_python $gudgeon_packages || gudgeon_status=1
    fi
    ;;
esac
unset -f gudgeon_apt gudgeon_link gudgeon_venv gudgeon_pip gudgeon_python gudgeon_sources gudgeon_setup
unset gudgeon_sudo gudgeon_dir gudgeon_packages gudgeon_option gudgeon_list gudgeon_file
# the status of the last command is that of the set-up, whether this file is sourced or run
[ "$gudgeon_status" = 0 ]
