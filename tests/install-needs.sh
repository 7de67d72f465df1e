#!/usr/bin/env bash
# Installs the dependencies of the tests with several processes: Open MPI, and libclang to build against it.
# Without the permission to install, it prints the command to run.
set -euo pipefail

packages="openmpi-bin libopenmpi-dev libclang-dev"

has_libclang() {
    [ -n "${LIBCLANG_PATH:-}" ] || ldconfig -p 2>/dev/null | grep -q 'libclang[-.0-9]*\.so' ||
        compgen -G '/usr/lib/llvm-*/lib/libclang[-.]*so*' >/dev/null ||
        compgen -G '/opt/homebrew/opt/llvm/lib/libclang.dylib' >/dev/null
}

if command -v mpirun >/dev/null && command -v mpicc >/dev/null && has_libclang; then
    exit 0
fi

if command -v apt-get >/dev/null; then
    as_root=""
    if [ "$(id -u)" != 0 ]; then
        as_root="sudo"
        if ! sudo -n true 2>/dev/null; then
            echo "The tests with several processes need Open MPI and libclang. Please run" >&2
            echo "    sudo apt-get install $packages" >&2
            exit 1
        fi
    fi
    echo "installing $packages"
    $as_root apt-get update -qq
    # shellcheck disable=SC2086 # list of packages
    DEBIAN_FRONTEND=noninteractive $as_root apt-get install -y -qq --no-install-recommends $packages >/dev/null
    exit 0
fi

cat >&2 <<'END'
The tests with several processes need Open MPI (mpirun, mpicc) and libclang. Please install them:
    Fedora:  sudo dnf install openmpi-devel clang-devel && module load mpi
    Arch:    sudo pacman -S openmpi clang
    macOS:   brew install open-mpi llvm
Without them, `cargo test --workspace` runs all other tests.
END
exit 1
