"""A campaign of towed nets from its runs to coefficients and laws of the drag."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np

from moyai.core.errors import InputError
from moyai.core.options import check_word, checks_words
from moyai.core.progress import Progress, silent
from moyai.core.validity import Notice
from moyai.records.nets.quality import record_notices
from moyai.records.nets.regression import JointLaw, NetPowerLaw, fit_joint_law, fit_power_law
from moyai.records.nets.runs import NetRun, Specimen, Tank
from moyai.records.nets.tensions import CageRecord, EndTension, measure_tensions
from moyai.records.nets.towing import FrameLaw, Tow, TowCoefficients, frame_law, measure_tow, tow_coefficients
from moyai.records.nets.vibration import Vibration, VibrationSearch, find_vibration
from moyai.records.nets.waves import WaveCoefficients, WaveFit, fit_waves, wave_coefficients

#: Conditions of waves that are the same: period, height by the velocity, and speed, relative
_SAME_WAVES = 0.08


@checks_words
@dataclass(frozen=True, eq=False)
class NetCampaign:
    """Nets, runs and how they are read.

    Raises
    ------
    InputError
        For names that stand twice or are unknown, and a vibration that is neither a band nor ``auto`` or ``none``.
    """

    title: str
    tank: Tank
    specimens: tuple[Specimen, ...]
    #: Those of the bare frame have no net.
    runs: tuple[NetRun, ...]
    #: Tensions of a moored cage.
    cages: tuple[CageRecord, ...] = ()
    #: The band to take out; ``auto`` finds it in the still-water runs.
    vibration: Vibration | Literal["auto", "none"] = "auto"
    #: Range to find it in [Hz].
    search: tuple[float, float] = (1.5, 20.0)
    #: What the law of all nets takes.
    solidity: Literal["geometric", "listed"] = "geometric"
    confidence: float = 0.95
    #: Relative standard error of the force gauge [-].
    calibration: float = 0.0
    #: Standard error of the phase between force and velocity [rad].
    phase_error: float = 0.0
    bootstrap: int = 200
    seed: int = 1

    def __post_init__(self) -> None:
        if not isinstance(self.vibration, Vibration):
            check_word(self.vibration, ("auto", "none"), "vibration")
        names = [run.name for run in self.runs] + [cage.name for cage in self.cages]
        for name in names:
            if names.count(name) > 1:
                raise InputError(f"two runs are called '{name}'", parameter="runs")
        nets = [specimen.name for specimen in self.specimens]
        for index, name in enumerate(nets):
            if name in nets[:index]:
                raise InputError(f"two nets are called '{name}'", parameter=f"nets[{index}].name")
        for index, run in enumerate(self.runs):
            if run.net and run.net not in nets:
                raise InputError(
                    f"run {run.name} towed net '{run.net}', which is not listed",
                    parameter=f"runs[{index}].net",
                    allowed=", ".join(nets),
                )
            if run.frame and run.frame not in [other.name for other in self.runs if not other.net]:
                raise InputError(
                    f"run {run.name}: '{run.frame}' is no run of the bare frame", parameter=f"runs[{index}].frame"
                )
        if not self.runs and not self.cages:
            raise InputError("there are no runs", parameter="runs")
        if not self.cages and not any(run.net for run in self.runs):
            raise InputError(
                "all runs are of the bare frame", parameter="runs", remedy="name the net of the runs that towed one"
            )
        if not 0.5 <= self.confidence < 1.0:
            raise InputError(f"confidence is {self.confidence:g}", parameter="confidence", allowed="0.5 to below 1")
        if not 0.0 <= self.calibration < 0.5:
            raise InputError(
                f"calibration error is {self.calibration:g}", parameter="calibration_error", allowed="0 to 0.5"
            )

    def specimen(self, name: str) -> Specimen:
        """Return a net by its name.

        Parameters
        ----------
        name : str
            As in the campaign.

        Raises
        ------
        StopIteration
            When there is none.
        """
        return next(specimen for specimen in self.specimens if specimen.name == name)


@dataclass(frozen=True, eq=False)
class NetFindings:
    """Everything that a campaign gave."""

    campaign: NetCampaign
    #: What the spectrum of the still-water runs showed.
    search: VibrationSearch | None
    #: What was taken out.
    vibration: Vibration | None
    #: All still-water runs, frame included.
    tows: tuple[Tow, ...]
    towing: tuple[TowCoefficients, ...]
    waves: tuple[WaveCoefficients, ...]
    #: In the order of ``waves``.
    fits: tuple[WaveFit, ...]
    #: Of every net with three runs or more.
    laws: tuple[NetPowerLaw, ...]
    joint: JointLaw | None
    #: By run.
    tensions: tuple[tuple[str, tuple[EndTension, ...]], ...]
    notices: tuple[Notice, ...]


def measure_nets(campaign: NetCampaign, progress: Progress = silent) -> NetFindings:
    """Find the coefficients of every run, the law of every net and that of all together.

    Parameters
    ----------
    campaign : NetCampaign
        As :func:`moyai.records.load_nets` reads it.
    progress : Progress
        Called after every run.

    Returns
    -------
    NetFindings
        Coefficients of every run with their intervals, the law of every net and that of all together.

    Raises
    ------
    InputError
        With the name of the run that cannot be used, and why.

    Examples
    --------
    >>> from pathlib import Path
    >>> from tempfile import mkdtemp
    >>> from moyai.records import load_nets, measure_nets
    >>> folder = Path(mkdtemp())
    >>> text = "moyai: 1\\ntitle: Nets\\npanel_area: 0.066\\npanel_z: -0.2\\nwater_depth: 0.45\\ngravity: 9.81\\n"
    >>> text += "density: 1000\\nkinematic_viscosity: 1.1e-6\\nnets: [{name: A, table: A}]\\nruns:\\n"
    >>> for net, force in (("none", 0.2), ("A", 1.1)):
    ...     rows = [f"{0.05 * n},{force + 0.01 * (n % 2)}" for n in range(400)]
    ...     _ = (folder / f"{net}.csv").write_text("\\n".join(["time [s],force [N]", *rows]), encoding="utf-8")
    ...     text += f"  - {{name: {net}, net: {net}, kind: still_water, file: {net}.csv, speed: 0.3}}\\n"
    >>> _ = (folder / "nets.yaml").write_text(text + "columns: {time: time, force: force}\\n", encoding="utf-8")
    >>> found = measure_nets(load_nets(folder / "nets.yaml")[0])
    >>> round(found.towing[0].drag, 2)                               # C_D on the area of the twines
    1.33
    """
    still = [run for run in campaign.runs if run.kind == "still_water"]
    moving = [run for run in campaign.runs if run.kind != "still_water"]
    notices: list[Notice] = []
    for run in campaign.runs:
        notices.extend(record_notices(run))
    if campaign.calibration == 0.0:
        notices.append(
            Notice(
                "net-calibration",
                "the intervals of coefficients count no error of the gauge's calibration: a share of it is one of the "
                "coefficients as well",
                severity="warning",
                remedy="give 'calibration_error', for instance 0.01",
            )
        )
    search, vibration = _vibration(campaign, still, notices)
    total = len(still) + len(moving)
    tows = []
    for count, run in enumerate(still):
        tows.append(measure_tow(run, vibration, campaign.confidence))
        progress("runs", count + 1.0, float(total))
    frame = frame_law([tow for tow in tows if not tow.run.net])
    towing = _towing(campaign, tows, frame, notices)
    fits, waves = _waves(
        campaign, moving, vibration, notices, lambda k: progress("runs", float(len(still) + k), float(total))
    )
    laws, joint = _laws(campaign, towing, notices)
    tensions = []
    for cage in campaign.cages:
        found, reported = measure_tensions(cage)
        tensions.append((cage.name, found))
        notices.extend(reported)
    unique = {notice.message: notice for notice in notices}
    return NetFindings(
        campaign=campaign,
        search=search,
        vibration=vibration,
        tows=tuple(tows),
        towing=tuple(towing),
        waves=tuple(waves),
        fits=tuple(fits),
        laws=laws,
        joint=joint,
        tensions=tuple(tensions),
        notices=tuple(unique.values()),
    )


def _vibration(
    campaign: NetCampaign, still: Sequence[NetRun], notices: list[Notice]
) -> tuple[VibrationSearch | None, Vibration | None]:
    given = campaign.vibration
    if isinstance(given, Vibration):
        return None, given
    if given == "none" or not campaign.runs:
        return None, None
    if not still:
        notices.append(
            Notice(
                "net-vibration-unknown",
                "no still-water run shows the vibration of the carriage; none was taken out",
                severity="warning",
                remedy="give 'vibration: {band: [2.8 Hz, 3.3 Hz]}', or a still-water run",
            )
        )
        return None, None
    steady = [measure_tow(run, None, campaign.confidence) for run in still]
    lowest, highest = campaign.search
    try:
        search = find_vibration(
            [tow.run.step for tow in steady],
            [tow.clean[tow.run.part(tow.window)] for tow in steady],
            lowest=lowest,
            highest=highest,
        )
    except InputError as error:
        notices.append(
            Notice(
                "net-vibration-unknown",
                f"the vibration of the carriage cannot be searched for, none was taken out: {error.fault.message}",
                severity="warning",
                remedy="give 'vibration: {band: [2.8 Hz, 3.3 Hz]}', or longer runs sampled faster",
            )
        )
        return None, None
    if search.found is None:
        notices.append(
            Notice(
                "net-vibration-absent",
                f"no line is significant in the spectrum of the still-water runs between {lowest:g} and "
                f"{float(search.frequency[-1]) / 1.1:.3g} Hz; nothing was removed",
                severity="information",
            )
        )
    return search, search.found


def _towing(
    campaign: NetCampaign, tows: Sequence[Tow], frame: FrameLaw | None, notices: list[Notice]
) -> list[TowCoefficients]:
    out = []
    carried = [tow for tow in tows if tow.run.net]
    if carried and frame is None:
        notices.append(_no_frame("towed through still water"))
    for tow in carried:
        found, reported = tow_coefficients(
            tow, campaign.specimen(tow.run.net), campaign.tank, frame, campaign.confidence, campaign.calibration
        )
        out.append(found)
        notices.extend(reported)
    lifts = [abs(item.lift) / item.drag for item in out if math.isfinite(item.lift) and item.drag > 0.0]
    if lifts and float(np.median(lifts)) > 0.05:
        notices.append(
            Notice(
                "net-lift",
                f"the median lift is {100.0 * float(np.median(lifts)):.0f} % of the drag, where a net perpendicular "
                "to the flow has none",
                float(np.median(lifts)),
                0.05,
                "warning",
                "check the angle of the panel and the crosstalk of the gauge",
            )
        )
    return out


def _no_frame(where: str) -> Notice:
    return Notice(
        "net-no-frame",
        f"no run of the bare frame {where}: the frame's force is in the coefficients",
        severity="warning",
        remedy="record the bare frame in the same conditions",
    )


def _waves(
    campaign: NetCampaign,
    moving: Sequence[NetRun],
    vibration: Vibration | None,
    notices: list[Notice],
    done: Callable[[int], None],
) -> tuple[list[WaveFit], list[WaveCoefficients]]:
    fits, waves = [], []
    frames = [run for run in moving if not run.net]
    tank = campaign.tank
    for count, run in enumerate(run for run in moving if run.net):
        specimen = campaign.specimen(run.net)

        def fitted(record: NetRun, specimen: Specimen = specimen) -> WaveFit:
            return fit_waves(
                record,
                tank,
                specimen.projected_area,
                specimen.volume,
                vibration,
                confidence=campaign.confidence,
                phase_error=campaign.phase_error,
                bootstrap=campaign.bootstrap,
                seed=campaign.seed,
            )

        whole = fitted(run)
        bare = _frame_run(run, frames)
        frame = None if bare is None else fitted(bare)
        if bare is None:
            notices.append(_no_frame(f"in the waves of run {run.name}"))
        elif frame is not None:
            gap = abs(frame.found.velocity_amplitude[0] / whole.found.velocity_amplitude[0] - 1.0)
            if gap > _SAME_WAVES and not run.frame:
                notices.append(
                    Notice(
                        "net-frame-waves",
                        f"run {run.name}: the waves of the frame's run {bare.name} differ in velocity by "
                        f"{100.0 * gap:.0f} %; its coefficients were used",
                        float(gap),
                        _SAME_WAVES,
                        "information",
                    )
                )
        found, reported = wave_coefficients(whole, frame, specimen, tank, campaign.confidence, campaign.calibration)
        fits.append(whole)
        waves.append(found)
        notices.extend(reported)
        done(count + 1)
    return fits, waves


def _frame_run(run: NetRun, frames: Sequence[NetRun]) -> NetRun | None:
    """Return the frame's run in the same waves: the one named, or the nearest in period and speed."""
    if run.frame:
        return next(frame for frame in frames if frame.name == run.frame)

    def gap(frame: NetRun) -> float:
        apart = 0.0
        if run.period is not None and frame.period is not None:
            apart += abs(frame.period / run.period - 1.0)
        if run.kind == "towing_waves":
            apart += abs(frame.speed / run.speed - 1.0) if run.speed > 0.0 else 0.0
        # of frames in waves of one period, that in waves of like height
        signals = [item.velocity if item.velocity is not None else item.elevation for item in (run, frame)]
        if signals[0] is not None and signals[1] is not None and (run.velocity is None) == (frame.velocity is None):
            apart += 0.1 * abs(float(signals[1].std()) / max(float(signals[0].std()), 1e-300) - 1.0)
        return apart

    near = [
        frame
        for frame in frames
        if frame.kind == run.kind and frame.following == run.following and frame.regular == run.regular
    ]
    return min(near, key=gap) if near and gap(min(near, key=gap)) < 0.15 else None


