"""The file that nsd-fit reads."""
from __future__ import annotations

import copy
import hashlib
import json
import math
import os
import re
from dataclasses import dataclass
from typing import Any

import numpy as np


class Invalid(Exception):
    """A problem file, a table or a scene that cannot be used; `status` of sysexits.h."""

    def __init__(self, text: str, status: int = 65):
        super().__init__(text)
        self.status = status


@dataclass
class Parameter:
    name: str
    low: float
    high: float
    log: bool  # the range is uniform in the logarithm
    integer: bool
    keys: dict[str, float]  # path in the scene: factor

    def value(self, unit: float) -> float:
        """From 0 .. 1."""
        if self.log:
            x = math.exp(math.log(self.low) + unit * (math.log(self.high) - math.log(self.low)))
        else:
            x = self.low + unit * (self.high - self.low)
        return float(round(x)) if self.integer else min(max(x, self.low), self.high)

    def unit(self, value: float) -> float:
        if self.log:
            return (math.log(value) - math.log(self.low)) / (math.log(self.high) - math.log(self.low))
        return (value - self.low) / (self.high - self.low)


@dataclass
class Target:
    name: str
    value: float
    error: float | None  # standard error; None: the scatter of the seeds


@dataclass
class Problem:
    scene: dict[str, Any]
    folder: str  # where the command runs
    command: str
    parameters: list[Parameter]
    targets: list[Target]
    seed: int
    evaluations: int  # at most
    batch: int
    digest: str

    def scene_with(self, values: list[float], seed: int | None) -> dict[str, Any]:
        scene = copy.deepcopy(self.scene)
        for parameter, value in zip(self.parameters, values):
            for path, factor in parameter.keys.items():
                x = value * factor
                set_path(scene, path, int(x) if parameter.integer and x == int(x) else x)
        if seed is not None:
            scene["seed"] = seed
        return scene


def parts_of(path: str) -> list[str | int]:
    """a.b[2].c: "a", "b", 2, "c"."""
    if not re.fullmatch(r"[A-Za-z_][\w-]*(\[\d+\]|\.[A-Za-z_][\w-]*)*", path):
        raise Invalid(f"'{path}' is no path of keys such as pairs[0].mu")
    return [int(p) if p.isdigit() else p for p in re.findall(r"[\w-]+", path)]


def set_path(scene: Any, path: str, value: float) -> None:
    *way, last = parts_of(path)
    for part in way:
        try:
            scene = scene[part]
        except (KeyError, IndexError, TypeError):
            raise Invalid(f"the scene has no '{path}': '{part}' is missing") from None
    if isinstance(scene, list) and (not isinstance(last, int) or last >= len(scene)) or not isinstance(scene, (dict, list)):
        raise Invalid(f"the scene has no place for '{path}'")
    scene[last] = value


def table(data: Any, what: str, known: tuple[str, ...], needed: tuple[str, ...]) -> dict[str, Any]:
    if not isinstance(data, dict):
        raise Invalid(f"{what} is no object")
    for key in data:
        if key not in known:
            raise Invalid(f"{what} has an unknown key '{key}'; it may have {', '.join(known)}")
    for key in needed:
        if key not in data:
            raise Invalid(f"{what} has no '{key}'")
    return data


def number(data: Any, what: str) -> float:
    if isinstance(data, bool) or not isinstance(data, (int, float)) or not math.isfinite(data):
        raise Invalid(f"{what} is no finite number")
    return float(data)


def count(data: Any, what: str, low: int, high: int) -> int:
    if isinstance(data, bool) or not isinstance(data, int) or not low <= data <= high:
        raise Invalid(f"{what} is no whole number from {low} to {high}")
    return data


