"""Physics names the parameters of its own calls; only readers of files and commands name keys and options."""

from source_files import FILES, SOURCE, findings, findings_of_text

PHYSICS = {
    *("sea", "tables", "series", "potential", "morison", "mooring", "flexible", "floating", "coupled", "design"),
    *("structures", "records"),
}
ROLES = {"case", "report"}


def test_physics_names_parameters_and_no_keys():
    wrong = []
    for path in FILES:
        parts = path.relative_to(SOURCE).parts
        if parts[0] in PHYSICS and not ROLES & set(parts):
            wrong += [f"{path.relative_to(SOURCE)}, {fault}" for fault in findings()[path].keys_of_files]
    assert not wrong, "\n".join(wrong) + "\nwhere a parameter comes from in a case file, its case/keys.py says"


def test_the_check_sees_keys_and_paths():
    text = 'raise InputError("x", path="mass")\nraise InputError("x", parameter=f"structure.{name}")\n'
    assert len(faults_of(text + 'raise InputError("x", parameter="waves.heading_deg")\n')) == 3
    assert not faults_of('raise InputError("x", parameter="lines.north.anchor")')


def faults_of(text):
    return findings_of_text(text, ("sea", "imaginary.py")).keys_of_files
