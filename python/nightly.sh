#!/usr/bin/env bash
# What takes too long or too much space for every change: the tests with Stable-Baselines3 and with MuJoCo's
# simulators, the pages and the benches, each in an environment of its own, on the wheel as it is published. About 6 GB.
#
#   TLTL_TORCH_INDEX   an index with smaller builds of PyTorch, those without CUDA
#   TLTL_NIGHTLY       where the environments are made; a new directory, if left out
set -euo pipefail
cd "$(dirname "$0")"
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_QUIET=1
place="${TLTL_NIGHTLY:-$(mktemp -d)}"

step() { printf '\n== nightly: %s (%s s)\n' "$*" "$SECONDS"; }

# An environment called $1 with the wheel and these packages.
environment() {
    local name="$1"
    shift
    [ -x "$place/$name/bin/python" ] || python3 -m venv "$place/$name"
    "$place/$name/bin/pip" install pytest "$@"
    "$place/$name/bin/pip" install --force-reinstall --no-deps "$place"/dist/tltl-*.whl
}

# The tests beside the wheel: the sources in this directory have no compiled part of it.
tests() {
    local name="$1"
    shift
    cp -r tests README.md "$place/$name/"
    (cd "$place/$name" && bin/python -m pytest -q -rs -p no:cacheprovider --import-mode=append "$@")
}

step "the wheel"
python3 -m venv "$place/build"
"$place/build/bin/pip" install 'maturin>=1.9,<2'
rm -rf "$place/dist"
"$place/build/bin/maturin" build --release --quiet --out "$place/dist"
ls -l "$place/dist"

step "an empty environment"
environment empty 'numpy>=1.26'
"$place/empty/bin/tltlc" --version
"$place/empty/bin/python" -c 'import tltl; print(tltl.Task("F a && F b ensuring !c").explain())'

step "simulators"
environment robotics 'gymnasium-robotics>=1.4' 'mujoco<3.12'
tests robotics tests/test_mujoco.py

step "Stable-Baselines3"
if [ -n "${TLTL_TORCH_INDEX:-}" ]; then
    environment sb3 numpy
    "$place/sb3/bin/pip" install torch --index-url "$TLTL_TORCH_INDEX"
fi
environment sb3 stable-baselines3 sb3-contrib
tests sb3 tests/test_sb3.py tests/test_readme.py

step "pages"
environment docs sphinx myst-nb furo gymnasium
"$place/docs/bin/sphinx-build" -q -W --keep-going -b html docs "$place/html"

step "benches"
environment benches 'gymnasium>=1.1'
(cd "$place/benches" && bin/python "$OLDPWD/benches/bench.py")

step "done"
env -u PIP_QUIET "$place/sb3/bin/pip" list | grep -iE 'torch|baselines|gymnasium|numpy'
