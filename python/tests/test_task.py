"""Tasks: what they are, what they do, and that they are the compiler's."""

from __future__ import annotations

import copy
import json
import pickle
import sys
import threading
import time
import warnings
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor
from typing import Any

import numpy as np
import pytest
from conftest import rows

import tltl
from tltl import CompileError, Task, TaskWarning


def quiet(formula: str) -> Task:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TaskWarning)
        return Task(formula)


@pytest.mark.parametrize("data", ["corpus.jsonl", "corner.jsonl", "bounded.jsonl"])
def test_automata_are_those_of_the_corpus(data: str) -> None:
    checked = 0
    for row in rows(data):
        if not row["transitions"] or len(row["transitions"]) > 200:
            continue
        task = quiet(row["formula"])
        names = row["aps"]
        assert set(task.propositions) <= set(names), row["id"]
        table = np.array(row["transitions"])
        # A letter of the corpus as one of the task, whose propositions may have another order.
        places = [names.index(name) for name in task.propositions]
        letters = np.arange(table.shape[1], dtype=np.uint64)
        own = sum(((letters >> at) & 1) << i for i, at in enumerate(places)) + 0 * letters
        assert task.num_states == row["states"], row["id"]
        pairs, left = {(0, task.initial)}, [(0, task.initial)]
        while left:
            theirs, ours = left.pop()
            assert (theirs in row["accepting"]) == (ours == task.accepting), row["id"]
            moved = task.step_batch(np.full(len(letters), ours), own.astype(np.uint64))
            for pair in set(zip(table[theirs].tolist(), moved.tolist(), strict=True)) - pairs:
                pairs.add(pair)
                left.append(pair)
        assert len(pairs) == row["states"], row["id"]
        checked += 1
    assert checked >= 10


def test_robustness_is_that_of_the_corpus() -> None:
    for row in rows("robustness.jsonl"):
        task = quiet(row["formula"])
        trace = np.array(row["trace"], dtype=float).reshape(len(row["trace"]), -1)
        columns = {name: i for i, name in enumerate(row["aps"])}
        found = task.robustness(trace, columns=columns)
        assert found == pytest.approx(float(row["rho"]), abs=0), row["id"]
        for length, expected in enumerate(row["rho_prefixes"], 1):
            assert task.robustness(trace[:length], columns=columns) == float(expected), row["id"]


def test_what_a_task_is() -> None:
    task = Task("F a && F b ensuring !c")
    assert (task.num_states, task.initial, task.accepting, task.trap) == (5, 0, 4, 1)
    assert task.propositions == ("a", "b", "c")
    assert [input.kind for input in task.inputs] == ["proposition"] * 3
    assert task.distances[task.accepting] == 0
    assert task.distances[task.trap] == -1
    assert task.table is not None and task.table.shape == (5, 8)
    with pytest.raises(ValueError, match="read-only"):
        task.table[0, 0] = 1
    guards = {(edge.source, edge.target): edge.guard for edge in task.edges}
    assert task.trap is not None and guards[task.initial, task.trap] == "c"
    assert "not c" in task.explain()
    assert task.svg().startswith("<svg") and task._repr_svg_() == task.svg()
    assert "<svg" in task._repr_html_() and "<pre>" in task._repr_html_()
    assert task.to_hoa().startswith("HOA: v1") and "digraph" in task.to_dot()
    assert "flowchart" in task.to_mermaid()
    assert task.to_html().startswith("<!doctype html>") and "not c" in task.to_html()
    assert '"states"' in task.to_json() and "FORMULA" in task.to_rust()
    assert repr(task) == 'Task("F a && F b ensuring !c")'


def test_step_reads_all_forms_of_labels() -> None:
    task = Task("a T b")
    for labels in (
        {"a": True, "b": False, "more": True},
        {"a": 0.5, "b": -1.0},
        {"a": np.float32(1), "b": np.bool_(False)},
        {"a"},
        frozenset({"a"}),
        [True, False],
        np.array([1, 0]),
        np.array([0.5, 0.0]),
    ):
        assert task.step(0, labels) == 1, labels
    with pytest.raises(ValueError, match="`b` is missing; given: a, B; did you mean `B`"):
        task.step(0, {"a": True, "B": True})
    with pytest.raises(ValueError, match="no proposition `d`; it has: a, b"):
        task.step(0, {"a", "d"})
    with pytest.raises(ValueError, match="`b` is not a number"):
        task.step(0, {"a": 1.0, "b": float("nan")})
    with pytest.raises(ValueError, match=r"one value for each of the 2 propositions \(a, b\)"):
        task.step(0, [True, False, True])
    for bad in (99, -1, 1 << 40):
        with pytest.raises(IndexError, match="the automaton has 3 states"):
            task.step(bad, {"a": True, "b": True})


