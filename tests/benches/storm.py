"""Times Storm on the worlds of the bench `solve`, and the solver of this repository beside it.

    cargo bench -p tltl-tests --bench solve --no-run && python tests/benches/storm.py [NAME...]

It needs the package `stormpy` (below 2), and says so where there is none. Both solve the same augmented
MDP, which is built before the time is taken: P is the largest probability of satisfaction, steps the fewest
steps where that is 1. Storm is asked for a precision of 1e-9, with its default method and with a sound
one; the solver's error bounds are part of its time.
"""

import re
import subprocess
import sys
import tempfile
import time
from pathlib import Path

NAMES = ["grid", "trap", "unstructured", "dense", "slow"]
METHODS = ["default", "optimistic_value_iteration"]


def storm_seconds(stormpy, model, formula, method):
    """CPU seconds of one query, and its value in the initial state; none where Storm refuses."""
    environment = stormpy.Environment()
    minmax = environment.solver_environment.minmax_solver_environment
    minmax.precision = stormpy.Rational("1/1000000000")
    if method != "default":
        environment.solver_environment.set_force_sound(True)
        minmax.method = getattr(stormpy.MinMaxMethod, method)
    query = stormpy.parse_properties(formula)[0]
    start = time.process_time()
    try:
        result = stormpy.model_checking(model, query, environment=environment)
    except RuntimeError as error:
        return None, str(error).splitlines()[0][:60]
    return time.process_time() - start, result.at(model.initial_states[0])


def main():
    try:
        import stormpy
    except ImportError:
        print("skipped: there is no package `stormpy`")
        return
    names = sys.argv[1:] or NAMES
    bench = ["cargo", "bench", "-q", "-p", "tltl-tests", "--bench", "solve", "--"]
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            ours = subprocess.run([*bench, name, "--drn", folder], capture_output=True, text=True, check=True)
            seconds = {what: float(ms) / 1e3 for what, ms in re.findall(r", (.*): ([0-9.]+) ms", ours.stdout)}
            print(ours.stdout.splitlines()[-1])
            options = stormpy.DirectEncodingParserOptions()
            options.build_choice_labels = False
            model = stormpy.build_model_from_drn(str(Path(folder) / f"{name}.drn"), options)
            p, both = seconds["P"], seconds["P and steps"]
            print(f"{name:14} P {p:.3f} s, P and steps {both:.3f} s")
            for method in METHODS:
                for what, formula in [("P", 'Pmax=? [F "goal"]'), ("steps", 'Rmin=? [F "goal"]')]:
                    time_, value = storm_seconds(stormpy, model, formula, method)
                    shown = f"{time_:.3f} s" if time_ is not None else "refused"
                    print(f"    Storm {method:27} {what:6} {shown:10} {value}")


if __name__ == "__main__":
    main()
