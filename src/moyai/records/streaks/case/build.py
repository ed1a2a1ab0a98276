"""From a file of ``moyai measure streaks`` to :class:`moyai.records.streaks.campaign.StreakCampaign`."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from contextlib import suppress
from pathlib import Path
from typing import TYPE_CHECKING

import numpy as np

from moyai.case.findings import Findings, duplicates
from moyai.case.measured import read_points
from moyai.case.reader import read_block
from moyai.case.yaml_reader import CaseDocument, KeyPath, read_yaml
from moyai.core.arrays import Array
from moyai.core.errors import CaseError, InputError
from moyai.morison.contour import Contour
from moyai.records.streaks.case.schema import (
    CalibrationBlock,
    RecordingBlock,
    StreakCircle,
    StreakRectangle,
    StreaksFile,
    TimingFrames,
)
from moyai.records.streaks.flow import SectionMap
from moyai.records.streaks.timing import PulseTrain, regular_pulses, require_time_order

if TYPE_CHECKING:
    from moyai.records.streaks.camera_calibration import CameraCalibration
    from moyai.records.streaks.campaign import StreakCampaign, StreakRun
    from moyai.records.streaks.run import Recording


def load_streaks(path: str | os.PathLike[str]) -> tuple[StreakCampaign, CaseDocument]:
    """Read a file of ``moyai measure streaks`` and build what it describes.

    Raises
    ------
    CaseError
        With every error at once, each with line and column: keys, times, targets, absent pictures.
    """
    document = read_yaml(path)
    model: StreaksFile = read_block(document, StreaksFile)
    findings = Findings(document)
    folder = Path(path).parent
    campaign = _build(model, findings, folder)
    if findings.faults or campaign is None:
        raise CaseError(sorted(findings.faults, key=lambda fault: (fault.line, fault.column)))
    return campaign, document


def _build(model: StreaksFile, findings: Findings, folder: Path) -> StreakCampaign | None:
    from moyai.records.streaks.camera_checks import inside_picture, view_notices
    from moyai.records.streaks.campaign import StreakCampaign, StreakRun
    from moyai.records.streaks.detection import DetectionSettings
    from moyai.records.streaks.linking import LinkingSettings
    from moyai.records.streaks.run import BackgroundDrift, RunSettings

    outline, area, words = _section(model, findings)
    names = [run.name for run in model.runs]
    for index in duplicates(names):
        findings.fault(("runs", index, "name"), f"a run '{names[index]}' is already given above")
    runs: list[StreakRun] = []
    breadth = float(np.ptp(outline[:, 0])) if len(outline) else math.nan
    for index, block in enumerate(model.runs):
        recordings = _recordings(block.recordings, block.period, model, findings, ("runs", index, "recordings"), folder)
        calm: tuple[Recording, ...] = ()
        if block.no_model:
            calm = _recordings(block.no_model, block.period, model, findings, ("runs", index, "no_model"), folder)
        speed = block.velocity_amplitude
        if speed is None:
            speed = (block.keulegan_carpenter or math.nan) * breadth / block.period
        reduction = math.nan if block.measured_reduction is None else block.measured_reduction
        runs.append(
            StreakRun(block.name, block.period, speed, speed * block.vertical_ratio, recordings, reduction, calm)
        )
    no_model: tuple[Recording, ...] = ()
    if model.no_model is not None:
        given_calm = model.no_model
        no_model = _recordings(
            given_calm.recordings, given_calm.period, model, findings, ("no_model", "recordings"), folder
        )
    shape = _picture_shape([*runs[0].recordings] if runs else [])
    calibration = _calibration(model.calibration, findings, folder, shape)
    _check_sizes(runs, no_model, shape, findings)
    centre = np.array([model.centre.x, model.centre.z])
    if calibration is not None and shape is not None and not inside_picture(calibration, centre, shape):
        findings.fault(
            ("centre",),
            f"the centre of the section, x = {centre[0]:g} m, z = {centre[1]:g} m, lies outside the pictures",
            remedy="give it in the coordinates of the targets",
        )
    contours = model.circulation
    if sum(ratio >= contours.least_ratio for ratio in contours.size_ratios) < 2:
        findings.fault(
            ("circulation", "size_ratios"),
            f"fewer than two contours are of size {contours.least_ratio:g} and more, which the fit needs",
            remedy="add larger contours",
        )
    if model.detection.edge_threshold > model.detection.threshold:
        findings.fault(("detection", "edge_threshold"), "the edge's threshold is above the threshold")
    if findings.faults or calibration is None:
        return None
    background = None
    if model.background is not None:
        given = model.background
        background = BackgroundDrift(
            np.array([given.mass_transport, -given.settling]), np.array([given.mass_transport_gradient, 0.0])
        )
    detection = model.detection
    settings = RunSettings(
        DetectionSettings(
            threshold=detection.threshold,
            edge_threshold=detection.edge_threshold,
            least_length=detection.least_length,
            background_block=detection.background_block,
            most_overlap=detection.most_overlap,
        ),
        LinkingSettings(model.linking.relative, model.linking.absolute, model.linking.missing),
        model.linking.closing,
        most_residual=model.linking.most_residual,
    )
    return StreakCampaign(
        title=model.title,
        section=words,
        outline=outline,
        area=area,
        centre=centre,
        sense=1 if model.waves_towards == "+x" else -1,
        calibration=calibration,
        runs=tuple(runs),
        settings=settings,
        mask_margin=detection.mask_margin,
        no_model=no_model,
        background=background,
        size_ratio=tuple(sorted(set(contours.size_ratios))),
        least_ratio=contours.least_ratio,
        method=contours.interpolation,
        resamples=contours.resamples,
        confidence=contours.confidence,
        seed=contours.seed,
        notices=view_notices(calibration, centre),
        shape=_map(model),
    )


def _map(model: StreaksFile) -> SectionMap | None:
    """Return the map of a circle, or of a rectangle that is not too thin for it."""
    from moyai.records.streaks.flow import circle_map, rectangle_map

    section = model.section
    if isinstance(section, StreakCircle):
        return circle_map(section.diameter)
    if isinstance(section, StreakRectangle):
        with suppress(InputError):
            return rectangle_map(section.breadth, section.height)
    return None


def _section(model: StreaksFile, findings: Findings) -> tuple[Array, float, str]:
    from moyai.records.streaks.flow import circle_map

    section = model.section
    if isinstance(section, StreakCircle):
        return circle_map(section.diameter).outline, 0.25 * math.pi * section.diameter**2, (
            f"circle of {1e3 * section.diameter:g} mm"
        )  # fmt: skip
    if isinstance(section, StreakRectangle):
        b, h = 0.5 * section.breadth, 0.5 * section.height
        corners = np.array([[b, -h], [b, h], [-b, h], [-b, -h], [b, -h]])
        return corners, section.breadth * section.height, (
            f"rectangle of {1e3 * section.breadth:g} by {1e3 * section.height:g} mm"
        )  # fmt: skip
    corners = np.array([*section.corners, section.corners[0]], dtype=float)
    words = f"polygon of {len(corners) - 1} corners"
    try:
        area = Contour(corners[:-1]).area
    except InputError as error:
        findings.fault(("section", "corners"), error.fault.message, remedy=error.fault.remedy)
        return corners, math.nan, words
    if not _encloses_origin(corners):
        findings.fault(
            ("section", "corners"),
            "the centre [0, 0] does not lie inside the corners, so that similar contours do not go around them",
            remedy="give the corners about the centre of the section",
        )
    return corners, area, words


def _encloses_origin(corners: Array) -> bool:
    """Return whether the origin lies inside a closed polygon, with room to its edges."""
    size = float(np.ptp(corners, axis=0).max())
    turn = np.diff(np.unwrap(np.arctan2(corners[:, 1], corners[:, 0])))
    edges, start = np.diff(corners, axis=0), corners[:-1]
    share = np.clip(-(start * edges).sum(axis=1) / (edges**2).sum(axis=1), 0.0, 1.0)
    nearest = float(np.hypot(*(start + share[:, None] * edges).T).min())
    return abs(float(turn.sum())) > math.pi and nearest > 1e-3 * size


def _check_sizes(
    runs: Sequence[StreakRun], calm: Sequence[Recording], shape: tuple[int, int] | None, findings: Findings
) -> None:
    """Compare the size of every picture with the first: one calibration holds for one size."""
    if shape is None:
        return
    places: list[tuple[KeyPath, Recording]] = [(("no_model",), item) for item in calm]
    for index, run in enumerate(runs):
        places += [(("runs", index, "recordings"), item) for item in run.recordings]
        places += [(("runs", index, "no_model"), item) for item in run.no_model]
    for path, recording in places:
        for picture in recording.pictures:
            size = _size_of(picture)
            if size is not None and size != shape:
                findings.fault(
                    path,
                    f"{picture.name} has {size[1]} by {size[0]} pixels, the first picture {shape[1]} by {shape[0]}",
                    remedy="pictures of one calibration share one size",
                )
                break


def _size_of(picture: Path) -> tuple[int, int] | None:
    """Return rows and columns from the head of a file, ``None`` where it does not show them."""
    import imageio.v3 as imageio

    try:
        shape = imageio.improps(picture).shape
    except Exception:  # whatever is wrong with it is reported, with its name, when it is read
        return None
    return (int(shape[0]), int(shape[1])) if len(shape) in (2, 3) else None


def _train(model: StreaksFile, count: int) -> PulseTrain:
    timing = model.timing
    if isinstance(timing, TimingFrames):
        return regular_pulses(timing.interval, timing.on_time, 1.0, count)
    return regular_pulses(timing.interval, timing.on_time, timing.power, timing.count)


def _recordings(
    blocks: Sequence[RecordingBlock],
    period: float,
    model: StreaksFile,
    findings: Findings,
    path: KeyPath,
    folder: Path,
) -> tuple[Recording, ...]:
    from moyai.records.streaks.run import Recording

    frames = isinstance(model.timing, TimingFrames)
    if model.timing.interval > 0.25 * period:
        message = f"pulses {model.timing.interval:.3g} s apart are too few for the period of {period:.3g} s"
        if not any(item.message == message for item in findings.faults):
            findings.fault(("timing", "interval"), message, allowed=f"at most {0.25 * period:.3g} s")
        return ()
    found: list[Recording] = []
    known: set[Path] = set()
    for index, item in enumerate(blocks):
        here: KeyPath = (*path, index) if (*path, 0) in findings.document.values else path
        pictures = _pictures(item, findings, here, folder)
        if not pictures:
            continue
        twice = [picture.name for picture in pictures if picture in known]
        if twice or len(set(pictures)) < len(pictures):
            name = twice[0] if twice else next(p.name for p in pictures if pictures.count(p) > 1)
            findings.fault(here, f"the picture '{name}' is given twice", remedy="name each picture once")
            continue
        known.update(pictures)
        groups = [pictures] if frames else [(picture,) for picture in pictures]
        for group in groups:
            try:
                train = _train(model, len(group))
                # A chain may start late and lack its last streak and still cover the period
                needed = math.ceil(0.95 * period / model.timing.interval)
                if frames and len(group) < needed + 1:
                    raise InputError(
                        f"{len(group)} pictures {model.timing.interval:.3g} s apart do not cover the period of "
                        f"{period:.3g} s",
                        path="pictures",
                        allowed=f"at least {needed + 1}, better {needed + 3}",
                    )
                if not frames:
                    require_time_order(train, needed + 1)
                found.append(Recording(tuple(group), train, frames, period))
            except InputError as error:
                fault = error.fault
                place: KeyPath = ("timing",) if fault.path in ("pulses", "timing", "timing.count") else here
                if not any(item.message == fault.message for item in findings.faults):
                    findings.fault(place, fault.message, allowed=fault.allowed, remedy=fault.remedy)
                break
    return tuple(found)


def _pictures(item: RecordingBlock, findings: Findings, path: KeyPath, folder: Path) -> tuple[Path, ...]:
    files: list[Path] = []
    for index, name in enumerate(item.pictures):
        here: KeyPath = (*path, "pictures", index)
        if any(mark in name for mark in "*?"):
            target = folder / name
            matches = sorted(target.parent.glob(target.name))
            if not matches:
                findings.fault(here, f"no picture matches '{name}'")
            files.extend(matches)
        elif not (folder / name).is_file():
            findings.fault(here, f"no such picture: '{name}'", remedy="names are relative to the folder of this file")
        else:
            files.append(folder / name)
    return tuple(files)


def _picture_shape(recordings: Sequence[Recording]) -> tuple[int, int] | None:
    from moyai.records.streaks.detection import read_picture

    for recording in recordings:
        try:
            rows, columns = read_picture(recording.pictures[0]).shape
        except InputError:
            # Reported when the picture's turn comes, with its name
            return None
        return rows, columns
    return None


def _calibration(
    block: CalibrationBlock, findings: Findings, folder: Path, shape: tuple[int, int] | None
) -> CameraCalibration | None:
    from moyai.records.streaks.camera_calibration import Refraction, dry_to_wet, fit_homography, fit_ray_camera
    from moyai.records.streaks.camera_checks import require_fitting_targets

    path: KeyPath = ("calibration",)
    if block.refraction is None and (block.model == "rays" or block.dry):
        why = "the ray model needs them" if block.model == "rays" else "targets in the empty tank look smaller"
        findings.fault(path, f"'refraction' is missing: {why}", remedy="give the distances and the wall")
        return None
    if not (folder / block.targets).is_file():
        findings.fault((*path, "targets"), f"no such file: '{block.targets}'")
        return None
    try:
        names = {name: name for name in ("column", "row", "x", "z")}
        table = read_points(folder / block.targets, names, "calibration.targets")
        pixels = np.column_stack([table["column"], table["row"]])
        world = np.column_stack([table["x"], table["z"]])
        refraction = None
        if block.refraction is not None:
            given = block.refraction
            refraction = Refraction(
                given.camera_to_wall, given.wall_thickness, given.wall_index, given.sheet_distance, given.water_index
            )
        if block.model == "rays" and refraction is not None:
            if shape is None:
                return None if findings.faults else fit_homography(pixels, world)
            camera = fit_ray_camera(pixels, world, refraction=refraction, shape=shape, dry=block.dry)
            require_fitting_targets(camera, pixels, world)
            return camera
        plane = fit_homography(pixels, world)
        require_fitting_targets(plane, pixels, world)
        if block.dry and refraction is not None:
            middle = plane.to_world([[0.5 * (shape[1] - 1), 0.5 * (shape[0] - 1)]])[0] if shape else world.mean(axis=0)
            return dry_to_wet(plane, refraction, middle)
        return plane
    except (InputError, CaseError) as error:
        fault = error.fault if isinstance(error, InputError) else error.faults[0]
        findings.fault((*path, "targets"), fault.message, allowed=fault.allowed, remedy=fault.remedy)
        return None
