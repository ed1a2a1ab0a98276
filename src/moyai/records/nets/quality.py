"""Faults of the records of nets by the quality control of all records: clipped gauges, spikes, flat lines."""

from __future__ import annotations

import numpy as np

from moyai.core.validity import Notice
from moyai.records.nets.runs import NetRun
from moyai.records.reading.quality import QualityOptions, find_clipped, find_flat, find_spikes

#: A force may rest while the carriage stands; a meter or a gauge in waves may not
_OPTIONS = QualityOptions(flat_seconds=5.0, clip_samples=4)
#: Fewer different values make a logger coarse
_FEW_LEVELS = 40
_REMEDIES = {
    "clipped": "use a wider range of the gauge; the coefficients are too small",
    "spikes": "correct single samples, or choose a part without them",
    "flat": "choose a part in which the channel varies",
}


def record_notices(run: NetRun) -> list[Notice]:
    """Tell which channels of a run stand at a limit, hold spikes or stand still.

    Parameters
    ----------
    run : NetRun
    """
    notices = []
    for name in ("force", "velocity", "elevation"):
        values = getattr(run, name)
        if values is None:
            continue
        # a coarse logger rests on its few levels without standing at a limit
        coarse = np.unique(values).size < _FEW_LEVELS
        found = {
            "clipped": 0 if coarse else int(find_clipped(values, _OPTIONS).sum()),
            "spikes": int(find_spikes(values, _OPTIONS).sum()),
            "flat": int(find_flat(values, run.step, _OPTIONS).sum()) if run.kind != "still_water" else 0,
        }
        for kind, count in found.items():
            if count == 0:
                continue
            words = {"clipped": "are at the limit of the gauge", "spikes": "are spikes", "flat": "are constant"}[kind]
            notices.append(
                Notice(
                    f"net-record-{kind}",
                    f"run {run.name}: {count} of {values.size} samples of the {name} {words}",
                    float(count),
                    0.0,
                    "warning",
                    _REMEDIES[kind],
                )
            )
    return notices