def test_monitor_and_run_agree() -> None:
    task = Task("(x < 1) T (x > 2)")
    states = np.array([[3.0], [0.0], [1.5], [2.5]])
    run = task.run(states)
    assert run.states.tolist() == [0, 1, 1, 2]
    assert run.progress.tolist() == [-2.0, 1.0, -0.5, 0.5]
    assert (run.verdict, run.since, run.satisfied, run.lost) == ("satisfied", 3, True, False)
    monitor = task.monitor()
    observed = [monitor.observe(labels) for labels in task.labels(states)]
    assert observed == run.states.tolist() and monitor.satisfied and not monitor.lost
    monitor.reset()
    assert monitor.state == task.initial


def test_mistakes_are_underlined_and_are_data() -> None:
    with pytest.raises(CompileError) as caught:
        Task("◇a ∧ G b")
    error = caught.value
    first = error.diagnostics[0]
    assert (first.kind, first.severity) == ("unsupported-operator", "error")
    assert first.span[0] == 5, "characters, not bytes"
    assert "^" in str(error) and "◇a ∧ G b" in str(error)
    with pytest.raises(CompileError, match="write `F a && F b ensuring c`"):
        Task("G a")
    again = pickle.loads(pickle.dumps(error))
    assert str(again) == str(error) and again.diagnostics == error.diagnostics
    for row in rows("rejects.jsonl"):
        if row["expect"] == "ok":
            quiet(row["formula"])
        else:
            with pytest.raises(CompileError) as caught:
                quiet(row["formula"])
            kinds = {found.kind for found in caught.value.diagnostics}
            assert row["expect"] == "syntax" or row["expect"] in kinds, row


def test_warnings_are_given_once_and_are_data() -> None:
    with pytest.warns(TaskWarning, match="does not order a before b"):
        task = Task("F a T b")
    assert task.warnings[0].kind == "intent"
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        pickle.loads(pickle.dumps(task))


def test_tasks_are_values() -> None:
    task = Task("F a && F b")
    for other in (pickle.loads(pickle.dumps(task)), copy.copy(task), copy.deepcopy(task)):
        assert other == task and hash(other) == hash(task)
        assert other.fingerprint == task.fingerprint
    assert task != Task("F b && F a") and task != "F a && F b"
    assert len(pickle.dumps(task)) < 500
    small = tltl.Budget(states=1)
    with pytest.raises(CompileError, match="states"):
        Task("F a && F b && F c", budget=small)
    assert pickle.loads(pickle.dumps(small)) == small
    both = Task("F a") & Task("F b")
    assert both.diff(task) == Task("F a && F b").diff(task)
    either = Task("F a") | Task("F b")
    assert either.num_states == 2
    restore, (*state, _) = task.__reduce__()
    with pytest.raises(ValueError, match="another numbered automaton"):
        restore(*state, "0")


FILE = """
enum Object { apple, mug }
state Kitchen { holding: Object?, x: f64 in m }
predicate near(far: f64 in m) = x < far
task grasp(o: Object, far: f64 in m) = F (holding == o && near(far))
task leave = F x > 9
"""


def test_task_files() -> None:
    file = tltl.TaskFile.from_text(FILE, name="kitchen.tltl")
    assert list(file.tasks) == ["grasp", "leave"]
    assert [known.name for known in file.tasks["grasp"]] == ["o", "far"]
    task = file.task("grasp", o="mug", far=2.0)
    inputs = {known.name: (known.kind, known.unit, known.values) for known in task.inputs}
    assert inputs == {"holding": ("enum", None, ["apple", "mug"]), "x": ("f64", "m", [])}
    states = {"holding": np.array([-1, 1, 1]), "x": np.array([0.0, 3.0, 1.0])}
    assert task.satisfied(states) is True
    assert task == pickle.loads(pickle.dumps(task))
    assert task != file.task("grasp", o="apple", far=2.0)
    with pytest.raises(ValueError, match="`far` is missing"):
        file.task("grasp", o="mug")
    with pytest.raises(ValueError, match="no task `grab`"):
        file.task("grab")
    with pytest.raises(CompileError, match=r"kitchen.tltl:\d+"):
        tltl.TaskFile.from_text("task t = F", name="kitchen.tltl")