def read_parameter(name: str, data: Any) -> Parameter:
    what = f"parameter '{name}'"
    data = table(data, what, ("keys", "range", "log", "integer"), ("keys", "range"))
    ends = data["range"]
    if not isinstance(ends, list) or len(ends) != 2:
        raise Invalid(f"{what}: range is not [low, high]")
    low, high = (number(x, f"{what}: an end of its range") for x in ends)
    log, integer = data.get("log", False), data.get("integer", False)
    if not isinstance(log, bool) or not isinstance(integer, bool):
        raise Invalid(f"{what}: log and integer are true or false")
    if not low < high or (log and low <= 0):
        raise Invalid(f"{what}: the range [{low:g}, {high:g}] is empty" + (" or not above 0" if log else ""))
    keys = data["keys"]
    if isinstance(keys, str):
        keys = {keys: 1}
    elif isinstance(keys, list) and all(isinstance(k, str) for k in keys):
        keys = dict.fromkeys(keys, 1)
    if not isinstance(keys, dict) or not keys:
        raise Invalid(f"{what}: keys is a path, a list of paths, or an object of paths and factors")
    return Parameter(name, low, high, log, integer, {k: number(f, f"{what}: the factor of '{k}'") for k, f in keys.items()})


def read_target(name: str, data: Any) -> Target:
    what = f"target '{name}'"
    data = table(data, what, ("value", "error"), ("value",))
    error = number(data["error"], f"{what}: error") if "error" in data else None
    if error is not None and error <= 0:
        raise Invalid(f"{what}: error is not above 0")
    return Target(name, number(data["value"], f"{what}: value"), error)


def load(path: str) -> Any:
    try:
        with open(path, "rb") as f:
            text = f.read(1 << 26)
    except OSError as e:
        raise Invalid(f"{path}: {e.strerror}", 66) from None
    try:
        return json.loads(text)
    except (ValueError, RecursionError) as e:
        raise Invalid(f"{path}: not JSON: {e}") from None


NAME = re.compile(r"[A-Za-z_][\w.-]*")
RESERVED = ("evaluation", "seed", "error", "failed")


def read(path: str) -> Problem:
    """Raises Invalid."""
    data = table(load(path), path, ("scene", "parameters", "command", "targets", "seed", "evaluations", "batch"),
                 ("scene", "parameters", "command", "targets"))
    folder = os.path.dirname(os.path.abspath(path))
    scene = data["scene"]
    if isinstance(scene, str):
        scene = load(os.path.join(folder, scene))
    if not isinstance(scene, dict):
        raise Invalid(f"{path}: the scene is no object")
    if not isinstance(data["command"], str) or not data["command"].strip():
        raise Invalid(f"{path}: command is no text")
    for what in "parameters", "targets":
        if not isinstance(data[what], dict) or not 1 <= len(data[what]) <= 12:
            raise Invalid(f"{path}: {what} is no object of 1 to 12 members")
        for name in data[what]:
            if not NAME.fullmatch(name) or name in RESERVED:
                raise Invalid(f"{path}: '{name}' of {what} cannot be the name of a column")
    if set(data["parameters"]) & set(data["targets"]):
        raise Invalid(f"{path}: a parameter and a target have the same name")
    parameters = [read_parameter(name, p) for name, p in data["parameters"].items()]
    digest = hashlib.sha256(json.dumps([scene, data["parameters"], data["command"], data["targets"], data.get("seed"), data.get("batch")],
                                       sort_keys=True).encode()).hexdigest()[:16]
    problem = Problem(scene, folder, data["command"], parameters, [read_target(n, t) for n, t in data["targets"].items()],
                      count(data.get("seed", 1), f"{path}: seed", 0, 1 << 40),
                      count(data.get("evaluations", 60 * len(parameters)), f"{path}: evaluations", 1, 100000),
                      count(data.get("batch", 8), f"{path}: batch", 1, 1000), digest)
    problem.scene_with([p.value(0.5) for p in parameters], None)
    return problem


def standard(problem: Problem, values: np.ndarray) -> np.ndarray:
    """Values of parameters [n][d] from 0 to 1."""
    return np.array([[p.unit(x) for p, x in zip(problem.parameters, row)] for row in values])
