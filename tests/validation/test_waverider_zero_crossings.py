"""Zero-up-crossing statistics of raw Waverider records against what the buoy's own software found.

Source: Datawell Waverider, July 2005 (buoy_displacement of the shared data): raw displacement at 1.28 Hz and the .hiw
file with the zero-crossing results. How that software rounds N/3 and N/10 is not documented: one wave more or less in
the share moves the mean by 0.1 to 0.2 %, which is the tolerance of the significant values.
"""

import numpy as np
import pytest

from moyai.series import wave_statistics
from moyai.series.zero_crossing import split_waves

pytestmark = pytest.mark.shared_data

# .hiw rows: largest height and its period, H1/10, H1/3, T1/3, mean height and period [cm, s], number of waves
RECORDS = {
    "00h00": (511.0, 11.68, 377.26, 308.66, 10.48, 193.34, 7.79, 230),
    "00h30": (466.0, 12.70, 372.56, 298.64, 10.17, 180.85, 7.08, 253),
    "12h00": (542.0, 7.74, 388.20, 305.81, 9.21, 188.52, 7.20, 249),
    "18h30": (523.0, 10.09, 406.32, 321.10, 9.25, 201.56, 7.15, 250),
}


def cycles_of(shared_data, hour):
    heave = np.genfromtxt(shared_data / "buoy_displacement" / f"buoy}}2005-07-01T{hour}Z.raw", delimiter=",")[:, 1]
    return split_waves(np.arange(heave.size) / 1.28, heave, mean_level=0.0)


@pytest.mark.parametrize("hour", ["00h00", "00h30"])
def test_records_of_which_the_software_used_every_wave(shared_data, hour):
    highest, period, tenth, third, third_period, mean, mean_period, count = RECORDS[hour]
    cycles = cycles_of(shared_data, hour)
    assert len(cycles) == count
    assert cycles.height.max() == highest
    assert cycles.period[np.argmax(cycles.height)] == pytest.approx(period, abs=0.02)
    assert cycles.height.mean() == pytest.approx(mean, abs=0.006)
    assert cycles.period.mean() == pytest.approx(mean_period, abs=0.006)
    assert wave_statistics.significant(cycles.height, 0.1) == pytest.approx(tenth, rel=2e-3)
    assert cycles.significant_height() == pytest.approx(third, rel=2e-3)
    assert cycles.significant_period() == pytest.approx(third_period, rel=6e-3)


@pytest.mark.parametrize("hour", RECORDS)
def test_all_records(shared_data, hour):
    """The software drops up to four waves of the later records, so means differ by their share."""
    highest, _, tenth, third, _, mean, _, count = RECORDS[hour]
    cycles = cycles_of(shared_data, hour)
    assert abs(len(cycles) - count) <= 4
    assert cycles.height.max() == highest
    assert wave_statistics.significant(cycles.height, 0.1) == pytest.approx(tenth, rel=0.012)
    assert cycles.significant_height() == pytest.approx(third, rel=0.012)
    assert cycles.height.mean() == pytest.approx(mean, rel=0.016)
