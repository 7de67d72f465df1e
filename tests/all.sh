#!/usr/bin/env bash
# Runs all tests, including those with several processes. Arguments are passed to `cargo test`.
set -euo pipefail
cd "$(dirname "$0")/.."
tests/install-needs.sh
exec cargo test --workspace --features mpi "$@"
