"""Capytaine on a long pontoon: read a case as JSON from the standard input, print coefficients and CPU seconds as JSON.

Run by ``bench_potential.py`` in an interpreter that has Capytaine. Three-dimensional panels on a box of length L: sway,
heave and roll radiation and beam-sea diffraction, coefficients per metre of length.
"""

from __future__ import annotations

import json
import resource
import sys
import time


def main() -> None:
    """Solve the case once and print the result."""
    case = json.load(sys.stdin)
    import capytaine
    import numpy as np

    capytaine.set_logging("ERROR")
    beam, draught, length = case["beam"], case["draught"], case["length"]
    size = np.sqrt((length * beam + 2.0 * draught * (length + beam)) / case["panels"])
    even = [max(2, 2 * round(extent / size / 2)) for extent in (length, beam)]
    mesh = capytaine.mesh_parallelepiped(
        size=(beam, length, draught),
        center=(0.0, 0.0, -draught / 2.0),
        resolution=(even[1], even[0], max(2, round(draught / size))),
        missing_sides={"top"},
        reflection_symmetry=True,
    )
    lid = mesh.generate_lid() if case["lid"] else None
    body = capytaine.FloatingBody(mesh=mesh, lid_mesh=lid, center_of_mass=(0.0, 0.0, 0.0))
    centres = body.mesh.faces_centers
    dofs = {name: np.zeros((body.mesh.nb_faces, 3)) for name in ("sway", "heave", "roll")}
    dofs["sway"][:, 0] = 1.0
    dofs["heave"][:, 2] = 1.0
    dofs["roll"][:, 0], dofs["roll"][:, 2] = centres[:, 2], -centres[:, 0]
    body.dofs = dofs

    depth = np.inf if case["depth"] is None else case["depth"]
    problems = []
    for omega in case["omega"]:
        problems += [
            capytaine.RadiationProblem(
                body=body, omega=omega, water_depth=depth, radiating_dof=name, rho=case["density"]
            )
            for name in dofs
        ]
        problems.append(
            capytaine.DiffractionProblem(
                body=body, omega=omega, water_depth=depth, wave_direction=0.0, rho=case["density"]
            )
        )
    solver = capytaine.BEMSolver()
    started = time.process_time()
    results = solver.solve_all(problems, progress_bar=False, keep_details=False)
    spent = time.process_time() - started
    added = {name: [] for name in dofs}
    damping = {name: [] for name in dofs}
    for result in results:
        if isinstance(result.problem, capytaine.RadiationProblem):
            name = result.problem.radiating_dof
            added[name].append(result.added_masses[name] / length)
            damping[name].append(result.radiation_dampings[name] / length)
    print(
        json.dumps(
            {
                "version": capytaine.__version__,
                "panels": int(body.mesh.nb_faces),
                "cpu_s": spent,
                "peak_rss_mb": resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024.0,
                "added_mass": added,
                "radiation_damping": damping,
            }
        )
    )


if __name__ == "__main__":
    main()
