"""The numbered equations of the paper and where they stand in the code."""

from moyai.reproduce.model import Equation

EQUATIONS = (
    Equation("1", "surface of the incident wave", ("moyai.sea.dispersion.wave_number",)),
    Equation(
        "2",
        "motion in the frequency domain, with added mass, wave damping, hydrostatic and mooring restoring",
        ("moyai.floating.frequency.solve_motions",),
        "the damping of section 4.2 is a term of its own here, in addition to wave damping",
    ),
    Equation(
        "3",
        "motion in time with the memory of the water",
        ("moyai.floating.time.simulate", "moyai.potential.state_space.fit_memory"),
        "the printed memory multiplies the acceleration and is kept as such; the code integrates its derivative on the "
        "velocity, which is the same by parts",
    ),
    Equation(
        "4",
        "mean drift force by the balance of momentum",
        ("moyai.floating.drift.solve_with_drift", "moyai.floating.far_field.far_field"),
        "the print has lost an index: E times group velocity over phase velocity, times (2 C_R^2 + E_L)",
    ),
    Equation(
        "5",
        "modified catenary of Shoji with stretch of the line",
        ("moyai.mooring.shoji.solve_shoji", "moyai.mooring.catenary.solve_catenary"),
        "the left side is the height of the fairlead, printed as the distance; it needs the closure sinh(.) = w s/T_H, "
        "and is then the exact elastic catenary while some line lies on the bed",
    ),
    Equation(
        "6",
        "amplitude of motion over half the wave height",
        ("moyai.structures.breakwater.frequency.model.motion_ratio",),
        "the print has a dot over the amplitude; roll is taken as theta B/H",
    ),
    Equation(
        "7",
        "drift coefficient F*",
        ("moyai.floating.far_field.far_field",),
        "the print has the index of the group velocity wrong; with (4) it is C_R^2 + E_L/2",
    ),
)
