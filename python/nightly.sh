#!/usr/bin/env bash
# What takes too long or too much space for every change: the tests with Stable-Baselines3, with RLlib on Ray and
# with MuJoCo's simulators, the oldest NumPy, the pages and the benches, each in an environment of its own, on the
# wheel as it is published. About 7 GB.
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

# The tests beside the wheel: the sources in this directory have no compiled part of it. Rows of test data are
# where they are in the repository.
tests() {
    local name="$1"
    shift
    cp -r tests examples README.md "$place/$name/"
    mkdir -p "$place/tests" && cp -r ../tests/data "$place/tests/"
    (cd "$place/$name" && PYTHONPATH=examples:tests bin/python -m pytest -q -rs -p no:cacheprovider --import-mode=append "$@")
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

step "the oldest NumPy, and the wheel's ABI"
environment oldest 'numpy==1.26.0' 'gymnasium>=1.1' hypothesis cloudpickle networkx
tests oldest tests/test_task.py tests/test_arrays.py tests/test_solve.py tests/test_gymnasium.py tests/test_products.py
"$place/build/bin/pip" install abi3audit
"$place/build/bin/abi3audit" --strict "$place"/dist/tltl-*.whl

step "the source distribution builds from itself"
"$place/build/bin/maturin" sdist --out "$place/sdist"
python3 -m venv "$place/from-source"
"$place/from-source/bin/pip" install "$place"/sdist/tltl-*.tar.gz
"$place/from-source/bin/tltlc" --version

step "simulators and recorded data"
environment robotics 'gymnasium-robotics>=1.4' 'mujoco<3.12' 'minari[create,hdf5]'
tests robotics tests/test_mujoco.py examples/test_examples.py -k 'mujoco or arm or kitchen or recorded'

step "Stable-Baselines3"
if [ -n "${TLTL_TORCH_INDEX:-}" ]; then
    environment sb3 numpy
    "$place/sb3/bin/pip" install torch --index-url "$TLTL_TORCH_INDEX"
fi
environment sb3 stable-baselines3 sb3-contrib
"$place/sb3/bin/pip" install minigrid
tests sb3 tests/test_sb3.py tests/test_readme.py examples/test_examples.py

step "RLlib on Ray"
environment rllib 'ray[rllib]' minigrid
echo "$(echo "$place"/sb3/lib/python*/site-packages)" > "$(echo "$place"/rllib/lib/python*/site-packages)/torch.pth"
tests rllib tests/test_rllib_contract.py examples/test_examples.py -k 'rllib or runner or travel or wrong or trains'

step "pages"
environment docs sphinx myst-nb furo gymnasium
"$place/docs/bin/sphinx-build" -q -W --keep-going -b html docs "$place/html"

step "benches"
environment benches 'gymnasium>=1.1'
(cd "$place/benches" && bin/python "$OLDPWD/benches/bench.py")

step "done"
env -u PIP_QUIET "$place/sb3/bin/pip" list | grep -iE 'torch|baselines|gymnasium|numpy'