def _laws(
    campaign: NetCampaign, towing: Sequence[TowCoefficients], notices: list[Notice]
) -> tuple[tuple[NetPowerLaw, ...], JointLaw | None]:
    laws = []
    good = [item for item in towing if item.drag > 0.0]
    for specimen in campaign.specimens:
        own = [item for item in good if item.net == specimen.name]
        if len(own) < 3:
            continue
        try:
            laws.append(
                fit_power_law(
                    specimen.name,
                    [item.reynolds for item in own],
                    [item.drag for item in own],
                    [item.drag_error for item in own],
                    campaign.confidence,
                )
            )
        except InputError as error:
            notices.append(Notice("net-law", error.fault.message, remedy=error.fault.remedy, severity="information"))
    if not good:
        return (), None
    nets = [campaign.specimen(item.net).net for item in good]
    try:
        joint = fit_joint_law(
            [item.net for item in good],
            [item.reynolds for item in good],
            [item.drag for item in good],
            [item.drag_error for item in good],
            [net.solidity if campaign.solidity == "geometric" else net.listed for net in nets],
            [net.twine_diameter for net in nets],
            confidence=campaign.confidence,
        )
    except InputError as error:
        text = f"no formula of solidity and diameter: {error.fault.message}"
        notices.append(Notice("net-joint-law", text, severity="information", remedy=error.fault.remedy))
        return tuple(laws), None
    if joint.left_out_error >= joint.pooled_error:
        notices.append(
            Notice(
                "net-joint-law",
                "A and B as functions of solidity and diameter predict a net left out no better than one power law for "
                f"all ({joint.left_out_error:.3f} against {joint.pooled_error:.3f} in ln C_D)",
                joint.left_out_error,
                joint.pooled_error,
                "information",
                "use the one power law, or tow more nets",
            )
        )
    return tuple(laws), joint
