"""Sweeps: one function over a grid of parameters, in processes, on a cluster, or as jobs of an array.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

import hashlib
import json
import os
import pickle
from itertools import product
from pathlib import Path
from typing import Any, Callable, Dict, Iterable, Iterator, List, Mapping, Optional, Tuple, Union

import numpy as np

Case = Dict[str, Any]


def cases(grid: Mapping[str, Iterable[Any]]) -> List[Case]:
    """All combinations of a grid's values, the last name's changing first."""
    return [dict(zip(grid, values)) for values in product(*grid.values())]


def _plain(value: Any) -> Any:
    """What JSON can hold, exactly."""
    if isinstance(value, np.ndarray):
        return [_plain(item) for item in value.tolist()]
    if isinstance(value, np.generic):
        return _plain(value.item())
    if isinstance(value, dict):
        return {str(name): _plain(item) for name, item in value.items()}
    if isinstance(value, (list, tuple)):
        return [_plain(item) for item in value]
    if value is None or isinstance(value, (bool, int, float, str)):
        return value
    raise TypeError(f"a result is {value!r}: it must consist of numbers, texts, arrays, lists and dicts")


def _text(value: Any) -> str:
    return json.dumps(value, sort_keys=True)


class SweepResult:
    """Results in the order of cases(grid). hash is that of all: the same whichever worker did which."""

    def __init__(self, all_cases: List[Case], results: List[Any]):
        self.cases, self.results = all_cases, results

    @property
    def hash(self) -> str:
        sum_ = hashlib.sha256()
        for case, result in zip(self.cases, self.results):
            sum_.update(f"{_text(_plain(case))} {_text(result)}\n".encode())
        return sum_.hexdigest()

    def __len__(self) -> int:
        return len(self.results)

    def __iter__(self) -> Iterator[Tuple[Case, Any]]:
        return iter(zip(self.cases, self.results))

    def frame(self) -> Any:
        """A row for each case, as a pandas.DataFrame: its parameters, and its result or, of dicts, its entries. It needs pandas."""
        import pandas
        return pandas.DataFrame([{**case, **(result if isinstance(result, dict) else {"result": result})}
                                 for case, result in self])

    def array(self, name: Optional[str] = None) -> np.ndarray:
        """Results, or one entry of results that are dicts, as an array with an axis for each name of the grid."""
        values = self.results if name is None else [result[name] for result in self.results]
        lengths = []
        for key in self.cases[0] if self.cases else ():
            lengths.append(len(dict.fromkeys(_text(_plain(case[key])) for case in self.cases)))
        return np.array(values).reshape(lengths + list(np.shape(values[0]) if values else []))


def _stored(path: Optional[Path], case: Case) -> Any:
    if path is None or not path.exists():
        return None
    had = json.loads(path.read_text(encoding="utf-8"))
    if _text(had["case"]) != _text(_plain(case)):
        raise ValueError(f"{path} is of {had['case']}, not of {case}: give each grid a folder of its own")
    return had


def _run(function: Callable[..., Any], case: Case, path: Optional[str]) -> Any:
    had = _stored(None if path is None else Path(path), case)  # of a worker of Dask that died since
    if had is not None:
        return had["result"]
    result = _plain(function(**case))
    if path is not None:  # in one piece: whoever is killed leaves no half of it
        part = Path(f"{path}.{os.getpid()}")
        part.write_text(_text({"case": _plain(case), "result": result}), encoding="utf-8")
        part.replace(path)
    return result


def _check_workers(processes: Any, engine: Any, function: Any) -> None:
    if engine is not None and not (hasattr(engine, "submit") and hasattr(engine, "gather")):
        raise TypeError(f"engine is {engine!r}: it must be a client of Dask or None; processes is a number")
    if processes is not None and (isinstance(processes, bool) or not isinstance(processes, (int, np.integer))):
        raise TypeError(f"processes is {processes!r}: it must be a number or None; engine takes a client of Dask")
    if processes is not None and engine is not None:
        raise TypeError(f"processes is {processes} beside an engine: its client knows its workers, so leave one out")
    if processes is not None and processes < 1:
        raise ValueError(f"processes is {processes}: it must be at least 1")
    if engine is None and processes != 1:
        try:
            pickle.dumps(function)
        except (pickle.PicklingError, AttributeError, TypeError):
            raise TypeError(f"function is {function!r}: other processes cannot import it. It must be one of a module, or "
                            "processes=1") from None


def _submit(processes: Optional[int], engine: Any, calls: List[Tuple[Any, ...]]) -> List[Any]:
    if engine is not None:  # a client of Dask
        return engine.gather([engine.submit(_run, *call, pure=False) for call in calls])
    if processes == 1:
        return [_run(*call) for call in calls]
    from concurrent.futures import ProcessPoolExecutor  # a third of what all of massspring's own import takes

    with ProcessPoolExecutor(processes) as pool:
        return [future.result() for future in [pool.submit(_run, *call) for call in calls]]


def sweep(function: Callable[..., Any], grid: Mapping[str, Iterable[Any]], processes: Optional[int] = None,
          folder: Union[str, Path, None] = None, shard: Tuple[int, int] = (0, 1), *,
          engine: Any = None) -> Optional[SweepResult]:
    """Call function(**case) for each combination of the grid's values.

    function   a function of a module, which other processes can import. It returns numbers, texts, arrays, lists, dicts.
    grid       values by the names of the function's arguments
    processes  a number from 1 on: 1 for none besides this one. None: one for each processor
    folder     keeps each result in a file. A sweep that was killed goes on where it was. With a cluster of several
               machines it must be one that all of them see.
    shard      (i, n): only cases i, i + n, i + 2n ... For arrays of jobs, such as Slurm's: each job takes a shard, with
               the same folder. Returns None, unless all cases are there by then.
    engine     a distributed.Client of Dask instead of processes. Its workers must be able to import function.
    """
    _check_workers(processes, engine, function)
    every = cases(grid)
    index, count = shard
    if not 0 <= index < count:
        raise ValueError(f"shard is {shard}: it must be (i, n) with 0 <= i < n")
    if count > 1 and folder is None:
        raise ValueError("shards need a folder for their results")
    paths: List[Optional[Path]] = [None] * len(every)
    if folder is not None:
        folder = Path(folder).absolute()  # workers may run elsewhere
        folder.mkdir(parents=True, exist_ok=True)
        paths = [folder / f"{number:08d}.json" for number in range(len(every))]
    had = [_stored(path, case) for path, case in zip(paths, every)]
    wanted = [number for number in range(index, len(every), count) if had[number] is None]
    calls = [(function, every[number], None if folder is None else str(paths[number])) for number in wanted]
    made = _submit(processes, engine, calls)
    for number, result in zip(wanted, made):
        had[number] = {"result": result}
    if count > 1:
        had = [one if one is not None else _stored(path, case) for one, path, case in zip(had, paths, every)]
    if any(one is None for one in had):
        return None
    return SweepResult(every, [one["result"] for one in had])
