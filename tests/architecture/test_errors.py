"""Physics names the parameters of its own calls; only readers of files and commands name keys and options."""

from source_files import FILES, SOURCE, findings, findings_of_text

PHYSICS = {
    *("sea", "tables", "series", "potential", "morison", "mooring", "flexible", "floating", "coupled", "design"),
    *("structures", "records"),
}
ROLES = {"case", "report"}
#: Sentences that name keys on purpose.
ALLOWED = {
    "records/survey/campaign.py": "x_axis_bearing_deg",  # writes the file of a campaign
    "structures/curtain/headlines.py": "settings.dynamic",  # `Band.more`: the key that more of is run by
}


def test_physics_names_parameters_and_no_keys():
    wrong = []
    for path in FILES:
        parts = path.relative_to(SOURCE).parts
        if parts[0] in PHYSICS and not ROLES & set(parts):
            name = path.relative_to(SOURCE).as_posix()
            found = findings()[path].keys_of_files
            wrong += [f"{name}, {fault}" for fault in found if ALLOWED.get(name, "\0") not in fault]
    assert not wrong, "\n".join(wrong) + "\nwhere a parameter comes from in a case file, its case/keys.py says"


def test_the_check_sees_keys_and_paths():
    text = 'raise InputError("x", path="mass")\nraise InputError("x", parameter=f"structure.{name}")\n'
    assert len(faults_of(text + 'raise InputError("x", parameter="waves.heading_deg")\n')) == 3
    assert not faults_of('raise InputError("x", parameter="lines.north.anchor")')
    assert (
        len(faults_of('raise InputError("x", remedy="give structure.skirt")\nNotice("a", f"{x}, see settings.step")'))
        == 2
    )
    assert len(faults_of('REMEDY = "give slope_deg"')) == 1
    assert not faults_of('def f():\n    """Read settings.step of a case."""\n    return "give the step"')


def faults_of(text):
    return findings_of_text(text, ("sea", "imaginary.py")).keys_of_files
