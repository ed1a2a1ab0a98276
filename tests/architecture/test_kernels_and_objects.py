"""Kernels neither read nor write; problem, case and result objects are frozen; nobody prints or debugs; no condition
is empty."""

import pytest
from source_files import SOURCE, findings, findings_of_text

RULES = {
    "kernels_that_talk": "@njit(cache=True)\ndef f(x):\n    print(x)\n",
    "prints": "def f(x):\n    breakpoint()\n",
    "mutable_dataclasses": "@dataclass(frozen=False)\nclass Found:\n    x: float\n",
    "mutable_models": "class Base(BaseModel):\n    x: float\n",
    "bare_excepts": "try:\n    x = 1\nexcept:\n    x = 2\n",
    "empty_conditions": "if TYPE_CHECKING:\n    pass\n",
}


@pytest.mark.parametrize("rule", RULES)
def test_no_module_breaks_the_rule(rule):
    wrong = [
        f"{path.relative_to(SOURCE)}, {fault}" for path, found in findings().items() for fault in getattr(found, rule)
    ]
    assert not wrong, "\n".join(wrong)


@pytest.mark.parametrize("rule", RULES)
def test_the_check_sees_a_breach(rule):
    found = findings_of_text(RULES[rule], ("sea", "imaginary.py"))
    assert len(getattr(found, rule)) == 1


def test_what_is_allowed_is_no_breach():
    text = (
        "@dataclass(frozen=True)\nclass Found:\n    x: float\n\n"
        "@dataclass\nclass _Filled:\n    x: float\n\n"
        "class Base(BaseModel):\n    model_config = ConfigDict(frozen=True)\n\n"
        "def f():\n    try:\n        open('file')\n    except OSError:\n        pass\n"
    )
    found = findings_of_text(text, ("sea", "imaginary.py"))
    assert not any(getattr(found, rule) for rule in RULES)
    assert not findings_of_text("print('ready')\n", ("cli", "imaginary.py")).prints
