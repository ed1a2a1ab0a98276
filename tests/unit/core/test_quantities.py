"""Numbers with units: exact conversion, and refusal with the reason."""

import math
import string
from fractions import Fraction

import pytest
from hypothesis import given
from hypothesis import strategies as st

from moyai.core import quantities as q
from moyai.core.errors import InputError
from moyai.core.quantities import from_si, parse_quantity, to_si
from moyai.core.units import parse_unit, unit_table

KINDS = [value for value in vars(q).values() if isinstance(value, q.QuantityKind)]


@pytest.mark.parametrize(
    ("text", "kind", "expected"),
    [
        ("1.05 m", q.LENGTH, 1.05),
        ("10 cm", q.LENGTH, 0.1),
        ("380mm", q.LENGTH, 0.38),
        ("1 ft", q.LENGTH, 0.3048),
        ("12 in", q.LENGTH, 0.3048),
        ("79.2 kg/m", q.MASS_PER_LENGTH, 79.2),
        ("5e6 N", q.FORCE, 5e6),
        ("3.4 MN", q.FORCE, 3.4e6),
        ("618.6 t", q.MASS, 618600.0),
        ("1025 kg/m3", q.DENSITY, 1025.0),
        ("1025 kg/m^3", q.DENSITY, 1025.0),
        ("1025 kg m-3", q.DENSITY, 1025.0),
        ("1.025 t/m**3", q.DENSITY, 1025.0),
        ("3 h", q.TIME, 10800.0),
        ("1 d", q.TIME, 86400.0),
        ("4.41e3 t m2", q.INERTIA, 4.41e6),
        ("9.81 m/s2", q.ACCELERATION, 9.81),
        ("1.5 kN/m", q.STIFFNESS, 1500.0),
        ("8.7 N s/m", q.DAMPING, 8.7),
        ("8.7 N*s/m", q.DAMPING, 8.7),
        ("2.5 kN*m*s", q.ROTATIONAL_DAMPING, 2500.0),
        ("2.5 kN·m·s", q.ROTATIONAL_DAMPING, 2500.0),
        ("1852 m/h", q.SPEED, 1852.0 / 3600.0),
        ("1 kn", q.SPEED, 1852.0 / 3600.0),
        ("2 tf", q.FORCE, 2000.0 * 9.80665),
        ("40 kgf", q.FORCE, 40.0 * 9.80665),
        ("100 gf", q.FORCE, 0.980665),
        ("1 lbf", q.FORCE, 4.4482216152605),
        ("1 kip", q.FORCE, 4448.2216152605),
        ("1 psi", q.PRESSURE, 6894.757293168361),
        ("210 GPa", q.PRESSURE, 210e9),
        ("1 kg/m/s2", q.PRESSURE, 1.0),
        ("1 kg/(m s2)", q.PRESSURE, 1.0),
        ("1 mbar", q.PRESSURE, 100.0),
        ("15 %", q.NUMBER, 0.15),
        ("5 ‰", q.NUMBER, 0.005),
        ("180 deg", q.ANGLE, math.pi),
        ("180°", q.ANGLE, math.pi),
        ("1 rev", q.ANGLE, 2.0 * math.pi),
        ("12 deg", q.ANGLE_DEGREES, 12.0),
        ("1 rad", q.ANGLE_DEGREES, 180.0 / math.pi),
        ("1.2 rad/s", q.ANGULAR_FREQUENCY, 1.2),
        ("0.5 Hz", q.ANGULAR_FREQUENCY, math.pi),
        ("60 rpm", q.ANGULAR_FREQUENCY, 2.0 * math.pi),
        ("0.5 Hz", q.FREQUENCY, 0.5),
        ("3.141592653589793 rad/s", q.FREQUENCY, 0.5),
        ("3 deg/s", q.ANGULAR_VELOCITY, math.radians(3.0)),
        ("32 N m/rad", q.ROTATIONAL_STIFFNESS, 32.0),
        ("32 N m", q.ROTATIONAL_STIFFNESS, 32.0),
        ("1 N m/deg", q.ROTATIONAL_STIFFNESS, 180.0 / math.pi),
        ("1 mL", q.VOLUME, 1e-6),
        ("1.14e-6 m2/s", q.VISCOSITY, 1.14e-6),
        ("２０　㎏", q.MASS, 20.0),
        ("3 m²", q.AREA, 3.0),
        ("−2 m", q.LENGTH, -2.0),
        ("+.5 m", q.LENGTH, 0.5),
        ("7", q.LENGTH, 7.0),
        (7, q.LENGTH, 7.0),
        (7.5, q.LENGTH, 7.5),
    ],
)
def test_known_conversions(text, kind, expected):
    assert to_si(text, kind) == pytest.approx(expected, rel=1e-15)


def test_decimal_factors_are_exact():
    """A decimal unit gives the double nearest to the exact product, not the product of two rounded numbers."""
    for number in range(1, 2000):
        assert to_si(f"{number} mm", q.LENGTH) == number / 1000
        assert to_si(f"{number / 10} cm", q.LENGTH) == float(Fraction(str(number / 10)) / 100)


