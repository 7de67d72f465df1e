#!/usr/bin/env bash
# Packages each published library and builds it from its package, as `cargo publish` would. Prints the size of each package.
set -euo pipefail
cd "$(dirname "$0")/.."
cargo package --workspace --exclude sir --exclude sir-cli --exclude sir-study --exclude sir-scenes --locked "$@"
ls -l "${CARGO_TARGET_DIR:-target}"/package/sir-*.crate | awk '{ print $5, $NF }'
