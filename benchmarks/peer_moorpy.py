"""Peer side of bench_mooring.py and of the peer test: solves lines with MoorPy and times it.

Runs in any interpreter that has MoorPy (and needs nothing of moyai): JSON on standard input, JSON on standard output.
"""

from __future__ import annotations

import contextlib
import io
import json
import sys
import time

import numpy as np


def solve(case: dict) -> dict:
    """Solve the lines of one case; CPU seconds of the solving alone."""
    from moorpy.Catenary import catenary

    rows = case["lines"]  # X, Z, L, EA, w, CB
    tolerance = case.get("tolerance", 1e-6)
    out = []
    with contextlib.redirect_stdout(io.StringIO()):
        for x, z, length, axial, weight, cb in rows[:20]:
            catenary(x, z, length, axial, weight, CB=cb, Tol=tolerance)
        started = time.process_time()
        for x, z, length, axial, weight, cb in rows:
            try:
                out.append(catenary(x, z, length, axial, weight, CB=cb, Tol=tolerance))
            except Exception:
                out.append(None)
        spent = time.process_time() - started
    values = []
    for item in out:
        if item is None:
            values.append(None)
            continue
        info = item[4]
        stiffness = np.asarray(info["stiffnessB"]).ravel().tolist()
        values.append([abs(info["HF"]), info["VF"], abs(info["HA"]), info["VA"], info["LBot"], *stiffness])
    return {"cpu_s": spent, "values": values}


def system(case: dict) -> dict:
    """Four chains on a floating breakwater: equilibrium under loads, stiffness, forces."""
    import moorpy as mp

    with contextlib.redirect_stdout(io.StringIO()):
        ms = mp.System(depth=case["depth"])
        ms.setLineType(50.0, material="chain", name="chain")
        kind = ms.lineTypes["chain"]
        kind["EA"], kind["m"], kind["w"], kind["d_vol"] = (
            case["axial"],
            case["mass"],
            case["weight"],
            case["volume_diameter"],
        )
        displaced = case["displacement"]
        ms.addBody(
            0,
            np.zeros(6),
            m=displaced * 1025.0,
            v=displaced,
            rCG=np.array(case["centre"]),
            AWP=case["waterplane"],
            rM=np.array(case["metacentre"]),
        )
        body = ms.bodyList[0]
        for anchor, fairlead in case["ends"]:
            ms.addPoint(1, np.array(anchor))
            ms.addPoint(1, np.array(fairlead))
            body.attachPoint(len(ms.pointList), np.array(fairlead))
            ms.addLine(case["length"], "chain", pointA=len(ms.pointList) - 1, pointB=len(ms.pointList))
        ms.initialize()
        ms.solveEquilibrium(DOFtype="both")
        loads = np.array(case["loads"])
        positions = []
        started = time.process_time()
        for load in loads:
            body.f6Ext = load
            ms.solveEquilibrium(DOFtype="free", tol=case["tolerance"])
            positions.append(np.asarray(body.r6).tolist())
        equilibrium = (time.process_time() - started) / len(loads)
        body.f6Ext = np.zeros(6)
        body.type = -1
        started = time.process_time()
        for _ in range(20):
            ms.getCoupledStiffnessA(lines_only=True)
        stiffness = (time.process_time() - started) / 20
        started = time.process_time()
        for k in range(50):
            body.setPosition(np.array([0.5 * np.sin(0.1 * k), 0, 0.2 * np.cos(0.1 * k), 0, 0.01 * np.sin(0.1 * k), 0]))
            for line in ms.lineList:
                line.staticSolve()
            body.getForces(lines_only=True)
        step = (time.process_time() - started) / 50
    return {"equilibrium_s": equilibrium, "stiffness_s": stiffness, "forces_s": step, "positions": positions}


if __name__ == "__main__":
    case = json.load(sys.stdin)
    from importlib import metadata

    answer = {"solve": solve, "system": system}[case["what"]](case)
    answer["version"] = metadata.version("moorpy")
    json.dump(answer, sys.stdout)
