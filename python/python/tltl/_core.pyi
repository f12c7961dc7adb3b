import os
from collections.abc import Callable, Hashable, Mapping, Sequence
from typing import Any, Literal, final, overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from tltl._errors import Diagnostic
from tltl._labels import Labels
from tltl._model import EventFn, Table

_States = ArrayLike | Sequence[NDArray[Any]] | Mapping[str, ArrayLike]
_Columns = Mapping[str, int] | Sequence[str]
_Path = str | os.PathLike[str]
_Labels = ArrayLike | Callable[..., Labels]
_Policy = Policy | ArrayLike | Callable[[int, int], int]

__version__: str

__all__ = [
    "Budget",
    "Certificate",
    "Composition",
    "Edge",
    "Factored",
    "FiniteModel",
    "Input",
    "Learner",
    "Mistake",
    "Monitor",
    "NetworkPolicy",
    "Parameter",
    "Policy",
    "Product",
    "Rewards",
    "Run",
    "Schedule",
    "Settings",
    "Shield",
    "Shielded",
    "Solution",
    "Task",
    "TaskFile",
    "__version__",
    "compose",
    "follow",
    "follow_all",
    "main",
    "product",
    "relabelled",
    "restore",
    "restore_product",
    "solve",
]

@final
class Budget:
    """How large an automaton may become."""

    def __new__(
        cls,
        *,
        states: int | None = None,
        nodes: int | None = None,
        edges: int | None = None,
        products: int | None = None,
    ) -> Budget: ...
    def __getnewargs_ex__(self) -> tuple[tuple[()], dict[str, int]]: ...
    @property
    def states(self) -> int:
        """The most states, before the automaton is minimal."""
    @property
    def nodes(self) -> int:
        """The most nodes of its decision diagrams."""
    @property
    def edges(self) -> int:
        """The most edges of the minimal automaton."""
    @property
    def products(self) -> int:
        """The most products (cubes) of one guard."""

@final
class Input:
    """A number that the predicates of a task read from a state."""

    @property
    def name(self) -> str:
        """Its name: `x`, `pose.x`, `joints[2]`, or the proposition."""
    @property
    def kind(self) -> str:
        """The type that the task file declares, or `enum`; in a bare formula `variable`, any number, or
        `proposition`, which is given by its robustness.
        """
    @property
    def unit(self) -> str | None:
        """The unit that the task file declares."""
    @property
    def values(self) -> list[str]:
        """The names of the values of an enumeration, in the order of their numbers; else empty."""

@final
class Edge:
    """A move of the automaton, with its guard as text."""

    @property
    def source(self) -> int:
        """The state that it leaves."""
    @property
    def target(self) -> int:
        """The state that it enters."""
    @property
    def guard(self) -> str:
        """The letters that take it, as a formula."""

@final
class Run:
    """A trajectory that ran through a task: one entry for each row."""

    @property
    def states(self) -> NDArray[np.uint32]:
        """The automaton state after each row: uint32, of shape (T,)."""
    @property
    def progress(self) -> NDArray[np.float64]:
        """By how much each row makes the automaton move on: float64, of shape (T,); -inf where it is decided."""
    @property
    def robustness(self) -> float:
        """The robustness of the whole trajectory; -inf if it is empty."""
    @property
    def verdict(self) -> str:
        """`satisfied`, `lost` or `open`."""
    @property
    def since(self) -> int | None:
        """The first row after which the verdict was this one; `None` if there are no rows."""
    @property
    def satisfied(self) -> bool:
        """Whether it satisfies the task."""
    @property
    def lost(self) -> bool:
        """Whether the task is lost, whatever comes after it."""

