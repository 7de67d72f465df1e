#!/usr/bin/env bash
# Runs all tests, including those with several processes, and those with third-party data where these are. Arguments are
# passed to `cargo test`.
set -euo pipefail
cd "$(dirname "$0")/.."
tests/install-needs.sh
cargo test --workspace --features mpi "$@"
data=${SIR_TEST_DATA:-../shared}
if [ -d "$data/scenes" ] && [ -d "$data/corpus" ]; then
    SIR_TEST_DATA=$(realpath "$data") cargo test -p sir -p sir-geom --features mpi --tests -- --ignored
else
    echo "Tests with third-party data were not run: there are none in $data (SIR_TEST_DATA sets another folder)."
fi
