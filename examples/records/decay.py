"""Free decay of a sphere as six programs computed it: period, damping, and the spread between them.

``python examples/records/decay.py``. The curves are simulations of the IEA OES Task 10 sphere, not measurements.
"""

from shared_folder import shared_folder

from moyai.records.reading.reader import read_record
from moyai.records.reading.sources import ColumnSource, LoggerSource, TimeSource
from moyai.records.reading.text import find_layout
from moyai.records.survey.motions import fit_decay_record


def analyse():
    """Return the decay of every program."""
    path = shared_folder() / "decay_rao" / "oes_task10_sphere_decay_codes.txt"
    probe = LoggerSource("codes", (path,), (ColumnSource(1, "t"),), TimeSource((1,)))
    names = find_layout(path, probe).headings[1:]
    columns = tuple(ColumnSource(place, name, "m") for place, name in enumerate(names, 2))
    record = read_record(LoggerSource("codes", (path,), columns, TimeSource((1,))))
    return {
        name: fit_decay_record(record.time, record[name], start=0.0, equilibrium=0.0, smallest=0.03) for name in names
    }


def main():
    for name, found in analyse().items():
        decay = found.decay
        second = decay.extremes[1] if decay.extremes[0] < 0.99 else decay.extremes[2]
        print(f"{name}: period {decay.period:.3f} +- {found.period_error:.3f} s, second peak {second:.3f} m")
        print(
            f"  damping ratio {decay.damping_ratio:.4f} +- {found.damping_error:.4f}, quadratic "
            f"{decay.quadratic_over_inertia:.4f} +- {found.quadratic_error:.4f} 1/m"
        )


if __name__ == "__main__":
    main()