@final
class Task:
    """A formula of temporal logic, compiled to its minimal automaton.

    A task never changes. It is equal to others of the same source, name and arguments, and is
    pickled by them. Threads may share it.

    Raises `CompileError` if there is a mistake in the formula.

    >>> from tltl import Task
    >>> task = Task("!wet U home")
    >>> task.step(task.initial, {"wet": False, "home": True}) == task.accepting
    True
    """
    def __new__(cls, formula: str, /, *, budget: Budget | None = None) -> Task: ...
    @staticmethod
    def from_hoa(text: str, /, *, name: str = "automaton") -> Task:
        """The task of an automaton that another tool wrote in the HOA format (Spot, Owl, ltlf2dfa). It
        must be deterministic, and accept for good once it accepts.

        There is no formula: `text` is its own name or `name`, and `robustness` that of the best run
        through the automaton. States are given by the names of the propositions, as for a bare
        formula.

        Raises `CompileError` if the text is not such an automaton.

        >>> from tltl import Task
        >>> theirs = Task.from_hoa(Task("!wet U home").to_hoa())
        >>> theirs.fingerprint == Task("!wet U home").fingerprint
        True
        """
    @property
    def text(self) -> str:
        """The formula, without comments and laid out anew."""
    @property
    def name(self) -> str | None:
        """Its name in the task file; `None` for a bare formula."""
    @property
    def propositions(self) -> tuple[str, ...]:
        """The names of what the automaton reads, in the order of the bits of a letter."""
    @property
    def inputs(self) -> tuple[Input, ...]:
        """What the predicates read from a state, in the order of the columns."""
    @property
    def num_states(self) -> int:
        """The number of automaton states, numbered from 0."""
    @property
    def initial(self) -> int:
        """The state before anything is read."""
    @property
    def accepting(self) -> int | None:
        """The state in which the task is satisfied, for ever; `None` if there is none."""
    @property
    def trap(self) -> int | None:
        """The state in which the task is lost, for ever; `None` if it cannot be lost."""
    @property
    def step_seconds(self) -> float | None:
        """How long a step lasts, in seconds, if the task file says it (`step 0.1 s`) in a unit of time:
        `s`, `ms`, `us`, `ns`, `min` or `h`.
        """
    @property
    def edges(self) -> tuple[Edge, ...]:
        """All moves, self-loops included, each with its guard as text."""
    @property
    def distances(self) -> NDArray[np.int32]:
        """The fewest moves from each state to the accepting one: int32, -1 where there is no way."""
    @property
    def table(self) -> NDArray[np.uint32] | None:
        """The next state of each state (rows) and letter (columns): uint32; `None` for more than 16
        propositions.
        """
    @property
    def fingerprint(self) -> str:
        """A number of 16 digits for the numbered automaton: what was learned with one automaton fits
        those of the same fingerprint.
        """
    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """What the author should look at."""
    def step(self, q: int, labels: Labels) -> int:
        """The state after `q` has read what holds: a mapping of names to truth values or robustness, a
        set of the names that hold, or an array in the order of `propositions`.

        Raises `ValueError` if a proposition is missing, `IndexError` if `q` is not a state.
        """
    def valuation(self, labels: Labels) -> NDArray[np.bool_]:
        """What holds, in the order of `propositions`: bool, of shape (propositions,). `labels` as for
        `step`.
        """
    @overload
    def progress_robustness(self, q: int, labels: Labels) -> float:
        """By how much a state makes the automaton move on from `q`, the trap apart: ρ(s, D_φ^q). `labels`
        as for `step`; numbers are the robustness of the propositions, and truth values 1 or -1.

        Or the same for many: `q` of shape (n,) and `labels` of shape (n, propositions).
        """
    @overload
    def progress_robustness(self, q: NDArray[Any], labels: Any) -> NDArray[np.float64]: ...
    def step_batch(
        self, q: ArrayLike, labels: ArrayLike, *, out: NDArray[np.uint32] | None = None
    ) -> NDArray[np.uint32]:
        """The states after `q`, of shape (n,), has read `labels`: truth values of shape (n,
        propositions), or letters of shape (n,), whose bit i is proposition i.

        With `out`, a uint32 array, the result is written there; it may be `q`.
        """
    def labels(self, states: _States, *, columns: _Columns | None = None) -> NDArray[np.bool_]:
        """Which propositions hold in each of `states`, of shape (…, d): bool, of shape (…, propositions).

        `states` may also be a mapping of names to arrays of shape (…). `columns` says where an array
        has what the task reads: a mapping of names to indices, or the names of all columns.

        Raises `ValueError` if a predicate is not a number.
        """
    def rho(self, states: _States, *, columns: _Columns | None = None) -> NDArray[np.float64]:
        """The robustness of each proposition in each of `states`, as `labels`: float64."""
    def letters(self, states: _States, *, columns: _Columns | None = None) -> NDArray[np.uint64]:
        """What holds in each of `states`, of shape (…, d), as bits: uint64, of shape (…)."""
    def robustness(
        self, states: _States, *, columns: _Columns | None = None
    ) -> float | NDArray[np.float64]:
        """The robustness of a trajectory of shape (T, d), or of each of many: of shape (N, T, d), or a
        list of arrays of shape (T_i, d).
        """
    def satisfied(
        self, states: _States, *, columns: _Columns | None = None
    ) -> bool | NDArray[np.bool_]:
        """Whether a trajectory satisfies the task; shapes as for `robustness`."""
    def run(self, states: _States, *, columns: _Columns | None = None) -> Run:
        """A trajectory of shape (T, d), followed row by row."""
    def monitor(self) -> Monitor:
        """The task on its way, to be told what holds, one state after the other."""
    def to_html(self, states: _States | None = None, *, columns: _Columns | None = None) -> str:
        """A page for a browser, one file without a network: the automaton and what it asks for, and, with
        `states` (shapes as for `robustness`), how it followed these trajectories, with a slider.
        """
    def explain(self) -> str:
        """The task in plain English, with shortest ways to satisfy it and to lose it."""
    def diff(self, other: Task) -> str:
        """A shortest trajectory on which the two tasks differ, or that they are equal."""
    def svg(self) -> str:
        """The automaton as a picture on a white ground."""
    def _repr_svg_(self) -> str: ...
    def _repr_html_(self) -> str:
        """In a notebook: the automaton, and what it asks for."""
    def to_networkx(self) -> Any:
        """The automaton as a `networkx.MultiDiGraph`: nodes are states, with `initial`, `accepting` and
        `trap`; each edge has its `guard`.

        Raises `ImportError` if networkx is not installed.
        """
    def to_dot(self) -> str:
        """The automaton for Graphviz."""
    def to_hoa(self) -> str:
        """The automaton in the HOA format."""
    def to_json(self) -> str:
        """The automaton as JSON."""
    def to_mermaid(self) -> str:
        """The automaton for Mermaid."""
    def to_rust(self) -> str:
        """The task as Rust source."""
    def __and__(self, other: Task, /) -> Task: ...
    def __rand__(self, other: Task, /) -> Task: ...
    def __or__(self, other: Task, /) -> Task: ...
    def __ror__(self, other: Task, /) -> Task: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Rewards:
    """What a move of the automaton pays: the mode, the discount factor that a shaped reward needs, and
    penalties.

    `shaped`, the default, pays 1 for satisfying the task, and a potential on the way that leaves the
    best policies as they are; its `gamma` must be the learner's. `acceptance` is the 1 alone.
    `progress` pays 1 for every move that is not into the trap (the paper's reward); where the
    automaton has a way back, its best policy need not satisfy the task. `robustness` pays by how much
    a state makes the automaton move on, at most `bound`. `literal` pays for being lost too.

    `environment` is the weight of the environment's own reward.

    >>> from tltl import Rewards, Task
    >>> task = Task("F a")
    >>> Rewards("acceptance", trap_penalty=1.0).pay(task, 0, 1)
    1.0
    """
    def __new__(
        cls,
        mode: str = "shaped",
        *,
        gamma: float = 0.99,
        bound: float = 1.0,
        trap_penalty: float = 0.0,
        step_penalty: float = 0.0,
        environment: float = 0.0,
    ) -> Rewards: ...
    @property
    def mode(self) -> str:
        """What is paid for: `shaped`, `acceptance`, `progress`, `robustness` or `literal`."""
    @property
    def gamma(self) -> float:
        """The discount factor."""
    @property
    def bound(self) -> float:
        """The most that `robustness` pays for a step."""
    @property
    def trap_penalty(self) -> float:
        """What being lost costs."""
    @property
    def step_penalty(self) -> float:
        """What each step costs."""
    @property
    def environment(self) -> float:
        """The weight of the environment's own reward."""
    @overload
    def pay(
        self,
        task: Task,
        q: int,
        next_q: int,
        *,
        rho: float | None = None,
        reward: float | None = None,
        terminated: bool | None = None,
    ) -> float:
        """What the move from `q` to `next_q` pays, or each of many moves: numbers, or arrays of shape
        (n,). States of a `Factored` are arrays of shape (parts,), or (n, parts).

        `rho` is ρ(s', D_φ^q), which the mode `robustness` needs; `reward` is what the environment pays,
        and `terminated` whether it ended the episode itself. Both default to nothing.
        """
    @overload
    def pay(
        self,
        task: Task,
        q: NDArray[Any],
        next_q: NDArray[Any],
        *,
        rho: NDArray[Any] | None = None,
        reward: NDArray[Any] | None = None,
        terminated: NDArray[Any] | None = None,
    ) -> NDArray[np.float64]: ...
    @overload
    def pay(
        self,
        task: Factored,
        q: NDArray[Any],
        next_q: NDArray[Any],
        *,
        rho: Any = None,
        reward: Any = None,
        terminated: Any = None,
    ) -> Any: ...
    def __hash__(self) -> int: ...
    def __eq__(self, other: object, /) -> bool: ...
    def __getnewargs_ex__(self) -> tuple[tuple[str], dict[str, float]]: ...

