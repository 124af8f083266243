"""What Network.tune() returns.

SPDX-License-Identifier: MIT
"""
from __future__ import annotations

from typing import Any, Dict, Iterable, List, Optional

from . import _header


class TuneTable(List[Dict[str, Any]]):
    """Rows of a tuning as dicts, with the names and units of mspring_tune_row: costs in s, errors in m or as shares.

    Numbers that were not measured are None. is_recommended, is_pareto, is_rejected and is_chaotic are the flags.
    settings is a dict for Network.set_settings(); solver, integrator, substeps and others of it are columns, too.
    """

    _NEEDS = {"cost": _header.TUNE_HAS_COST, "trajectory": _header.TUNE_HAS_TRAJECTORY, "rest": _header.TUNE_HAS_REST,
              "scene": _header.TUNE_HAS_SCENE}
    _MEASURED_WITH = {"energy_drift": "trajectory", "duration": "trajectory", "bending": "rest", "fine_mean": "scene",
                      "fine_spread": "scene", "fine_substeps": "scene", "scene_cost": "scene", "resting_cost": "cost"}

    _SETTINGS = ("solver", "integrator", "substeps", "iterations", "residual", "tile_size", "coarse_period")

    def __init__(self, rows: Iterable[Any]):
        super().__init__(self._row(row._asdict()) for row in rows)

    def _row(self, row: Dict[str, Any]) -> Dict[str, Any]:
        flags = row.pop("flags")
        for name in row:
            words = [part for part in self._NEEDS if part in name.split("_")]
            needs = self._MEASURED_WITH.get(name, words[0] if words else None)
            if needs and not flags & self._NEEDS[needs]:
                row[name] = None
        row["settings"] = row["settings"]._asdict()
        row.update((name, row["settings"][name]) for name in self._SETTINGS)
        row["solver"], row["integrator"] = row["solver"].name.lower(), row["integrator"].name.lower()
        row["is_recommended"] = bool(flags & _header.TUNE_RECOMMENDED)
        row["is_pareto"] = bool(flags & _header.TUNE_PARETO)
        row["is_rejected"] = bool(flags & _header.TUNE_REJECTED)
        row["is_chaotic"] = bool(flags & _header.TUNE_CHAOTIC)
        return row

    @property
    def recommended(self) -> Optional[Dict[str, Any]]:
        """The recommended row, or None."""
        return next((row for row in self if row["is_recommended"]), None)

    def columns(self) -> Dict[str, List[Any]]:
        """The table by columns."""
        return {name: [row[name] for row in self] for name in (self[0] if self else ())}

    def frame(self) -> Any:
        """The table as a pandas.DataFrame. It needs pandas."""
        import pandas
        return pandas.DataFrame(list(self))
