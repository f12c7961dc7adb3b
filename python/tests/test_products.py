"""Automata without a formula of their own: those of other tools, and products."""

from __future__ import annotations

import copy
import pickle
import warnings

import numpy as np
import pytest
from conftest import DATA, rows

from tltl import CompileError, FiniteModel, Learner, Rewards, Task, TaskWarning, product, solve
from tltl.replay import relabel

RNG = np.random.default_rng(7)


def quiet(formula: str) -> Task:
    with warnings.catch_warnings():
        warnings.simplefilter("ignore", TaskWarning)
        return Task(formula)


FORMULAS = [row["formula"] for name in ("corpus.jsonl", "corner.jsonl") for row in rows(name)][:120]


@pytest.mark.parametrize("formula", FORMULAS)
def test_an_automaton_that_was_written_is_read_again(formula: str) -> None:
    task = quiet(formula)
    theirs = Task.from_hoa(task.to_hoa())
    assert (theirs.fingerprint, theirs.edges) == (task.fingerprint, task.edges)
    assert theirs.propositions == task.propositions and theirs.warnings == ()
    labels = RNG.normal(size=(4, 6, len(task.propositions)))
    own = task.run(labels[0], columns=task.propositions)
    run = theirs.run(labels[0], columns=task.propositions)
    assert run.states.tolist() == own.states.tolist() and run.verdict == own.verdict
    assert run.progress.tolist() == own.progress.tolist()
    # The best run of an automaton and the formula agree on the sign, not on the number.
    robust = theirs.robustness(labels, columns=task.propositions)
    holds = task.satisfied(labels, columns=task.propositions)
    assert isinstance(robust, np.ndarray)
    assert np.array_equal(robust > 0, holds) and run.robustness == robust[0]


def test_an_automaton_of_another_tool_is_a_task() -> None:
    text = (DATA / "avoid.hoa").read_text()
    task = Task.from_hoa(text, name="avoid.hoa")
    assert task.name is None and task.step_seconds is None
    assert task.text in repr(task) and "Its automaton" in task.explain()
    assert "pub fn task" in task.to_rust() and task.to_hoa().startswith("HOA: v1")
    for other in (pickle.loads(pickle.dumps(task)), copy.deepcopy(task)):
        assert other == task and hash(other) == hash(task)
        assert other.fingerprint == task.fingerprint
    assert Task.from_hoa(text).diff(task).startswith("equal")
    with pytest.raises(ValueError, match="only bare formulas"):
        _ = task & task
    with pytest.raises(ValueError, match="only bare formulas"):
        product("and", task, "F a")
    with pytest.raises(CompileError) as error:
        Task.from_hoa("HOA: v1 Start: 0 AP: 1 \"a\" --BODY-- State: 0 [1] 0 --END--", name="no.hoa")
    assert "no.hoa:1" in str(error.value) and error.value.diagnostics


def test_an_automaton_of_another_tool_is_solved_and_learned() -> None:
    ways = [cell for s in range(5) for cell in (max(s - 1, 0), min(s + 1, 4))]
    model = FiniteModel.from_arrays(range(11), ways, [1.0] * 10, actions=2)
    task = Task("!left U right")
    theirs = Task.from_hoa(task.to_hoa())
    labels = lambda s: {"left": s == 0, "right": s == 4}  # noqa: E731
    best = solve(model, theirs, labels)
    assert np.array_equal(best.satisfied, solve(model, task, labels).satisfied)
    assert Learner(model, theirs, labels, seed=1).train(2_000).certify(best).regret_satisfied == 0


@pytest.mark.parametrize("operator", ["and", "or"])
@pytest.mark.parametrize("formulas", [("F a", "!c U b"), ("a T b", "F c", "X a"), ("F (a && X c)",)])
def test_a_product_has_the_states_of_its_operands(operator: str, formulas: tuple[str, ...]) -> None:
    tasks = [Task(formula) for formula in formulas]
    whole = product(operator, *tasks)  # type: ignore[arg-type]
    both = whole.task
    assert whole.components.shape == (both.num_states, len(tasks))
    every = all if operator == "and" else any
    for _ in range(50):
        q, parts = both.initial, [task.initial for task in tasks]
        for _ in range(8):
            holds = {name: bool(RNG.random() < 0.4) for name in "abc"}
            q = both.step(q, holds)
            parts = [task.step(p, holds) for task, p in zip(tasks, parts, strict=True)]
            # A verdict, once it is final, is one state.
            satisfied = every(p == t.accepting for p, t in zip(parts, tasks, strict=True))
            lost = [p == t.trap for p, t in zip(parts, tasks, strict=True)]
            is_lost = any(lost) if operator == "and" else all(lost)
            assert (q == both.accepting, q == both.trap) == (satisfied, is_lost)
            if not (satisfied or is_lost):
                assert whole.components[q].tolist() == parts
    # The formula is that of the whole, with the same robustness.
    text = " && " if operator == "and" else " || "
    written = quiet(text.join(f"({formula})" for formula in formulas))
    states = RNG.normal(size=(20, 6, len(both.propositions)))
    assert np.array_equal(
        both.robustness(states, columns=both.propositions),
        written.robustness(states, columns=both.propositions),
    )


def test_products_pickle_and_are_compared() -> None:
    whole = product("or", "F a", "a T b")
    again = pickle.loads(pickle.dumps(whole))
    assert again.task == whole.task and np.array_equal(again.components, whole.components)
    assert pickle.loads(pickle.dumps(whole.task)) == whole.task
    # The formula alone has another automaton.
    assert whole.task != quiet(whole.task.text)
    for wrong, message in ((("xor", "F a"), "not `and` or `or`"), (("and",), "none are given")):
        with pytest.raises(ValueError, match=message):
            product(*wrong)  # pyright: ignore
    with pytest.raises(CompileError):
        product("and", "G a")


def test_stored_steps_are_relabelled_by_the_states_of_a_product() -> None:
    whole = product("and", "F a", "F b")
    seen = relabel(whole, [[True, False]], rewards=Rewards("progress"))
    parts = whole.components[seen.q], whole.components[seen.next_q]
    assert [p.tolist() for p in parts] == [[[0, 0], [0, 1], [1, 0]], [[1, 0], [1, 1], [1, 0]]]
    assert seen.reward.tolist() == [1.0, 1.0, 0.0] and seen.terminated.tolist() == [0, 1, 0]


def test_a_comment_ends_with_its_operand() -> None:
    both = product("and", quiet("F a // the first"), quiet("F b /* the second */"))
    assert both.task.text == "F a && F b" and len(both.components) == 4
    one, other = quiet("F a // the first"), quiet("F b")
    assert (one & other).text == "F a && F b" and (other | one).text == "F b || F a"