@final
class Monitor:
    """A task on its way."""
    @property
    def task(self) -> Task:
        """The task that is monitored."""
    @property
    def state(self) -> int:
        """The automaton state now."""
    @property
    def satisfied(self) -> bool:
        """Whether the task is satisfied."""
    @property
    def lost(self) -> bool:
        """Whether the task is lost."""
    def observe(self, labels: Labels) -> int:
        """Reads what holds now; the state after it."""
    def reset(self) -> None:
        """Back to where nothing was read."""

@final
class Parameter:
    """A parameter of a task."""
    @property
    def name(self) -> str:
        """Its name."""
    @property
    def type(self) -> str:
        """Its type, as text."""
    @property
    def unit(self) -> str | None:
        """Its unit, if the file gives one."""
    @property
    def values(self) -> list[str]:
        """The names of the values of an enumeration; else empty."""

@final
class TaskFile:
    """A task file, compiled."""
    @staticmethod
    def from_text(text: str, /, *, name: str = "text", budget: Budget | None = None) -> TaskFile:
        """The file of this text, which messages call `name`."""
    @property
    def tasks(self) -> dict[str, tuple[Parameter, ...]]:
        """The names of its tasks, each with its parameters."""
    @property
    def warnings(self) -> tuple[Diagnostic, ...]:
        """What the author should look at."""
    def task(self, name: str | None = None, /, **arguments: float | bool | str) -> Any:
        """The task of this name with these values for its parameters; without a name the only task.

        A task that is marked `#[factored]` is a `Factored`. A parameter is a number, a truth value, or the name of a value of its enumeration. Raises
        `ValueError` if the file has no such task, or it takes other arguments.

        >>> from tltl import TaskFile
        >>> file = TaskFile.from_text("state S { x: f64 } task far(d: f64) = F x > d")
        >>> file.task("far", d=2.5).satisfied([[1.0], [3.0]])
        True
        """

@final
class Product:
    """A product of tasks. `product` makes it."""
    @property
    def task(self) -> Task:
        """The task as a whole, whose automaton is the product."""
    @property
    def components(self) -> NDArray[np.uint32]:
        """The state of each operand in each state: uint32, of shape (states, operands)."""
    def __reduce__(self) -> tuple[Any, ...]: ...

def product(operator: Literal["and", "or"], /, *tasks: Task | str) -> Product:
    """The raw product of bare formulas (the paper's Definition 4): `"and"` is satisfied where all are,
    `"or"` where one is.

    Its states are the tuples of states that can be reached, so that what was learned for an operand
    is looked up by the operand's own state; all tuples in which the verdict is final are one state.
    The minimal automaton of the same formula may have fewer states: `a & b`.

    Raises `ValueError` if an operand is not a bare formula, and `CompileError` if the automaton is
    larger than the budget of the first allows.

    >>> from tltl import Task, product
    >>> both = product("and", Task("F a"), Task("F b"))
    >>> both.components.tolist()
    [[0, 0], [0, 1], [1, 0], [1, 1]]
    >>> both.task.step(both.task.initial, {"a": False, "b": True})
    1
    """