@given(
    st.sampled_from(sorted(unit_table())),
    st.floats(allow_nan=False, allow_infinity=False, min_value=-1e12, max_value=1e12),
)
def test_round_trip_of_every_unit(symbol, number):
    si = parse_quantity(f"{number!r} {symbol}").si
    assert from_si(si, symbol) == pytest.approx(number, rel=1e-14, abs=1e-290)


@given(
    st.lists(st.sampled_from(["m", "kg", "s", "N", "kN", "t", "mm", "rad"]), min_size=1, max_size=4),
    st.lists(st.integers(-3, 3).filter(bool), min_size=4, max_size=4),
)
def test_products_and_quotients_agree(symbols, exponents):
    """``a b^2/(c d)`` and ``a b^2 c^-1 d^-1`` are one unit, in dimension and exactly in size."""
    powers = list(zip(symbols, exponents))
    product = parse_unit(" ".join(f"{symbol}^{power}" for symbol, power in powers))
    above = " ".join(f"{symbol}{power}" for symbol, power in powers if power > 0) or "1"
    below = " ".join(f"{symbol}{-power}" for symbol, power in powers if power < 0)
    quotient = parse_unit(f"{above}/({below})" if below else above)
    assert quotient.dimension == product.dimension
    assert quotient.factor == product.factor


@given(st.sampled_from(KINDS))
def test_every_kind_understands_its_own_example_and_unit(kind):
    assert math.isfinite(to_si(kind.example, kind))
    if kind.unit:
        assert to_si(f"2.5 {kind.unit}", kind) == 2.5
        assert kind.unit in parse_unit(kind.unit).symbol
    assert to_si(2.5, kind) == 2.5


@given(st.text(max_size=40) | st.text(alphabet=string.digits + " .eE+-*/^()mkgsNdn", max_size=25))
def test_any_text_gives_a_finite_number_or_an_input_error(text):
    for kind in (q.LENGTH, q.ANGLE_DEGREES, q.NUMBER):
        try:
            value = to_si(text, kind)
        except InputError as error:
            assert str(error)
        else:
            assert math.isfinite(value)


@pytest.mark.parametrize(
    ("value", "kind", "message"),
    [
        ("3 kg", q.LENGTH, "expected a length, for instance '1.05 m' or a number in metres; got '3 kg'"),
        ("3 metres", q.LENGTH, "unknown unit 'metres'; did you mean 'm'?"),
        ("3 kn", q.FORCE, "did you mean 'kN'?"),
        ("3 Mn", q.FORCE, "unknown unit 'Mn'; did you mean 'MN'?"),
        ("5 M", q.LENGTH, "unknown unit 'M'; did you mean 'm'?"),
        ("5 sec", q.TIME, "unknown unit 'sec'; did you mean 's'?"),
        ("1,05 m", q.LENGTH, "comma inside the number"),
        ("nan", q.LENGTH, "not a finite number"),
        ("NaN m", q.LENGTH, "not a finite number"),
        ("-inf", q.LENGTH, "not a finite number"),
        (math.nan, q.LENGTH, "not a finite number"),
        (math.inf, q.LENGTH, "not a finite number"),
        (10**400, q.LENGTH, "not a finite number"),
        ("1e999999999 m", q.LENGTH, "too large"),
        ("1e308 km", q.LENGTH, "too large"),
        ("1:30", q.TIME, "not a number with a unit"),
        ("m", q.LENGTH, "does not begin with a number"),
        ("", q.LENGTH, "does not begin with a number"),
        (True, q.LENGTH, "got the truth value true"),
        (None, q.LENGTH, "got nothing"),
        ([1], q.LENGTH, "got a list"),
        ("5 N/m s", q.DAMPING, "can be read in two ways; write 'N/(m s)' or 'N s/m'"),
        ("10 1/s", q.ANGULAR_FREQUENCY, "'Hz' (cycles per second) or 'rad/s'"),
        ("0.1", q.LENGTH, None),
        ("3 rad", q.LENGTH, "got '3 rad'"),
        ("3 m", q.ANGLE_DEGREES, "expected an angle, for instance '12 deg' or a number in degrees"),
        ("3 m rad", q.LENGTH, "got '3 m rad'"),
        ("1 m2^3", q.LENGTH, "is not a unit"),
        ("1 m99", q.LENGTH, "exponent 99"),
    ],
)
def test_refusals_say_what_was_expected(value, kind, message):
    if message is None:
        assert to_si(value, kind) == 0.1
        return
    with pytest.raises(InputError) as caught:
        to_si(value, kind, path="site.depth")
    assert message in str(caught.value)
    assert str(caught.value).startswith("site.depth: ")


def test_a_number_below_the_smallest_double_counts_as_zero_at_once():
    assert to_si("1e-999999999 m", q.LENGTH) == 0.0


@pytest.mark.parametrize(
    ("text", "remedy"),
    [
        ("2,500 mm", "write 2500 if the comma parts thousands, 2.500 if it is the decimal point"),
        ("1,05 m", "write 1.05"),
        ("12,345,678 N", "write 12345678"),
        ("1,234.5 N", "write 1234.5"),
        ("0,125 m", "write 0.125"),
        ("1,2,3 m", "write digits with one decimal point and no commas"),
    ],
)
def test_a_number_with_commas_is_shown_as_it_is_to_be_written(text, remedy):
    with pytest.raises(InputError) as found:
        q.parse_quantity(text)
    assert found.value.fault.remedy == remedy
