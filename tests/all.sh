#!/usr/bin/env bash
# Runs all tests, including those with several processes, and those with a browser or third-party data where these are.
# Arguments are passed to `cargo test`.
set -euo pipefail
cd "$(dirname "$0")/.."
tests/install-needs.sh
cargo test --workspace --features mpi "$@"
browser=${SIR_BROWSER:-$(command -v chromium || command -v chromium-browser || command -v google-chrome || true)}
if [ -n "$browser" ]; then
    SIR_BROWSER=$browser cargo test -p sir --features mpi --test browser -- --ignored
    if command -v npm >/dev/null && (cd examples/three && npm ci --silent --no-audit --no-fund); then
        SIR_BROWSER=$browser cargo test -p sir --features mpi --test lightmap_browser -- --ignored
    else
        echo "Tests of lightmaps in a browser were not run: npm does not install three.js in examples/three."
    fi
else
    echo "Tests of pages in a browser were not run: there is no Chromium (SIR_BROWSER sets its command)."
fi
data=${SIR_TEST_DATA:-../shared}
if [ -d "$data/scenes" ] && [ -d "$data/corpus" ]; then
    SIR_TEST_DATA=$(realpath "$data") cargo test -p sir -p sir-geom --features mpi --tests -- --ignored --skip in_a_browser
else
    echo "Tests with third-party data were not run: there are none in $data (SIR_TEST_DATA sets another folder)."
fi
