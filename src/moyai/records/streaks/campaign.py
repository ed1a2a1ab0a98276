"""Many runs of streak pictures to circulations, their law and the reduction of the inertia coefficient: one result."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from moyai.core.arrays import Array
from moyai.core.errors import InputError
from moyai.core.options import checks_words
from moyai.core.progress import Progress, silent
from moyai.core.results import Result, make_provenance
from moyai.core.store import DatasetStore
from moyai.core.validity import IdentityCheck, Notice
from moyai.records.streaks.camera_calibration import CameraCalibration
from moyai.records.streaks.circulation_law import PUBLISHED, check_amplitude, fit_circulation_law, inertia_reduction
from moyai.records.streaks.contour_circulation import ContourCirculation, measure_circulation
from moyai.records.streaks.drift_interpolation import Interpolation
from moyai.records.streaks.flow import SectionMap
from moyai.records.streaks.orbital_bias import Orbits
from moyai.records.streaks.overlay import overlay_picture
from moyai.records.streaks.run import (
    BackgroundDrift,
    DriftCloud,
    Recording,
    RunSettings,
    analyse_recording,
    fit_background,
    gather,
)
from moyai.records.streaks.variables import VOCABULARY

if TYPE_CHECKING:
    import xarray as xr


@dataclass(frozen=True, eq=False)
class StreakRun:
    """One wave and its pictures."""

    name: str
    #: Wave period [s].
    period: float
    #: Velocity amplitude along x of the undisturbed orbit at the centre of the section [m/s].
    amplitude_x: float
    #: The same along z [m/s].
    amplitude_z: float
    recordings: tuple[Recording, ...]
    #: Reduction of the inertia coefficient found from forces; NaN where it was not measured.
    measured_reduction: float = math.nan
    #: The same wave without the section; empty: the pictures of the whole campaign serve.
    no_model: tuple[Recording, ...] = ()


@checks_words
@dataclass(frozen=True, eq=False)
class StreakCampaign:
    """Everything that a measurement needs."""

    #: Title of the campaign.
    title: str
    #: The section in words.
    section: str
    #: Closed outline about the centre of the section [m]; shape (n, 2).
    outline: Array
    #: Area of the section [m2].
    area: float
    #: Centre x, z in the coordinates of the targets [m]; shape (2,).
    centre: Array
    #: 1 for waves towards +x (clockwise orbits), -1 for the others.
    sense: int
    calibration: CameraCalibration
    runs: tuple[StreakRun, ...]
    settings: RunSettings
    #: Margin around the section where nothing is looked for [m].
    mask_margin: float
    #: Pictures without the section; empty where there are none.
    no_model: tuple[Recording, ...] = ()
    #: Settling and mass transport where they were given instead.
    background: BackgroundDrift | None = None
    #: Contours Bc/B.
    size_ratio: tuple[float, ...] = (1.25, 1.5, 1.75, 2.0, 2.25, 2.5, 2.75, 3.0)
    least_ratio: float = 1.5
    #: One of "spline", "triangles".
    method: Interpolation = "spline"
    resamples: int = 200
    confidence: float = 0.95
    seed: int = 0
    #: What its calibration gave rise to.
    notices: tuple[Notice, ...] = ()
    #: Map of the section, from which the bias of the circulation is found; ``None`` for a polygon.
    shape: SectionMap | None = None

    @property
    def breadth(self) -> float:
        """Breadth B of the section along x [m]."""
        return float(np.ptp(self.outline[:, 0]))


@dataclass(frozen=True, eq=False)
class _Measured:
    run: StreakRun
    cloud: DriftCloud
    drift: Array
    circulation: ContourCirculation
    background: BackgroundDrift | None
    overlay: dict[str, Any] = field(default_factory=dict)


def measure_campaign(
    campaign: StreakCampaign,
    *,
    store: DatasetStore | None = None,
    attributes: Mapping[str, str] | None = None,
    progress: Progress = silent,
) -> Result:
    """Measure the circulation of every run and the law over all of them.

    Parameters
    ----------
    campaign : Campaign
    store : DatasetStore, optional
        Keeps every recording that is done: an interrupted batch continues from there.
    attributes : mapping, optional
        Attributes of the root of the result, such as the text of the case file.
    progress : Progress

    Returns
    -------
    Result
        Groups ``calibration``, ``runs/<name>``, ``law``; status ``interrupted`` when it was stopped.

    Raises
    ------
    InputError
        Pictures that are absent, of different size, without streaks or with too few particles.
    """
    measured: list[_Measured] = []
    notices: list[Notice] = list(campaign.notices)
    total = sum(len(run.recordings) + len(run.no_model) for run in campaign.runs) + len(campaign.no_model)
    interrupted = False
    done = 0
    background = campaign.background
    progress("recordings", 0, total)
    try:
        if campaign.no_model:
            background = _calm(campaign, campaign.no_model, store, progress)
            done += len(campaign.no_model)
        if background is None and not all(run.no_model for run in campaign.runs):
            notices.append(
                Notice(
                    "no-run-without-model",
                    "settling and mass transport were not measured and are taken as zero",
                    severity="information",
                    remedy="add pictures of the same waves without the model under no_model",
                )
            )
        for run in campaign.runs:
            calm = background
            if run.no_model:
                calm = _calm(campaign, run.no_model, store, progress)
                done += len(run.no_model)
            datasets = []
            for recording in run.recordings:
                datasets.append(
                    analyse_recording(
                        recording,
                        campaign.calibration,
                        campaign.settings,
                        mask_outline=campaign.outline + campaign.centre,
                        mask_margin=campaign.mask_margin,
                        store=store,
                        progress=progress,
                    )
                )
                done += 1
                progress("recordings", done, total)
            measured.append(_measure_run(campaign, run, datasets, calm, progress))
    except KeyboardInterrupt:
        interrupted = True
    return _result(campaign, measured, notices, interrupted, dict(attributes or {}))


def _calm(
    campaign: StreakCampaign, recordings: Sequence[Recording], store: DatasetStore | None, progress: Progress
) -> BackgroundDrift:
    datasets = [
        analyse_recording(recording, campaign.calibration, campaign.settings, store=store, progress=progress)
        for recording in recordings
    ]
    return fit_background(_centred(gather(datasets), campaign))


def _centred(cloud: DriftCloud, campaign: StreakCampaign) -> DriftCloud:
    return replace(cloud, position=cloud.position - campaign.centre)


def _measure_run(
    campaign: StreakCampaign,
    run: StreakRun,
    datasets: Sequence[xr.Dataset],
    background: BackgroundDrift | None,
    progress: Progress,
) -> _Measured:
    cloud = _centred(gather(datasets), campaign)
    if cloud.count < 12:
        lost = f"{cloud.streaks} streaks made {cloud.chains} chains"
        tail = f", {cloud.undecided} of them without direction" if cloud.undecided else ""
        raise InputError(
            f"the run '{run.name}' gives {cloud.count} drift velocities: {lost}{tail}",
            parameter="runs",
            allowed="at least 12 particles followed through a period",
            remedy="check period and interval of the pulses, take more pictures, or use fewer particles a picture",
        )
    drift = cloud.velocity - (background.at(cloud.position) if background is not None else 0.0)
    # One lucky fit must not outweigh all others
    floor = float(np.median(cloud.deviation))
    orbits = None
    if campaign.shape is not None:
        orbits = Orbits(campaign.shape, run.period, run.amplitude_x, campaign.sense * run.amplitude_z)
    circulation = measure_circulation(
        cloud.position,
        drift,
        campaign.outline,
        campaign.size_ratio,
        deviation=np.maximum(cloud.deviation, floor),
        method=campaign.method,
        least_ratio=campaign.least_ratio,
        resamples=campaign.resamples,
        confidence=campaign.confidence,
        seed=campaign.seed,
        orbits=orbits,
        progress=progress,
    )
    kept = ~circulation.outlier
    cloud = replace(
        cloud,
        position=cloud.position[kept],
        velocity=cloud.velocity[kept],
        deviation=cloud.deviation[kept],
        residual=cloud.residual[kept],
        refused=cloud.refused + int(circulation.outlier.sum()),
    )
    picture = overlay_picture(run.recordings[0].pictures, datasets[0])
    return _Measured(run, cloud, drift[kept], circulation, background, picture)


def amplitude_number(run: StreakRun, breadth: float) -> float:
    """Return KC = sqrt(Vx Vz) T / B: the law holds for the product of both velocities."""
    return math.sqrt(run.amplitude_x * run.amplitude_z) * run.period / breadth


def _result(
    campaign: StreakCampaign,
    measured: list[_Measured],
    notices: list[Notice],
    interrupted: bool,
    attributes: dict[str, str],
) -> Result:
    import xarray as xr

    checks = []
    groups: dict[str, xr.Dataset] = {"/": xr.Dataset(attrs=_root_attributes(campaign, attributes))}
    groups["/calibration"] = xr.Dataset(
        {"residual": ((), campaign.calibration.residual, {"units": "1", "long_name": "misfit of the targets, pixels"})}
    )
    for item in measured:
        groups[f"/runs/{item.run.name}"] = _run_dataset(campaign, item)
        notices.extend(check_amplitude(amplitude_number(item.run, campaign.breadth)))
        notices.extend(_notices_of(item.run, item.circulation.notices))
        notices.extend(_against_orbits(item, campaign))
        checks.append(_single_valued(item))
    if measured:
        dataset, law_notices = _law_dataset(campaign, measured)
        if dataset is not None:
            groups["/law"] = dataset
        notices.extend(law_notices)
    message = ""
    if interrupted:
        message = f"{len(measured)} of {len(campaign.runs)} runs are done; the same command continues from there"
    described, undeclared = VOCABULARY.close(groups)
    unique = tuple(dict.fromkeys((*notices, *undeclared)))
    return Result(
        xr.DataTree.from_dict(described),
        status="interrupted" if interrupted else "converged",
        message=message,
        checks=tuple(checks),
        notices=unique,
        provenance=make_provenance(title=campaign.title, seed=campaign.seed),
    )


def _notices_of(run: StreakRun, notices: Sequence[Notice]) -> list[Notice]:
    return [replace(notice, message=f"run '{run.name}': {notice.message}") for notice in notices]


def _against_orbits(item: _Measured, campaign: StreakCampaign) -> list[Notice]:
    low, high = sorted(campaign.sense * side for side in item.circulation.limit_interval)
    value = campaign.sense * item.circulation.limit
    if low > 0.0 and value > 0.0:
        return []
    if high < 0.0 and value < 0.0:
        return [
            Notice(
                "circulation-against-orbits",
                f"run '{item.run.name}': the circulation runs against the orbits of waves towards "
                f"{'+x' if campaign.sense > 0 else '-x'}",
                value=value,
                limit=0.0,
                remedy="check 'waves_towards', the order of the pulses, and columns and rows of the targets",
            )
        ]
    return [
        Notice(
            "circulation-not-distinct-from-zero",
            f"run '{item.run.name}': the interval of the circulation holds zero",
            value=value,
            limit=0.0,
            remedy="take more pictures",
        )
    ]


def _single_valued(item: _Measured) -> IdentityCheck:
    """A mean flow that is free of sources has no flux through a contour; here: through the cloud as a whole."""
    place = item.cloud.position
    square = (place**2).sum(axis=1)
    outward = (item.drift * place).sum(axis=1) / square
    around = (item.drift[:, 0] * place[:, 1] - item.drift[:, 1] * place[:, 0]) / square
    weight = square / square.max()
    flux = abs(float((outward * weight).sum()))
    scale = float((np.abs(around) * weight).sum()) + flux
    return IdentityCheck(
        f"no flux out of the section, run {item.run.name}",
        flux / scale if scale > 0.0 else math.nan,
        0.25,
        "radial over tangential drift, averaged over all particles",
    )


def _root_attributes(campaign: StreakCampaign, attributes: dict[str, str]) -> dict[str, Any]:
    return {
        "structure": "streaks",
        "title": campaign.title,
        "section": campaign.section,
        "breadth": campaign.breadth,
        "area": campaign.area,
        "sense": campaign.sense,
        "least_ratio": campaign.least_ratio,
        "confidence": campaign.confidence,
        **attributes,
    }


def _run_dataset(campaign: StreakCampaign, item: _Measured) -> xr.Dataset:
    import xarray as xr

    cloud, found, calm = item.cloud, item.circulation, item.background

    def variable(dims: tuple[str, ...], values: Any, units: str, name: str) -> tuple[Any, ...]:
        return dims, values, {"units": units, "long_name": name}

    data = {
        "position": variable(("particle", "axis"), cloud.position, "m", "mean position from the centre"),
        "drift_velocity": variable(("particle", "axis"), item.drift, "m/s", "drift, background taken off"),
        "deviation": variable(("particle",), cloud.deviation, "m/s", "standard error of a component of the drift"),
        "residual": variable(("particle",), cloud.residual, "m", "misfit of the ends of the streaks"),
        "circulation": variable(("contour",), found.value, "m2/s", "circulation of the contour about +y"),
        "circulation_deviation": variable(("contour",), found.deviation, "m2/s", "its standard error"),
        "circulation_samples": variable(("sample", "contour"), found.samples, "m2/s", "of resampled clouds"),
        "outline": variable(("corner", "axis"), campaign.outline, "m", "outline of the section"),
        **item.overlay,
    }
    return xr.Dataset(
        data,
        coords={"axis": ["x", "z"], "contour": ("contour", found.size_ratio, {"long_name": "size ratio Bc/B"})},
        attrs={
            "period": item.run.period,
            "amplitude_x": item.run.amplitude_x,
            "amplitude_z": item.run.amplitude_z,
            "keulegan_carpenter": amplitude_number(item.run, campaign.breadth),
            "limit": found.limit,
            "limit_interval": np.array(found.limit_interval),
            "stokes_term": found.stokes_term,
            "estimator_bias": found.bias,
            "linear": found.linear,
            "linear_interval": np.array(found.linear_interval),
            "measured_reduction": item.run.measured_reduction,
            "background_particles": calm.particles if calm is not None else 0,
            "background_mean": calm.mean if calm is not None else np.zeros(2),
            "background_gradient": calm.gradient if calm is not None else np.zeros(2),
            **{name: getattr(cloud, name) for name in ("streaks", "chains", "refused", "undecided", "rejected")},
        },
    )


def _law_dataset(campaign: StreakCampaign, measured: list[_Measured]) -> tuple[xr.Dataset | None, tuple[Notice, ...]]:
    import xarray as xr

    kc = np.array([amplitude_number(item.run, campaign.breadth) for item in measured])
    period = np.array([item.run.period for item in measured])
    limit = campaign.sense * np.array([item.circulation.limit for item in measured])
    line = campaign.sense * np.array([item.circulation.linear for item in measured])
    interval = np.sort(campaign.sense * np.array([item.circulation.limit_interval for item in measured]), axis=1)
    try:
        law = fit_circulation_law(kc, limit, 1.0 / period, campaign.breadth)
    except InputError as error:
        return None, (Notice("no-law", error.fault.message, severity="warning"),)

    def variable(values: Any, units: str, name: str) -> tuple[Any, ...]:
        return ("run",), values, {"units": units, "long_name": name}

    reduction = inertia_reduction(limit, period, campaign.area)
    dataset = xr.Dataset(
        {
            "keulegan_carpenter": variable(kc, "1", "KC"),
            "period": variable(period, "s", "wave period"),
            "circulation": variable(limit, "m2/s", "circulation along the orbits"),
            "circulation_low": variable(interval[:, 0], "m2/s", "lower end of its interval"),
            "circulation_high": variable(interval[:, 1], "m2/s", "upper end of its interval"),
            "circulation_linear": variable(line, "m2/s", "straight line to the section (paper)"),
            "law": variable(law.coefficient / period * campaign.breadth**2 * kc**2, "m2/s", "fitted law"),
            "weight": variable(law.weight, "1", "weight in the law"),
            "reduction": variable(reduction, "1", "reduction of the inertia coefficient by the Magnus force"),
            "reduction_low": variable(inertia_reduction(interval[:, 0], period, campaign.area), "1", "lower end"),
            "reduction_high": variable(inertia_reduction(interval[:, 1], period, campaign.area), "1", "upper end"),
            "measured_reduction": variable(
                np.array([item.run.measured_reduction for item in measured]), "1", "reduction found from forces"
            ),
        },
        coords={"run": [item.run.name for item in measured]},
        attrs={
            "coefficient": law.coefficient,
            "coefficient_deviation": law.deviation,
            **{f"published_{name.split()[0].lower()}": value for name, value in PUBLISHED.items()},
        },
    )
    return dataset, law.notices
