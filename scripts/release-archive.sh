#!/usr/bin/env bash
# Builds a release archive for this machine's platform: dist/sir-VERSION-TARGET.tar.gz with the program, licenses, docs and
# scenes. Needs only Rust.
set -euo pipefail
cd "$(dirname "$0")/.."

version=$(cargo pkgid --package sir | sed 's/.*[@#]//')
target=$(rustc -vV | sed -n 's/^host: //p')
name="sir-$version-$target"

cargo build --release --locked --bin sir
rm -rf "dist/$name"
mkdir -p "dist/$name/scenes"
cp "${CARGO_TARGET_DIR:-target}/release/sir" README.md CHANGELOG.md CITATION.cff LICENSE-MIT LICENSE-APACHE "dist/$name/"
cp -r docs "dist/$name/"
for scene in scenes/*/pipeline.ron; do
    cp -r "$(dirname "$scene")" "dist/$name/scenes/"
done
cp scenes/README.md "dist/$name/scenes/"
# Licenses of all libraries in the program.
cargo tree --package sir --edges normal --prefix none --format '{p} {l}' --locked | sort -u > "dist/$name/LIBRARIES.txt"
tar -czf "dist/$name.tar.gz" -C dist "$name"
echo "dist/$name.tar.gz"
