"""Tasks with structure in time for reinforcement learning.

A task is a formula of temporal logic, compiled to its minimal automaton:

>>> import tltl
>>> task = tltl.Task("F a && F b ensuring !c")
>>> task.num_states
5
>>> q = task.step(task.initial, {"a": True, "b": False, "c": False})
>>> q = task.step(q, {"a": False, "b": True, "c": False})
>>> q == task.accepting
True

`import tltl` imports NumPy and nothing else. `tltl.gymnasium` wraps environments.
"""

from tltl._core import (
    Budget,
    Certificate,
    Composition,
    Edge,
    Factored,
    FiniteModel,
    Input,
    Learner,
    Mistake,
    Monitor,
    NetworkPolicy,
    Parameter,
    Policy,
    Product,
    Rewards,
    Run,
    Schedule,
    Settings,
    Shield,
    Shielded,
    Solution,
    Task,
    TaskFile,
    __version__,
    compose,
    product,
    solve,
)
from tltl._errors import CompileError, Diagnostic, TaskWarning
from tltl._labels import Labels, labels
from tltl._load import load

__all__ = [
    "Budget",
    "Certificate",
    "CompileError",
    "Composition",
    "Diagnostic",
    "Edge",
    "Factored",
    "FiniteModel",
    "Input",
    "Labels",
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
    "TaskWarning",
    "__version__",
    "compose",
    "labels",
    "load",
    "product",
    "solve",
]