@final
class Factored:
    """A conjunction whose parts run side by side (`#[factored]` in a task file): n goals in any order are n
    automata of two states, and not one of 2^n.

    A state is an array of one automaton state for each part: uint32, of shape (parts,). The task is
    satisfied when every part is, and lost when one part is.

    >>> from tltl import TaskFile
    >>> file = TaskFile.from_text("state S { a: bool, b: bool } #[factored] task tour = F a && F b")
    >>> tour = file.task()
    >>> q = tour.step(tour.initial, {"a": True, "b": False})
    >>> q.tolist(), tour.is_satisfied(q), tour.is_satisfied(tour.step(q, {"b"}))
    ([1, 0], False, True)
    """
    @property
    def text(self) -> str:
        """The formula, without comments and laid out anew."""
    @property
    def name(self) -> str | None:
        """Its name in the task file."""
    @property
    def parts(self) -> tuple[Task, ...]:
        """Its parts, each a task of its own."""
    @property
    def propositions(self) -> tuple[str, ...]:
        """The names of what any part reads, in the order of the columns of labels."""
    @property
    def inputs(self) -> tuple[Input, ...]:
        """What the predicates read from a state, in the order of the columns."""
    @property
    def step_seconds(self) -> float | None:
        """How long a step lasts, in seconds, if the task file says it; as for `Task`."""
    @property
    def initial(self) -> NDArray[np.uint32]:
        """The state before anything is read: uint32, of shape (parts,)."""
    def step(self, q: ArrayLike, labels: Labels) -> NDArray[np.uint32]:
        """The state after `q` has read what holds; `labels` as for `Task.step`.

        Raises `ValueError` if a proposition is missing, `IndexError` if `q` is not a state.
        """
    def step_batch(self, q: ArrayLike, labels: ArrayLike) -> NDArray[np.uint32]:
        """The states after `q`, of shape (n, parts), has read `labels`, truth values of shape (n,
        propositions).
        """
    def is_satisfied(self, q: ArrayLike) -> Any:
        """Whether the task is satisfied at `q`, of shape (parts,), or at each of many, of shape (n, parts)."""
    def is_lost(self, q: ArrayLike) -> Any:
        """Whether the task is lost at `q`, whatever comes after it; shapes as for `is_satisfied`."""
    def labels(self, states: _States, *, columns: _Columns | None = None) -> NDArray[np.bool_]:
        """Which propositions hold in each of `states`; arguments as for `Task.labels`."""
    def rho(self, states: _States, *, columns: _Columns | None = None) -> NDArray[np.float64]:
        """The robustness of each proposition in each of `states`, as `labels`: float64."""
    def run(self, states: _States, *, columns: _Columns | None = None) -> Run:
        """A trajectory of shape (T, d), followed row by row; `states` of the result has shape (T, parts)."""
    def __reduce__(self) -> tuple[Any, ...]: ...

def restore(
    source: tuple[str, str, str],
    name: str | None,
    arguments: Sequence[tuple[str, float | bool | str]],
    budget: Budget,
    fingerprint: str,
) -> Task | Factored:
    """A task of yesterday: compiled again, and compared by its numbered automaton."""
def restore_product(operator: str, operands: Sequence[Task], fingerprint: str) -> Task:
    """A product of yesterday, made again."""
def main(arguments: Sequence[str]) -> int:
    """Runs the command-line tool with these arguments, the name of the program first; its exit
    code.
    """
def follow(
    task: Task | Factored,
    rewards: Rewards,
    q: int | NDArray[Any],
    labels: Labels,
    robust: Labels | None,
    reward: float,
    terminated: bool,
) -> tuple[Any, float, bool, dict[str, Any]]:
    """What a step of the world is for the task in state `q`: the next state, what it pays, whether the
    task is decided then, and what `info["tltl"]` says. For one state of an environment, what holds in
    it is `labels`, or `robust` if the reward reads robustness.
    """
def follow_all(
    task: Task | Factored,
    rewards: Rewards,
    q: NDArray[Any],
    labels: NDArray[Any],
    robust: NDArray[Any] | None,
    reward: NDArray[Any],
    terminated: NDArray[Any],
) -> tuple[NDArray[np.uint32], NDArray[np.float64], dict[str, NDArray[Any]]]:
    """The same for many environments at once: `q` of shape (n,), or (n, parts), `labels` and `robust` of
    shape (n, propositions), `reward` and `terminated` of shape (n,).
    """
def relabelled(
    task: Task,
    rewards: Rewards,
    next_labels: NDArray[Any],
    reward: ArrayLike | None,
    terminated: ArrayLike | None,
    out: tuple[
        NDArray[np.int64],
        NDArray[np.uint32],
        NDArray[np.uint32],
        NDArray[np.float64],
        NDArray[np.bool_],
    ],
) -> None:
    """Writes the transitions that stored steps are in as many automaton states each, which are those of
    `out[1]`; `next_labels` of shape (n, propositions), and `reward` and `terminated` of shape (n,).
    """

