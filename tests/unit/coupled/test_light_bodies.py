"""A body much lighter than the half bars of the lines on it: its reaction is found all the same."""

import numpy as np
import pytest

from moyai.coupled.simulate import simulate_coupled
from moyai.flexible import simulate
from moyai.flexible.motion import Motion
from moyai.interop.moordyn_network import to_network
from moyai.interop.moordyn_reader import read_deck
from moyai.interop.moordyn_system import to_system

#: Three lines of 250 kg a bar meet a body of 36 kg, at its middle and at the ends of a rod of 0.2 m.
DECK = """\
--- MoorDyn ---
a clamp between heavy lines
--- LINE TYPES ---
TypeName Diam Mass/m EA BA/-zeta EI Cd Ca CdAx CaAx
(name) (m) (kg/m) (N) (N-s/-) (N-m^2) (-) (-) (-) (-)
cable 0.116 25 362e6 -1.0 0 1.1 1.0 0.0 0.0
--- ROD TYPES ---
TypeName Diam Mass/m Cd Ca CdEnd CaEnd
(name) (m) (kg/m) (-) (-) (-) (-)
clamp 0.116 25 1.2 1.0 1.2 1.0
--- BODIES ---
ID Attachment X0 Y0 Z0 r0 p0 y0 Mass CG* I* Volume CdA* Ca*
(#) (-) (m) (m) (m) (deg) (deg) (deg) (kg) (m) (kg-m^2) (m^3) (m^2) (-)
1 Free 0 0 -50 0 0 0 29.5 0 0.098 0.014 0.5 1.0
--- RODS ---
ID RodType Attachment Xa Ya Za Xb Yb Zb NumSegs RodOutputs
(#) (name) (#/key) (m) (m) (m) (m) (m) (m) (-) (-)
1 clamp Body1 0.1 0 0 -0.1 0 0 1 -
--- POINTS ---
ID Type X Y Z Mass Volume CdA Ca
(#) (-) (m) (m) (m) (kg) (m^3) (m^2) (-)
1 Fixed 30 0 -40 0 0 0 0
2 Fixed -30 0 -40 0 0 0 0
3 Fixed 0 3 -57 0 0 0 0
4 Body1 0 0 0 0 0 0 0
--- LINES ---
ID LineType AttachA AttachB UnstrLen NumSegs LineOutputs
(#) (name) (#) (#) (m) (-) (-)
1 cable 1 R1A 31.4 3 -
2 cable 2 R1B 31.4 3 -
3 cable 3 4 7.7 1 -
--- OPTIONS ---
200 WtrDpth
--- need this line ---
"""


@pytest.mark.slow
def test_three_heavy_lines_on_a_light_clamp(tmp_path):
    (tmp_path / "deck.txt").write_text(DECK)
    system = to_system(read_deck(tmp_path / "deck.txt"))
    found = simulate_coupled(system.network, system.bodies, duration=0.3, output_step=0.05)
    assert found.status == "converged", found.message
    assert all(check.passed for check in found.checks)
    # nearly the same as a free point of its mass and volume where all lines meet
    head, rest = DECK.split("--- ROD TYPES ---")
    tail = rest[rest.index("--- POINTS ---") :].replace("R1A", "4").replace("R1B", "4")
    added = 34.5 - 29.5  # of the rod
    for place, nearer in (("1 Fixed 30 0", "1 Fixed 29.9 0"), ("2 Fixed -30 0", "2 Fixed -29.9 0")):
        tail = tail.replace(place, nearer)  # from the middle as far as from the ends of the rod
    tail = tail.replace("4 Body1 0 0 0 0 0 0 0", f"4 Free 0 0 -50 {29.5 + added} 0.0161 0.5 1.0")
    (tmp_path / "lump.txt").write_text(head + tail)
    network = to_network(read_deck(tmp_path / "lump.txt"))
    lump = simulate(network, {}, duration=0.3, output_step=0.05)
    fallen = lump.position[:, network.points["point 4"], 2] - lump.position[0, network.points["point 4"], 2]
    body = found.bodies["body 1"].position[:, 2] - found.bodies["body 1"].position[0, 2]
    assert abs(fallen[-1]) > 0.05
    np.testing.assert_allclose(body, fallen, atol=0.05 * abs(fallen[-1]))


@pytest.mark.slow
@pytest.mark.shared_data
def test_the_riser_deck_goes_on(shared_data):
    from moyai.coupled.equilibrium import find_coupled_equilibrium

    system = to_system(read_deck(shared_data / "moordyn_decks" / "riser" / "riser.txt"))
    rest = find_coupled_equilibrium(system.network, system.bodies)
    still = Motion(0.0, 1.0, np.zeros((3, 3)), np.zeros((3, 3)))
    found = simulate_coupled(
        rest.network, rest.bodies, duration=0.05, output_step=0.01, start=rest.state, motions={"point 4": still}
    )
    assert found.status == "converged", found.message
