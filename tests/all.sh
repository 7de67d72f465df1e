#!/usr/bin/env bash
# Runs all tests, those with several processes included. Arguments go to `cargo test`.
set -euo pipefail
cd "$(dirname "$0")/.."
tests/install-needs.sh
exec cargo test --workspace --features mpi "$@"