def test_trajectories_as_a_page() -> None:
    task = Task("(x < 1) T (x > 2)")
    walk = np.array([[3.0], [0.0], [1.5], [2.5]])
    page = task.to_html(walk)
    data = json.loads(page.split('id="data">')[1].split("</script>")[0])
    (shown,) = data["trajectories"]
    assert shown["name"] == "trajectory 0" and "satisfied" in json.dumps(shown)
    assert task.to_html({"x": walk[:, 0]}) == page
    two = task.to_html([walk, walk[:2]])
    assert "trajectory 1" in two
    with pytest.raises(ValueError, match="one state"):
        task.to_html([1.0])
    with pytest.raises(ValueError, match="not a number"):
        task.to_html([[0.0], [np.nan]])


def test_threads_share_a_task() -> None:
    task = Task("(x < 1) T (x > 2)")
    states = np.random.default_rng(1).normal(size=(20, 500, 1)) * 3
    expected = task.robustness(states)
    with ThreadPoolExecutor(8) as pool:
        for found in pool.map(task.robustness, [states] * 16):
            assert np.array_equal(found, expected)


@pytest.mark.parametrize("call", ["step_batch", "labels", "robustness", "run"])
def test_the_interpreter_is_free_while_rust_works(call: str) -> None:
    task = Task("F ((x < 1) && F (x > 5))")
    states = np.zeros((200_000, 1))
    letters, q = np.zeros(200_000, dtype=np.uint64), np.zeros(200_000, dtype=np.uint32)
    calls: dict[str, Callable[[], Any]] = {
        "step_batch": lambda: task.step_batch(q, letters),
        "labels": lambda: task.labels(states),
        "robustness": lambda: task.robustness(states),
        "run": lambda: task.run(states),
    }
    work = calls[call]
    counted, over = 0, False

    def count() -> None:
        nonlocal counted
        while not over:
            counted += 1
            time.sleep(0)  # gives the interpreter back

    interval = sys.getswitchinterval()
    # Nobody is interrupted: another thread runs only where the interpreter is given up.
    sys.setswitchinterval(1_000)
    other = threading.Thread(target=count)
    other.start()
    try:
        before = counted
        for _ in range(200):
            work()
            if counted > before:
                break
        assert counted > before
    finally:
        over = True
        sys.setswitchinterval(interval)
        other.join()


def test_label_functions_declare_their_names() -> None:
    @tltl.labels("key", "door")
    def seen(obs: int) -> set[str]:
        return {"key"} if obs else {"kee"}

    assert seen(1) == {"key": True, "door": False}
    with pytest.raises(ValueError, match="'kee'; it declares key, door"):
        seen(0)


def test_how_long_a_step_lasts() -> None:
    text = "state S {{ a: bool }}\n{}\ntask t = F a"
    for step, seconds in (("step 0.1 s", 0.1), ("step 20 ms", 0.02), ("step 2 beats", None), ("", None)):
        task = tltl.TaskFile.from_text(text.format(step)).task()
        assert task.step_seconds == pytest.approx(seconds) if seconds else task.step_seconds is None
    assert Task("F a").step_seconds is None


def test_the_automaton_as_a_graph() -> None:
    networkx = pytest.importorskip("networkx")
    task = Task("F a && F b ensuring !c")
    graph = task.to_networkx()
    assert isinstance(graph, networkx.MultiDiGraph) and len(graph) == task.num_states
    edges = {(u, v): guard for u, v, guard in graph.edges(data="guard")}
    assert edges == {(edge.source, edge.target): edge.guard for edge in task.edges}
    assert [q for q, is_trap in graph.nodes(data="trap") if is_trap] == [task.trap]
    # As far as the automaton says.
    far = networkx.shortest_path_length(graph, target=task.accepting)
    assert all(task.distances[q] == far.get(q, -1) for q in graph)
