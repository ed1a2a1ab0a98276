"""The memory of the water in the two forms that the time domain takes: states, or a convolution."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike

from moyai.core.arrays import Array, ComplexArray
from moyai.core.errors import ConvergenceError, InputError
from moyai.floating.arrays import finite, increasing


class ModalForm(Protocol):
    """A rational memory in modal form, as :mod:`moyai.potential.state_space` gives it."""

    @property
    def poles(self) -> ComplexArray:
        """One of each conjugate pair (n,)."""

    @property
    def inputs(self) -> ComplexArray:
        """(n, m)."""

    @property
    def outputs(self) -> ComplexArray:
        """(m, n), the partner of a complex pole already in."""


@dataclass(frozen=True)
class StateSpaceMemory:
    """Memory force ``-Re(outputs z) - dashpot v`` with ``z' = poles z + inputs v`` [eq:floating-state-space]."""

    #: One of each conjugate pair, real parts negative [1/s]; shape (n,).
    poles: ComplexArray
    #: Shape (n, m).
    inputs: ComplexArray
    #: The partner of a complex pole is already in: its factor 2; shape (m, n).
    outputs: ComplexArray
    #: Instantaneous part, for instance the feedthrough of a fit or a steady dashpot D(0) that the states leave out;
    #: shape (m, m).
    dashpot: Array

    def __post_init__(self) -> None:
        n, m = len(self.poles), self.dashpot.shape[0]
        if self.inputs.shape != (n, m) or self.outputs.shape != (m, n):
            raise InputError(
                f"{n} poles with inputs {self.inputs.shape} and outputs {self.outputs.shape}", parameter="memory"
            )
        for name in ("poles", "inputs", "outputs", "dashpot"):
            finite(getattr(self, name), name)
        if n and float(np.max(self.poles.real)) > 0.0:
            raise InputError(
                f"a memory pole grows in time (real part {np.max(self.poles.real):.3g} 1/s)",
                parameter="memory.poles",
                allowed="real parts not above 0",
                remedy="fit the memory again with fewer states",
            )

    @property
    def size(self) -> int:
        """Number of modes."""
        return int(self.dashpot.shape[0])

    def kernel(self, time: ArrayLike) -> Array:
        """Return K(t) (n, m, m) of the states, without the dashpot.

        Parameters
        ----------
        time : array_like (n,)
            [s].
        """
        instants = np.atleast_1d(np.asarray(time, dtype=float))
        growth = np.exp(self.poles[None, :] * instants[:, None])
        values: Array = np.einsum("ik,tk,kj->tij", self.outputs, growth, self.inputs).real
        return values

    def transfer(self, omega: ArrayLike) -> ComplexArray:
        """Return ``int K exp(i omega t) dt + dashpot`` = B - i omega (A - A_inf), (n, m, m).

        Parameters
        ----------
        omega : array_like (n,)
            [rad/s].
        """
        w = np.atleast_1d(np.asarray(omega, dtype=float))
        # The real kernel holds both partners of a complex pole; outputs carry the factor 2 of the pair
        first = np.einsum("ik,tk,kj->tij", self.outputs, 1.0 / (-1j * w[:, None] - self.poles), self.inputs)
        second = np.einsum(
            "ik,tk,kj->tij", self.outputs.conj(), 1.0 / (-1j * w[:, None] - self.poles.conj()), self.inputs.conj()
        )
        return np.asarray(0.5 * (first + second) + self.dashpot, dtype=np.complex128)

    def states_after(self, time: ArrayLike, velocity: ArrayLike) -> ComplexArray:
        """Return the states (n,) at the end of a known motion, empty at its beginning [eq:floating-state-space].

        Parameters
        ----------
        time : array_like (k,)
            Evenly spaced [s]; the trapezoidal rule is taken over it.
        velocity : array_like (k, m)
        """
        instants, rates = np.asarray(time, dtype=float), np.asarray(velocity, dtype=float)
        faded = np.exp(self.poles[:, None] * (instants[-1] - instants)[None, :])
        drive = self.inputs @ rates.T
        return np.asarray(np.trapezoid(faded * drive, instants, axis=1), dtype=np.complex128)

    @classmethod
    def none(cls, size: int) -> StateSpaceMemory:
        """Return no memory.

        Parameters
        ----------
        size : int
            Number of modes m.
        """
        return cls(
            np.zeros(0, np.complex128),
            np.zeros((0, size), np.complex128),
            np.zeros((size, 0), np.complex128),
            np.zeros((size, size)),
        )

    @classmethod
    def of(cls, fit: ModalForm, dashpot: ArrayLike | None = None) -> StateSpaceMemory:
        """Take over a rational fit that is already in modal form (:class:`moyai.potential.state_space.StateSpace`).

        Parameters
        ----------
        fit : ModalForm
            With ``poles``, ``inputs``, ``outputs`` as here.
        dashpot : array_like (m, m) or None
            Instantaneous part next to the states.
        """
        size = fit.outputs.shape[0]
        return cls(
            np.ascontiguousarray(fit.poles, dtype=np.complex128),
            np.ascontiguousarray(fit.inputs, dtype=np.complex128),
            np.ascontiguousarray(fit.outputs, dtype=np.complex128),
            np.zeros((size, size)) if dashpot is None else np.asarray(dashpot, dtype=float),
        )

    @classmethod
    def from_matrices(
        cls, a: ArrayLike, b: ArrayLike, c: ArrayLike, feedthrough: ArrayLike | None = None, tolerance: float = 1e-6
    ) -> StateSpaceMemory:
        """Diagonalise a real model ``z' = a z + b v``, ``F = -(c z + feedthrough v)``.

        Parameters
        ----------
        a : array_like (n, n)
            System matrix [1/s].
        b : array_like (n, m)
            From velocities of the modes to states.
        c : array_like (m, n)
            From states to forces of the modes.
        feedthrough : array_like (m, m), optional
            Force over velocity that acts at once, a dashpot [N s/m, N m s]; none when left out.
        tolerance : float
            Error of the kernel at 0 s over its size that is accepted [-].

        Raises
        ------
        ConvergenceError
            When the eigenvectors of ``a`` are so nearly parallel that the modal form no longer gives its kernel.
        """
        matrix, inputs, outputs = (np.atleast_2d(np.asarray(item, dtype=float)) for item in (a, b, c))
        size = outputs.shape[0]
        if matrix.size == 0:
            return cls.none(size)
        poles, vectors = np.linalg.eig(matrix)
        modal_inputs = np.linalg.solve(vectors, inputs.astype(np.complex128))
        modal_outputs = outputs @ vectors
        spread = float(np.linalg.cond(vectors))
        size_of = float(np.max(np.abs(outputs)) * np.max(np.abs(inputs))) or 1.0
        lost = float(np.max(np.abs((modal_outputs @ modal_inputs).real - outputs @ inputs))) / size_of
        if not lost <= tolerance or spread * np.finfo(float).eps > tolerance:
            raise ConvergenceError(
                f"the memory's state-space model has no usable modal form (eigenvectors of condition {spread:.2g})",
                remedy="fit with fewer states, or use the convolution",
            )
        keep = poles.imag >= 0.0
        factor = np.where(poles[keep].imag > 0.0, 2.0, 1.0)
        dashpot = np.zeros((size, size)) if feedthrough is None else np.asarray(feedthrough, dtype=float)
        return cls(
            np.ascontiguousarray(poles[keep].astype(np.complex128)),
            np.ascontiguousarray(modal_inputs[keep].astype(np.complex128)),
            np.ascontiguousarray((modal_outputs[:, keep] * factor).astype(np.complex128)),
            dashpot,
        )