@final
class FiniteModel:
    """A finite world whose probabilities are known.

    Where an outcome ends the episode, its state is read, and nothing after it.

    >>> from tltl import FiniteModel
    >>> # Two states; the only action goes on, and ends in state 1.
    >>> model = FiniteModel.from_arrays([0, 1, 2], [1, 1], [1.0, 1.0], actions=1, ends=[True, True])
    >>> model.num_states, model.num_actions
    (2, 1)
    """
    @staticmethod
    def from_arrays(
        indptr: ArrayLike,
        indices: ArrayLike,
        probabilities: ArrayLike,
        *,
        actions: int,
        ends: ArrayLike | None = None,
        starts: ArrayLike | None = None,
        horizon: int | None = None,
        origin: Sequence[int] | None = None,
        event: tuple[Hashable, ...] | None = None,
    ) -> FiniteModel:
        """The world of sparse rows (CSR): row s * actions + a are the outcomes of action a in state s.

        `ends` says of each outcome whether the episode is over there, `starts` how probable each state
        is at first (equally, if left out), and `horizon` after how many steps an episode is cut.

        Raises `ValueError` if the outcomes of an action are not a distribution.
        """
    @staticmethod
    def from_experience(
        states: ArrayLike,
        actions: ArrayLike,
        next_states: ArrayLike,
        *,
        num_states: int,
        num_actions: int,
        terminated: ArrayLike | None = None,
        starts: ArrayLike | None = None,
    ) -> FiniteModel:
        """The world as stored steps show it, with frequencies as probabilities: step i is from `states[i]`
        under `actions[i]` to `next_states[i]`, all of shape (n,), and ends the episode where
        `terminated[i]`. `starts`, of any length, are first states of episodes; without them each state
        that was met is a start alike.

        An action that was never tried in a state stays there. The order of the steps does not matter,
        so they may come from any policy and any task: `solve` and `compose` on this world are learning
        and composition from stored experience.

        Raises `ValueError` if a state or an action is out of range.
        """
    @staticmethod
    def from_transitions(
        transitions: Table,
        *,
        starts: ArrayLike | None = None,
        events: EventFn | None = None,
        horizon: int | None = None,
    ) -> FiniteModel:
        """The world of Gymnasium's tables: `P[state][action]` are outcomes (probability, next state,
        reward, done), for states and actions numbered from 0.

        With `events`, a function of (state, action, next state, reward), a next state is split by what
        happened on the way to it, and labels may depend on that.
        """
    @staticmethod
    def from_env(env: Any, *, events: EventFn | None = None) -> FiniteModel:
        """The world of a Gymnasium environment that has its tables (`env.unwrapped.P`), with its starts
        and its time limit.
        """
    @property
    def num_states(self) -> int:
        """The number of states, terminal copies included."""
    @property
    def num_actions(self) -> int:
        """The number of actions."""
    @property
    def horizon(self) -> int | None:
        """The steps after which an episode is cut, if it is."""
    @property
    def origin(self) -> NDArray[np.int32]:
        """The state of the tables that each state is: int32, of shape (states,)."""
    @property
    def event(self) -> tuple[Hashable, ...]:
        """What happened on the way into each state; nothing where it was not asked for."""

@final
class Solution:
    """A task that is solved in a model. It is pickled as what was asked, and solved again."""
    @property
    def satisfied(self) -> NDArray[np.float64]:
        """The largest P(satisfied) from each pair: float64, of shape (automaton states, states). The
        state has been read.
        """
    @property
    def steps(self) -> NDArray[np.float64]:
        """The fewest expected steps among the policies of that P, given success, from each pair; NaN
        where P is 0.
        """
    @property
    def policy(self) -> Policy:
        """The best policy."""
    @property
    def Q(self) -> NDArray[np.float64]:
        """The optimal action values for the rewards: float64, of shape (automaton states, states,
        actions).
        """
    def certify(self, policy: _Policy, *, within: int | None = None) -> Certificate:
        """What a policy is worth: a `Policy`, an array of actions of shape (automaton states, states), or
        a function of the two. `within` is a number of steps after which an episode is cut: the
        model's, if left out.
        """
    def certified(self, policy: _Policy, *, within: int | None = None) -> Policy:
        """An array of actions or a function as a `Policy` that says what it is worth: so it is saved and
        becomes Rust. Arguments as for `certify`.
        """
    def mistakes(self, policy: _Policy) -> tuple[Mistake, ...]:
        """The pairs in which a policy takes an action that is worse for the rewards than the best one."""
    def shield(
        self, *, epsilon: float = 0.0, around: Literal["safest", "best"] = "safest"
    ) -> Shield:
        """The shield that bounds what is lost: whoever keeps to allowed actions loses with at most the
        smallest possible probability plus `epsilon`, from every pair, whatever it remembers.

        `around="best"` bounds it by the best policy's probability instead, so that all that the best
        policy does is allowed; the safest policy may wait for ever where nothing can be lost.

        Raises `ValueError` if `epsilon` is not in [0, 1].
        """

