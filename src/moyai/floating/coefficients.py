"""Hydrodynamic coefficients of a floating body as plain arrays: the form in which this package takes them.

They come from a section (:mod:`moyai.potential`), from a 3-D program, or from anywhere else.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.curves import Spline
from moyai.core.errors import InputError
from moyai.core.options import check_word, checks_words
from moyai.floating.arrays import finite, increasing

if TYPE_CHECKING:
    import xarray as xr

    from moyai.potential.solution import RadiationDiffraction

_OVER_FREQUENCY = (
    "added_mass", "radiation_damping", "excitation_force", "reflection_coefficient", "transmission_coefficient",
    "radiated_wave",
)  # fmt: skip


@dataclass(frozen=True)
class Hydrodynamics:
    """Radiation and excitation against frequency, convention ``exp(-i omega t)``, phases at x = 0.

    Raises
    ------
    InputError
        When shapes disagree or a number is not finite.

    Examples
    --------
    >>> import numpy as np
    >>> from moyai.floating import Hydrodynamics
    >>> omega = np.array([0.5, 1.0])
    >>> one = np.ones((2, 1, 1))
    >>> heave = Hydrodynamics(omega, 1e5 * one, 5e3 * one, 1e5j * one, np.zeros(1), ("heave",), length=20.0)
    >>> heave.size, heave.length                                         # modes, [m]
    (1, 20.0)
    """

    #: Angular frequencies, increasing [rad/s]; shape (n,).
    omega: Array
    #: Added mass ``[frequency, influenced, radiating]`` [kg, kg m, kg m2]; shape (n, m, m).
    added_mass: Array
    #: Radiation damping in the same order [kg/s, kg m/s, kg m2/s]; shape (n, m, m).
    radiation_damping: Array
    #: Complex force per unit wave amplitude [N/m, N]; shape (n, h, m).
    excitation_force: ComplexArray
    #: Directions of travel [rad]; shape (h,).
    heading: Array
    #: Names of the m modes.
    modes: tuple[str, ...]
    #: Shape (m, m).
    infinite_frequency_added_mass: Array | None = None
    #: Complex, of the body held fixed; ``None`` for a body of finite length; shape (n, h).
    reflection_coefficient: ComplexArray | None = None
    #: Complex, of the body held fixed; ``None`` for a body of finite length; shape (n, h).
    transmission_coefficient: ComplexArray | None = None
    #: Complex wave amplitude per unit velocity towards -x and +x [s]; shape (n, m, 2).
    radiated_wave: ComplexArray | None = None
    #: Length of structure that forces and coefficients refer to [m]; 1 for coefficients per metre.
    length: float = 1.0

    def __post_init__(self) -> None:
        increasing(self.omega, "omega")
        if isinstance(self.modes, str) or len(set(self.modes)) < len(self.modes):
            raise InputError(f"modes are {self.modes!r}", parameter="modes", allowed="a tuple of names, each once")
        n, h, m = len(self.omega), len(self.heading), len(self.modes)
        shapes = {
            "added_mass": (n, m, m),
            "radiation_damping": (n, m, m),
            "excitation_force": (n, h, m),
            "infinite_frequency_added_mass": (m, m),
            "reflection_coefficient": (n, h),
            "transmission_coefficient": (n, h),
            "radiated_wave": (n, m, 2),
        }
        for name, shape in shapes.items():
            value = getattr(self, name)
            if value is None:
                continue
            if np.shape(value) != shape:
                raise InputError(f"{name} has the shape {np.shape(value)}", parameter=name, allowed=f"{shape}")
            finite(value, name)

    @property
    def size(self) -> int:
        """Number of modes."""
        return len(self.modes)

    @property
    def has_far_field(self) -> bool:
        """Whether reflection, transmission and radiated waves are known."""
        known = self.reflection_coefficient, self.transmission_coefficient, self.radiated_wave
        return not any(values is None for values in known)

    @classmethod
    def of_headings(cls, dataset: xr.Dataset) -> tuple[Hydrodynamics, ...]:
        """Take a dataset of one metre apart by heading, each with its own radiation where the dataset gives it.

        Parameters
        ----------
        dataset : xarray.Dataset
            As for :meth:`from_dataset`, with an axis ``wave_direction`` [rad].
        """
        out = []
        for index in range(dataset.sizes["wave_direction"]):
            one = dataset.isel(wave_direction=[index])
            if "oblique_added_mass" in dataset:
                own = one.isel(wave_direction=0)
                one = one.assign(
                    added_mass=own.oblique_added_mass,
                    radiation_damping=own.oblique_radiation_damping,
                    radiated_wave=own.oblique_radiated_wave,
                )
            out.append(cls.from_dataset(one))
        return tuple(out)

    def scaled_to(self, length: float) -> Hydrodynamics:
        """Return the coefficients of ``length`` [m] of structure; those of the far field stay.

        Parameters
        ----------
        length : float
            Length of structure that the new forces refer to [m].
        """
        factor = length / self.length
        infinite = self.infinite_frequency_added_mass
        return replace(
            self,
            added_mass=self.added_mass * factor,
            radiation_damping=self.radiation_damping * factor,
            excitation_force=self.excitation_force * factor,
            infinite_frequency_added_mass=None if infinite is None else infinite * factor,
            length=float(length),
        )

    @checks_words
    def at(self, omega: ArrayLike, *, hold: bool = False) -> Hydrodynamics:
        """Return the coefficients at other frequencies by cubic splines.

        Parameters
        ----------
        omega : array_like
            Angular frequencies, increasing [rad/s].
        hold : bool
            Outside the computed range, keep the values of its ends instead of refusing.

        Raises
        ------
        InputError
            When a frequency lies outside the computed range and ``hold`` is false.
        """
        wanted = increasing(omega, "omega")
        low, high = self.omega[0], self.omega[-1]
        slack = 1e-9 * high
        if not hold and (wanted[0] < low - slack or wanted[-1] > high + slack):
            raise InputError(
                f"frequencies {wanted[0]:.4g} to {wanted[-1]:.4g} rad/s lie outside the computed range",
                parameter="omega",
                allowed=f"{low:.4g} to {high:.4g} rad/s",
                remedy="compute the hydrodynamic coefficients over a wider range",
            )
        inside = np.clip(wanted, low, high)

        known = {name: values for name in _OVER_FREQUENCY if (values := getattr(self, name)) is not None}
        if len(self.omega) == 1:
            held: dict[str, Any] = {name: np.repeat(values, len(inside), axis=0) for name, values in known.items()}
            return replace(self, omega=wanted, **held)
        # One spline of all columns: setting it up costs more than the columns do
        columns = [_real_columns(values) for values in known.values()]
        found = Spline(self.omega, np.concatenate(columns, axis=1))(inside)
        parts = np.split(found, np.cumsum([column.shape[1] for column in columns])[:-1], axis=1)
        along: dict[str, Any] = {
            name: _as_columns_of(part, values) for part, (name, values) in zip(parts, known.items())
        }
        return replace(self, omega=wanted, **along)

    def excitation_at(self, omega: ArrayLike, heading: ArrayLike | None = None) -> ComplexArray:
        """Return the excitation (k, m) per unit amplitude of k wave components.

        Parameters
        ----------
        omega : array_like (k,)
            Frequencies in any order [rad/s]; outside the computed range the end values are held.
        heading : array_like (k,) or None
            Directions [rad]; ``None`` takes the only heading there is. Between computed headings linear.

        Raises
        ------
        InputError
            When a heading lies outside the computed ones.
        """
        frequency = np.clip(np.atleast_1d(np.asarray(omega, dtype=float)), self.omega[0], self.omega[-1])
        if len(self.omega) == 1:
            spread = np.repeat(self.excitation_force, len(frequency), axis=0)
        else:
            spread = Spline(self.omega, self.excitation_force)(frequency)
        if heading is None:
            if len(self.heading) != 1:
                raise InputError("several headings are computed and none is named", parameter="heading")
            return np.asarray(spread[:, 0, :], dtype=np.complex128)
        direction = np.broadcast_to(np.asarray(heading, dtype=float), frequency.shape)
        order = np.argsort(self.heading)
        known = np.asarray(self.heading, dtype=float)[order]
        spread = spread[:, order, :]
        if np.any(direction < known[0] - 1e-9) or np.any(direction > known[-1] + 1e-9):
            raise InputError(
                f"headings {np.min(direction):.4g} to {np.max(direction):.4g} rad lie outside the computed ones",
                parameter="heading",
                allowed=f"{known[0]:.4g} to {known[-1]:.4g} rad",
            )
        if len(known) == 1:
            return np.asarray(spread[:, 0, :], dtype=np.complex128)
        right = np.clip(np.searchsorted(known, direction), 1, len(known) - 1)
        weight = (direction - known[right - 1]) / (known[right] - known[right - 1])
        rows = np.arange(len(frequency))
        left_values, right_values = spread[rows, right - 1], spread[rows, right]
        return np.asarray((1.0 - weight)[:, None] * left_values + weight[:, None] * right_values, dtype=np.complex128)

    @classmethod
    def of(cls, source: Hydrodynamics | RadiationDiffraction | xr.Dataset) -> Hydrodynamics:
        """Return coefficients as they are, or take them from a solution or its dataset, per metre.

        Parameters
        ----------
        source : Hydrodynamics, RadiationDiffraction or xarray.Dataset

        Raises
        ------
        InputError
            For anything else.
        """
        if isinstance(source, Hydrodynamics):
            return source
        dataset: Any = getattr(source, "dataset", source)
        if not hasattr(dataset, "influenced_dof"):
            raise InputError(
                f"{type(source).__name__} holds no radiation and diffraction", parameter="hydrodynamics",
                allowed="Hydrodynamics, a solution of moyai.potential.solve, or its dataset",
            )  # fmt: skip
        return cls.from_dataset(dataset)

    @classmethod
    def from_section(cls, solution: RadiationDiffraction) -> Hydrodynamics:
        """Take the solution of a section at its first heading, per metre, as :meth:`from_dataset` does its dataset.

        Parameters
        ----------
        solution : RadiationDiffraction
            With motion uniform along the structure.
        """
        order, first = np.argsort(solution.omega), slice(0, 1)
        return cls(
            omega=solution.omega[order],
            added_mass=np.ascontiguousarray(solution.added_mass[order].swapaxes(1, 2)),
            radiation_damping=np.ascontiguousarray(solution.radiation_damping[order].swapaxes(1, 2)),
            excitation_force=solution.excitation_force[order, first],
            heading=np.asarray(solution.heading, dtype=float)[first],
            modes=tuple(solution.modes.names),
            infinite_frequency_added_mass=np.ascontiguousarray(solution.infinite_frequency_added_mass.T),
            reflection_coefficient=solution.reflection_coefficient[order, first],
            transmission_coefficient=solution.transmission_coefficient[order, first],
            radiated_wave=solution.radiated_wave[order],
        )

    @classmethod
    def from_dataset(
        cls, dataset: xr.Dataset, *, modes: Sequence[str] | None = None, length: float = 1.0
    ) -> Hydrodynamics:
        """Read a dataset in Capytaine's names.

        Parameters
        ----------
        dataset : xarray.Dataset
            With ``omega``, ``added_mass``, ``radiation_damping``, ``excitation_force`` and, for a section,
            ``reflection_coefficient``, ``transmission_coefficient``, ``radiated_wave``.
        modes : sequence of str or None
            Modes in the wanted order; ``None`` takes those of ``influenced_dof``.
        length : float
            Length that the dataset's forces refer to [m].

        Raises
        ------
        InputError
            When a mode is not in the dataset.
        """
        names = tuple(str(item) for item in (dataset.influenced_dof.values if modes is None else modes))
        for name in names:
            check_word(name, map(str, dataset.influenced_dof.values), "modes")
        data = dataset.sortby("omega").sel(influenced_dof=list(names), radiating_dof=list(names))

        def values(name: str, *dims: str) -> Any:
            if name not in data:
                return None
            array = data[name]
            if "complex" in array.dims:
                array = array.sel(complex="re") + 1j * array.sel(complex="im")
            for dim in dims:
                if dim not in array.dims:
                    array = array.expand_dims(dim)
            return np.ascontiguousarray(array.transpose(*dims).values)

        side = data.sel(side=["minus", "plus"]) if "side" in data.dims else data
        wave = (
            side["radiated_wave"].transpose("omega", "radiating_dof", "side").values
            if "radiated_wave" in side
            else None
        )
        infinite = values("infinite_frequency_added_mass", "influenced_dof", "radiating_dof")
        heading = (
            np.atleast_1d(data["wave_direction"].values.astype(float)) if "wave_direction" in data.coords else [0.0]
        )
        return cls(
            omega=np.atleast_1d(data["omega"].values.astype(float)),
            added_mass=values("added_mass", "omega", "influenced_dof", "radiating_dof"),
            radiation_damping=values("radiation_damping", "omega", "influenced_dof", "radiating_dof"),
            excitation_force=values("excitation_force", "omega", "wave_direction", "influenced_dof"),
            heading=np.asarray(heading, dtype=float),
            modes=names,
            infinite_frequency_added_mass=infinite,
            reflection_coefficient=values("reflection_coefficient", "omega", "wave_direction"),
            transmission_coefficient=values("transmission_coefficient", "omega", "wave_direction"),
            radiated_wave=None if wave is None else np.ascontiguousarray(wave),
            length=length,
        )


def _real_columns(values: Any) -> Array:
    """Return numbers over the first axis as columns, imaginary parts behind the real ones."""
    flat = values.reshape(len(values), -1)
    return np.concatenate([flat.real, flat.imag], axis=1) if np.iscomplexobj(flat) else flat


def _as_columns_of(columns: Array, like: Any) -> Any:
    """Undo :func:`_real_columns` for numbers of the shape of ``like`` at other places."""
    half = columns.shape[1] // 2
    flat = columns[:, :half] + 1j * columns[:, half:] if np.iscomplexobj(like) else columns
    return flat.reshape(len(columns), *like.shape[1:])
