#!/bin/sh
# The Adams method side by side with what a published Shampine-Gordon code needed on the same scenes: evaluations
# and errors at four tolerances. The references are integrated first, by a copy that computes in 80 bits.
cd "$(dirname "$0")/.." || exit 1
. scripts/setup.sh || exit 1
set -e
copy=build/extended_precision
mkdir -p "$copy"
cp -rp fpm.toml src tests cases "$copy"
sed -i 's/dp = real64 .*/dp = selected_real_kind(18)/' "$copy/src/base/kinds.f90"
(cd "$copy" && fpm run --profile release --example integrator_battery -- reference) | grep '^[0-9]  ' >build/references.txt
fpm run --profile release --example integrator_battery -- scenes build/references.txt | grep -v '^\[\|^Project'