@final
class Certificate:
    """What a policy is worth against the best possible: exact means over the starts. It prints as a few
    lines, with the starts that lose most.
    """
    @property
    def kind(self) -> str:
        """How it was come to: `exact`, computed from the model."""
    @property
    def satisfied(self) -> float:
        """P(satisfied) of the policy."""
    @property
    def steps(self) -> float | None:
        """E[steps] of the policy, given success; `None` if it never succeeds."""
    @property
    def optimal_satisfied(self) -> float:
        """The largest possible P(satisfied)."""
    @property
    def optimal_steps(self) -> float | None:
        """The smallest possible E[steps] among the policies of that P."""
    @property
    def regret_satisfied(self) -> float:
        """By how much P(satisfied) is smaller than possible."""
    @property
    def regret_steps(self) -> float | None:
        """By which part of the fewest steps it needs more."""
    @property
    def worst_regret_satisfied(self) -> float:
        """The largest regret in P(satisfied) of a single start."""
    @property
    def fraction_optimal(self) -> float:
        """The fraction of pairs in which the action is optimal for the rewards."""
    @property
    def satisfied_error(self) -> float | None:
        """How far P(satisfied), of the policy and the largest possible, may be from the true numbers: a
        bound that holds. `None` of a document of an earlier version.
        """
    @property
    def steps_error(self) -> float | None:
        """The same of the expected steps; `None` too where there is no bound."""
    @property
    def within(self) -> int | None:
        """The number of steps after which an episode is cut, if there is one."""
    @property
    def satisfied_within(self) -> float | None:
        """P(satisfied) within that number of steps."""
    @property
    def optimal_satisfied_within(self) -> float | None:
        """The largest possible P(satisfied) within that number of steps."""
    @property
    def starts(self) -> tuple[tuple[int, float, float | None], ...]:
        """What it is worth from each start, those that lose most first: (state, P(satisfied), E[steps]
        or `None`). Nothing where only the means are known, as of a policy that was loaded.
        """
    def _repr_html_(self) -> str: ...

@final
class Mistake:
    """An action that is worse for the rewards than the best one: its pair, the action, the best one, and
    by how much its value is smaller.
    """
    @property
    def q(self) -> int:
        """The automaton state."""
    @property
    def state(self) -> int:
        """The state of the world."""
    @property
    def action(self) -> int:
        """What the policy does."""
    @property
    def best(self) -> int:
        """The best action."""
    @property
    def loss(self) -> float:
        """What its value falls short of that of the best action."""

def solve(
    model: FiniteModel,
    task: Task | str,
    labels: _Labels,
    *,
    rewards: Rewards | None = None,
) -> Solution:
    """Solves a task in a model: the largest P(satisfied), and then the fewest steps.

    `labels` says what holds in each state: a function of the state (and of the event, if the model
    has events), as for `Task.step`, or an array of shape (states, propositions). Policies are judged
    by `rewards` too, which count for `fraction_optimal` only.
    """
@final
class Policy:
    """A policy for a task in a finite world: an action for each automaton state and state of the world.

    It knows its task as a table, so it runs without the formula: `reset` reads the first state of an
    episode, `next` each state that is arrived at, and `act` (or a call) gives the action.

    >>> from tltl import FiniteModel, solve
    >>> # Three cells in a row: action 0 stays, action 1 goes right.
    >>> model = FiniteModel.from_arrays(
    ...     [0, 1, 2, 3, 4, 5, 6], [0, 1, 1, 2, 2, 2], [1.0] * 6, actions=2
    ... )
    >>> policy = solve(model, "F end", lambda s: {"end": s == 2}).policy
    >>> s, q = 0, policy.reset(0)
    >>> while not policy.is_over(q):
    ...     s += policy(q, s)
    ...     q = policy.next(q, s)
    >>> s
    2
    """
    @staticmethod
    def from_json(text: str) -> Policy:
        """The policy of a document, as `to_json` writes it.

        Raises `ValueError` if it is not one; the message names the field.
        """
    def to_json(self) -> str:
        """The document of the policy, which `tltlc policy` reads too."""
    def save(self, path: _Path) -> None:
        """Writes the document to a file, which is replaced as a whole.

        Raises `OSError` if it cannot be written.
        """
    @staticmethod
    def load(path: _Path) -> Policy:
        """The policy that `save` wrote.

        Raises `ValueError` if the file holds no policy, and `OSError` if it cannot be read.
        """
    def emit_rust(self, path: _Path | None = None) -> str:
        """The policy as Rust source that needs no standard library and nothing of this package; with a
        `path` it is written there too.
        """
    def act(self, q: int, s: int) -> int:
        """The action in state `s` of the world at state `q` of the automaton.

        Raises `IndexError` if there is no such state.
        """
    def __call__(self, q: int, s: int) -> int: ...
    def reset(self, s: int) -> int:
        """The automaton state after `s`, the first state of an episode, was read."""
    def next(self, q: int, s: int) -> int:
        """The automaton state after `q` has read `s`."""
    def is_over(self, q: int) -> bool:
        """Whether the task is satisfied or lost at `q`."""
    @property
    def table(self) -> NDArray[np.int64]:
        """All actions: int64, of shape (automaton states, states)."""
    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]: ...
    @property
    def name(self) -> str:
        """The name of its task."""
    @property
    def formula(self) -> str:
        """The formula of its task."""
    @property
    def certificate(self) -> Certificate | None:
        """What it is worth, if it says so."""
    @property
    def training(self) -> tuple[dict[str, Any], ...]:
        """How it was learned: for each skill a mapping with `task`, `steps`, `episodes` and `seed`;
        nothing if it was computed.
        """
    def check(self, model: FiniteModel, task: Task | str, labels: _Labels) -> None:
        """Nothing, if it is a policy for this task in this world; `labels` as for `solve`.

        Raises `ValueError` if the automaton moves differently on some state of the world.
        """
    def __eq__(self, other: object, /) -> bool: ...
    def __hash__(self) -> int: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class NetworkPolicy:
    """A policy that is a network: features of a state in, for each automaton state in which the task
    goes on a value of each action out. `tltl.sb3.export` makes it of what was learned elsewhere.

    It does not move the automaton: the task does.
    """
    @staticmethod
    def from_json(text: str) -> NetworkPolicy:
        """The policy of a document, as `to_json` writes it.

        Raises `ValueError` if it is not one; the message names the field.
        """
    def to_json(self) -> str:
        """The document of the policy, which `tltlc policy` reads too."""
    def save(self, path: _Path) -> None:
        """Writes the document to a file, which is replaced as a whole."""
    @staticmethod
    def load(path: _Path) -> NetworkPolicy:
        """The policy that `save` wrote."""
    def emit_rust(self, path: _Path | None = None) -> str:
        """The policy as Rust source that needs no standard library and nothing of this package; with a
        `path` it is written there too.
        """
    def values(self, q: int, inputs: NDArray[np.float32]) -> NDArray[np.float32]:
        """The values of the actions at `q`, of float32 inputs of shape (inputs,): float32, of shape
        (actions,).

        Raises `IndexError` if the task does not go on at `q`.
        """
    def act(self, q: int, inputs: NDArray[np.float32]) -> int:
        """The action of the largest value at `q`.

        Raises `ValueError` if an action is numbers: `control` has them.
        """
    def control(self, q: int, inputs: NDArray[np.float32]) -> NDArray[np.float32]:
        """The numbers that the action at `q` is: float32, of shape (actions,). Only for networks of
        continuous actions, as those of SAC, TD3, and PPO in a `Box`.

        Raises `ValueError` if the policy chooses among actions: `act` does.
        """
    @property
    def formula(self) -> str:
        """The formula of its task."""
    def __eq__(self, other: object, /) -> bool: ...
    def __reduce__(self) -> tuple[Any, ...]: ...