@dataclass(frozen=True)
class ConvolutionMemory:
    """Memory force ``-int_0^L K(s) v(t - s) ds - dashpot v`` [eq:floating-cummins]."""

    #: From 0 [s]; shape (n,).
    time: Array
    #: K(t); shape (n, m, m).
    velocity_kernel: Array
    #: Instantaneous part next to the convolution; what truncation cuts off, D(0) less the integral of K up to the end,
    #: keeps the slow motions right (see :meth:`truncated`); shape (m, m).
    dashpot: Array

    def __post_init__(self) -> None:
        increasing(self.time, "time")
        if self.time[0] != 0.0:
            raise InputError(f"the memory starts at {self.time[0]:g} s", parameter="time", allowed="0")
        finite(self.velocity_kernel, "velocity_kernel")

    @property
    def size(self) -> int:
        """Number of modes."""
        return int(self.dashpot.shape[0])

    def truncated(self, length: float, steady_dashpot: ArrayLike | None = None) -> ConvolutionMemory:
        """Return the memory up to ``length`` [s].

        Parameters
        ----------
        length : float
        steady_dashpot : array_like (m, m) or None
            D(0), the radiation damping of zero frequency. What the integral of K up to ``length`` misses of it becomes
            a dashpot: in two dimensions a mode that displaces volume keeps D(0) > 0, and the cut would lose some of it.
        """
        keep = self.time <= length * (1.0 + 1e-12)
        time, kernel = self.time[keep], self.velocity_kernel[keep]
        dashpot = self.dashpot
        if steady_dashpot is not None:
            from scipy.interpolate import CubicSpline

            integral = CubicSpline(time, kernel, axis=0).integrate(time[0], time[-1])
            dashpot = np.asarray(steady_dashpot, dtype=float) - integral
        return ConvolutionMemory(time, kernel, dashpot)

    def on_steps(self, half_step: float) -> Array:
        """Return K at ``half_step * arange(2 l + 1)`` up to the end of the memory."""
        from scipy.interpolate import CubicSpline

        count = 2 * int(self.time[-1] / (2.0 * half_step)) + 1
        return np.ascontiguousarray(CubicSpline(self.time, self.velocity_kernel, axis=0)(half_step * np.arange(count)))


Memory = StateSpaceMemory | ConvolutionMemory
