#!/usr/bin/env bash
# What takes too long or too much space for every change: the tests with Stable-Baselines3, with RLlib on Ray and
# with MuJoCo's simulators, the oldest NumPy and Gymnasium, the pages and the benches, each in an environment of
# its own, on the wheel as it is published. About 7 GB.
#
# One part does not stop the others: the end says which passed, which failed, and which were skipped, because
# their packages are not to be had here. The exit code is 1 if one failed.
#
#   TLTL_TORCH_INDEX   an index with smaller builds of PyTorch, those without CUDA
#   TLTL_NIGHTLY       where the environments are made; a new directory, if left out
#   TLTL_TABLES        if it is set, DoorKey is learned again for the table in the pages: 45 times 30,000 steps
set -euo pipefail
cd "$(dirname "$0")"
export PIP_DISABLE_PIP_VERSION_CHECK=1 PIP_QUIET=1
place="${TLTL_NIGHTLY:-$(mktemp -d)}"
passed=() failed=() skipped=()

# What a part ends with if it cannot be run here.
CANNOT=77

# Runs a part, which is a function, and notes how it ended.
part() {
    local name="$1" rc=0
    shift
    printf '\n== nightly: %s (%s s)\n' "$name" "$SECONDS"
    # Not in a condition, in which bash would go on after an error.
    set +e
    (set -e; "$@")
    rc=$?
    set -e
    case $rc in
        0) passed+=("$name") ;;
        "$CANNOT") skipped+=("$name") ;;
        *) failed+=("$name") && printf 'failed: %s, with %s\n' "$name" "$rc" ;;
    esac
}

# An environment called $1 with the wheel and these packages.
environment() {
    local name="$1"
    shift
    [ -x "$place/$name/bin/python" ] || python3 -m venv "$place/$name"
    "$place/$name/bin/pip" install pytest "$@" || {
        printf 'skipped: these packages are not to be had here: %s\n' "$*"
        exit "$CANNOT"
    }
    "$place/$name/bin/pip" install --force-reinstall --no-deps "$place"/dist/tltl-*.whl
}

# The tests beside the wheel: the sources in this directory have no compiled part of it. Rows of test data are
# where they are in the repository.
tests() {
    local name="$1"
    shift
    cp -r tests examples docs README.md "$place/$name/"
    mkdir -p "$place/tests" && cp -r ../tests/data "$place/tests/"
    (cd "$place/$name" && PYTHONPATH=examples:tests bin/python -m pytest -q -rs -p no:cacheprovider -W ignore::pytest.PytestUnknownMarkWarning --import-mode=append "$@")
}

wheel() {
    [ -x "$place/build/bin/python" ] || python3 -m venv "$place/build"
    "$place/build/bin/pip" install 'maturin>=1.9,<2'
    rm -rf "$place/dist"
    "$place/build/bin/maturin" build --release --quiet --out "$place/dist"
    ls -l "$place/dist"
}

empty() {
    rm -rf "$place/empty"
    python3 -m venv "$place/empty"
    "$place/empty/bin/pip" install 'numpy>=1.26'
    local TIMEFORMAT='pip install, with NumPy there: %R s'
    time "$place/empty/bin/pip" install --no-index "$place"/dist/tltl-*.whl
    "$place/empty/bin/tltlc" --version
    TIMEFORMAT='the first example: %R s'
    time "$place/empty/bin/python" -c 'import tltl; print(tltl.Task("F a && F b ensuring !c").explain())'
}

oldest() {
    environment oldest 'numpy==1.26.0' 'gymnasium==1.0.0' minigrid hypothesis cloudpickle networkx
    # A tenth of that where it is not optimized.
    TLTL_COMPILATIONS=10000 tests oldest tests examples
    "$place/build/bin/pip" install abi3audit
    "$place/build/bin/abi3audit" --strict "$place"/dist/tltl-*.whl
}

from_source() {
    "$place/build/bin/maturin" sdist --out "$place/sdist"
    rm -rf "$place/from-source"
    python3 -m venv "$place/from-source"
    "$place/from-source/bin/pip" install "$place"/sdist/tltl-*.tar.gz
    "$place/from-source/bin/tltlc" --version
}

robotics() {
    environment robotics 'gymnasium-robotics>=1.4' 'mujoco<3.12' 'minari[create,hdf5]'
    tests robotics tests/test_mujoco.py examples/test_examples.py -k 'reacher or franka or ball or arm or kitchen or recorded'
}

baselines() {
    if [ -n "${TLTL_TORCH_INDEX:-}" ]; then
        environment sb3 numpy
        "$place/sb3/bin/pip" install torch --index-url "$TLTL_TORCH_INDEX"
    fi
    environment sb3 stable-baselines3 sb3-contrib minigrid
    env -u PIP_QUIET "$place/sb3/bin/pip" list | grep -iE 'torch|baselines|gymnasium|numpy'
    # Those of the first minute are among them: how long each takes.
    tests sb3 --durations=0 -vv tests/test_readme.py
    tests sb3 tests/test_sb3.py examples/test_examples.py
}

runners() {
    environment rllib 'ray[rllib]' minigrid
    # PyTorch is large, and there already.
    "$place/sb3/bin/python" -c 'import torch' || {
        echo 'skipped: there is no PyTorch'
        exit "$CANNOT"
    }
    echo "$(echo "$place"/sb3/lib/python*/site-packages)" > "$(echo "$place"/rllib/lib/python*/site-packages)/torch.pth"
    tests rllib tests/test_rllib_contract.py examples/test_examples.py -k 'rllib or runner or travel or wrong or trains'
}

pages() {
    environment docs sphinx myst-nb furo 'gymnasium>=1.1'
    "$place/docs/bin/sphinx-build" -q -W --keep-going -b html docs "$place/html"
}

benches() {
    environment benches 'gymnasium>=1.1'
    local here="$PWD"
    (cd "$place/benches" && bin/python "$here/benches/bench.py")
}

tables() {
    environment sb3 stable-baselines3 minigrid
    (cd "$place/sb3" && bin/python examples/toy_text.py)
    if [ -z "${TLTL_TABLES:-}" ]; then
        echo 'not learned again, as TLTL_TABLES is not set: DoorKey'
        return
    fi
    (cd "$place/sb3" && bin/python examples/doorkey_study.py)
}

part "the wheel" wheel
if [ "${#failed[@]}" != 0 ]; then
    echo 'without a wheel there is nothing to test'
    exit 1
fi
part "an empty environment" empty
part "the oldest NumPy and Gymnasium, and the wheel's ABI" oldest
part "the source distribution builds from itself" from_source
part "simulators and recorded data" robotics
part "Stable-Baselines3" baselines
part "RLlib on Ray" runners
part "pages" pages
part "benches" benches
part "tables" tables

printf '\n== nightly: done (%s s)\n' "$SECONDS"
printf 'passed:  %s\n' "${passed[@]}"
[ "${#skipped[@]}" = 0 ] || printf 'skipped: %s\n' "${skipped[@]}"
[ "${#failed[@]}" = 0 ] || printf 'failed:  %s\n' "${failed[@]}"
[ "${#failed[@]}" = 0 ]