@final
class Shield:
    """Which actions are allowed at each automaton state and state: at least one. `Solution.shield` makes
    it.

    >>> from tltl import FiniteModel, solve
    >>> # Five cells in a row: action 0 goes left, action 1 right. Reach the right end, and keep off
    >>> # the left one.
    >>> ways = [cell for s in range(5) for cell in (max(s - 1, 0), min(s + 1, 4))]
    >>> model = FiniteModel.from_arrays(range(11), ways, [1.0] * 10, actions=2)
    >>> best = solve(model, "!left U right", lambda s: {"left": s == 0, "right": s == 4})
    >>> best.shield().mask(0, 1).tolist(), best.shield().mask(0, 2).tolist()
    ([False, True], [True, True])
    """
    @property
    def task(self) -> Task | None:
        """The task that it is for; `None` for a composition."""
    @property
    def epsilon(self) -> float | None:
        """What is promised: by how much P(lost) of any policy of allowed actions may exceed the smallest."""
    @property
    def masks(self) -> NDArray[np.bool_]:
        """All that is allowed: bool, of shape (automaton states, states, actions)."""
    def mask(self, q: int, s: int) -> NDArray[np.bool_]:
        """What is allowed in state `s` at `q`: bool, of shape (actions,).

        Raises `IndexError` if there is no such state.
        """
    def policy(self, policy: _Policy) -> Policy:
        """The policy under the shield: its own action where that is allowed, else the allowed one of the
        smallest number. What the shield costs and gains stands in its document.
        """
    def certify(self, policy: _Policy) -> Shielded:
        """What the shield costs and gains when it is laid over a policy, given as for
        `Solution.certify`, and what the actions that it allows can come to.
        """
    def __copy__(self) -> Shield: ...
    def __deepcopy__(self, memo: Any, /) -> Shield: ...

@final
class Shielded:
    """What a shield costs and gains over a policy: means over the starts."""
    @property
    def before(self) -> Certificate:
        """What the policy is worth without the shield."""
    @property
    def after(self) -> Certificate:
        """What it is worth under it."""
    @property
    def lost_before(self) -> float:
        """P(lost) without the shield."""
    @property
    def lost_after(self) -> float:
        """P(lost) under it."""
    @property
    def smallest_lost(self) -> float:
        """The smallest possible P(lost)."""
    @property
    def overruled(self) -> float:
        """The fraction of pairs in which the shield overrules the policy."""
    @property
    def fraction_allowed(self) -> float | None:
        """The fraction of actions that are allowed."""
    @property
    def lost_allowed(self) -> float | None:
        """The largest P(lost) of any policy of allowed actions."""
    @property
    def satisfied_allowed(self) -> float | None:
        """The largest P(satisfied) of any policy of allowed actions."""

@final
class Schedule:
    """A number that changes while learning goes on."""
    @staticmethod
    def constant(value: float) -> Schedule:
        """Always the same."""
    @staticmethod
    def linear(start: float, end: float, steps: int) -> Schedule:
        """From one value to another in so many steps, and the other from then on."""
    @staticmethod
    def harmonic(start: float, half: float) -> Schedule:
        """`start * half / (half + n)`: half of the start after `half`."""
    def at(self, n: int) -> float:
        """The value at `n`."""
    def __eq__(self, other: object, /) -> bool: ...

