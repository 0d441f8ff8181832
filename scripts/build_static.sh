#!/bin/sh
# Builds the program without shared libraries, which runs on any Linux of its processor, and prints its path.
#
#   scripts/build_static.sh PATH
[ $# = 1 ] || { echo "build_static: usage: scripts/build_static.sh PATH" >&2; exit 2; }
mkdir -p "$(dirname "$1")" && path=$(cd "$(dirname "$1")" && pwd)/$(basename "$1") || exit 1
cd "$(dirname "$0")/.." || exit 1
. scripts/setup.sh || exit 1

# The runtime of Fortran refers to functions of threads as weak symbols, which a static link would leave at address 0.
flags=-static
for name in __pthread_key_create pthread_key_create pthread_key_delete pthread_getspecific pthread_setspecific pthread_once pthread_self \
  pthread_create pthread_join pthread_mutex_init pthread_mutex_destroy pthread_mutex_lock pthread_mutex_trylock pthread_mutex_unlock \
  pthread_cond_init pthread_cond_destroy pthread_cond_wait pthread_cond_broadcast; do
  flags="$flags -Wl,-u,$name"
done
said=$(fpm @release --link-flag "$flags" --runner echo 2>&1) &&
  found=$(printf '%s\n' "$said" | grep '^build/.*/gudgeon$' | tail -n 1) && cp "$found" "$path" && echo "$path" && exit 0
printf '%s\n' "$said" >&2
exit 1