@final
class Settings:
    """How a table is learned. The default learns what the task wants: it pays for acceptance, explores
    towards what was tried least, and keeps its experience, so that the policy is that of the world as it
    was seen, solved.

    - `alpha`: the step size, at the number of earlier updates of the same entry.
    - `epsilon`: the probability of an action that explores, at the number of earlier steps.
    - `exploration`: `"coverage"`, towards what was tried least, or `"random"`.
    - `horizon`: steps after which an episode is cut.
    - `counterfactual`: whether a step updates all automaton states, or only the one it was taken in.
    - `initial`: the value that entries start from.
    - `remember`: whether experience is kept; without it the policy is the greedy one of the table.

    Raises `ValueError` for what is out of its range, by its name.

    >>> from tltl import Schedule, Settings
    >>> Settings(epsilon=Schedule.linear(1.0, 0.05, 100_000), horizon=500).horizon
    500
    """
    def __new__(
        cls,
        *,
        rewards: Rewards | None = None,
        alpha: Schedule | float | None = None,
        epsilon: Schedule | float | None = None,
        exploration: Literal["random", "coverage"] = "coverage",
        horizon: int = 200,
        counterfactual: bool = True,
        initial: float = 0.0,
        remember: bool = True,
    ) -> Settings: ...
    @staticmethod
    def paper() -> Settings:
        """The recipe of the paper: `progress` with γ 0.95, α 0.1, random exploration, one update a step,
        no memory.
        """
    @property
    def rewards(self) -> Rewards:
        """What is paid, and the discount factor."""
    @property
    def alpha(self) -> Schedule:
        """The learning rate, by the visits of a pair and action."""
    @property
    def epsilon(self) -> Schedule:
        """The probability of a random action, by steps."""
    @property
    def exploration(self) -> str:
        """`random`, or `coverage`: what was tried least."""
    @property
    def horizon(self) -> int:
        """The steps after which an episode is cut."""
    @property
    def counterfactual(self) -> bool:
        """Whether each step updates all automaton states."""
    @property
    def initial(self) -> float:
        """The action values at the start."""
    @property
    def remember(self) -> bool:
        """Whether transitions are counted, so that the policy solves what was seen."""
    def __eq__(self, other: object, /) -> bool: ...

@final
class Learner:
    """A tabular learner of a task in a finite world, of which it sees samples only.

    The world is a `FiniteModel`, and then no Python runs while it learns, and other threads do. Or it
    is an environment of Gymnasium whose observations and actions are numbers (`Discrete`,
    `MultiDiscrete`, `MultiBinary`, or `Tuple` of them), which are numbered from 0, the last axis
    fastest. What ends an episode there is the environment's own matter, and an exception in it stops
    training, with what was learned until then.

    `labels` as for `solve`, of an observation for an environment. All that is random comes from
    `seed`: the same arguments give the same policy.

    >>> import gymnasium as gym
    >>> from tltl import FiniteModel, Learner, solve
    >>> model = FiniteModel.from_env(gym.make("FrozenLake-v1", is_slippery=False))
    >>> task, labels = "corner T goal", lambda s: {"corner": s == 3, "goal": s == 15}
    >>> learner = Learner(model, task, labels, seed=1).train(50_000)
    >>> worth = learner.certify(solve(model, task, labels))
    >>> worth.satisfied, worth.steps
    (1.0, 8.0)
    """
    def __new__(
        cls,
        world: Any,
        task: Task | str,
        labels: _Labels,
        *,
        settings: Settings | None = None,
        seed: int = 0,
    ) -> Learner: ...
    def train(self, steps: int) -> Learner:
        """Trains until so many steps have been taken in all, and returns the learner. Episodes are whole,
        so the last one may exceed it; slices change nothing.

        Ctrl-C stops between episodes: what was learned is kept.
        """
    def policy(self) -> Policy:
        """The policy that was learned: that of the world as it was seen, solved. It says how it was
        learned. Each call solves anew.
        """
    def certify(self, solution: Solution) -> Certificate:
        """What `policy` is worth in the model that was solved.

        Raises `ValueError` if that is another task or another world.
        """
    @property
    def Q(self) -> NDArray[np.float64]:
        """The action values of the world as it was seen: float64, of shape (automaton states, states,
        actions).
        """
    @property
    def experience(self) -> FiniteModel:
        """The world as it was seen: a model with the frequencies as probabilities. An action that was
        never tried in a state stays there.

        Raises `ValueError` where nothing is remembered.
        """
    @property
    def world(self) -> Any:
        """What it learns in."""
    @property
    def task(self) -> Task:
        """The task that it learns."""
    @property
    def settings(self) -> Settings:
        """How it learns."""
    @property
    def seed(self) -> int:
        """The seed."""
    @property
    def steps(self) -> int:
        """Steps so far."""
    @property
    def episodes(self) -> int:
        """Episodes so far."""
    def save(self, path: _Path) -> None:
        """Writes all that learning has changed to a file, which is replaced as a whole.

        Raises `OSError` if it cannot be written.
        """
    def load(self, path: _Path) -> Learner:
        """Goes on where the learner was that wrote the file, with its settings and its seed: the same
        numbers as without a break.

        Raises `ValueError` if that learner had another task or another world.
        """

def compose(
    operator: Literal["and", "or", "then"], skills: Sequence[Learner | Solution]
) -> Composition:
    """Composes skills (Algorithm 2 of the paper) without a step in the world: the conjunction (`"and"`),
    disjunction (`"or"`) or sequence (`"then"`) of their tasks.

    `skills` are learners or solutions of the same world. What was learned is composed on what was
    seen, that of all learners together; with a solution among them, on its model, and then it is
    exact.

    Raises `ValueError` if the skills are of different worlds or learned for different rewards, or if
    their product has more than 100,000 states.
    """
@final
class Composition:
    """A skill that was composed of others."""
    @property
    def steps(self) -> tuple[tuple[str, Certificate], ...]:
        """The steps of Algorithm 2, each as (name, certificate): the skills' values combined, what they
        count twice taken off, and refined to the optimum of the product. The certificates are for the
        world that was composed on.
        """
    @property
    def policy(self) -> Policy:
        """The policy of the best step."""
    def solve(self, model: FiniteModel) -> Solution:
        """What is optimal for the composed task in a model of the world, to certify `policy` by: its
        automaton is the product, whose states are not those of a formula that is compiled.

        Raises `ValueError` if the model is of another world.
        """
    def _repr_html_(self) -> str: ...
