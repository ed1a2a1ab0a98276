"""Measured records: reading them, and what is found in surveys, force tests, net tests and streak images."""

from typing import TYPE_CHECKING

from moyai.core.exports import exports

if TYPE_CHECKING:
    from moyai.records.calibration import Calibration as Calibration
    from moyai.records.calibration import Parameter as Parameter
    from moyai.records.calibration import calibrate as calibrate
    from moyai.records.comparison.run import Pairing as Pairing
    from moyai.records.comparison.run import compare_result as compare_result
    from moyai.records.forces.fit import Setup as Setup
    from moyai.records.forces.identification import Identification as Identification
    from moyai.records.forces.identification import identify as identify
    from moyai.records.forces.record import ForceRecord as ForceRecord
    from moyai.records.nets.campaign import NetCampaign as NetCampaign
    from moyai.records.nets.campaign import NetFindings as NetFindings
    from moyai.records.nets.campaign import measure_nets as measure_nets
    from moyai.records.nets.case.build import load_nets as load_nets
    from moyai.records.nets.vibration import Vibration as Vibration
    from moyai.records.reading.reader import read_record as read_record
    from moyai.records.reading.record import Record as Record
    from moyai.records.reading.sources import ClockCorrection as ClockCorrection
    from moyai.records.reading.sources import ColumnSource as ColumnSource
    from moyai.records.reading.sources import LoggerSource as LoggerSource
    from moyai.records.reading.sources import TimeSource as TimeSource
    from moyai.records.survey.case.build import load_survey as load_survey
    from moyai.records.survey.model import Survey as Survey
    from moyai.records.survey.run import run_survey as run_survey
else:
    __getattr__, __dir__, __all__ = exports(
        __name__,
        {
            "calibration": "Calibration Parameter calibrate",
            "comparison.run": "Pairing compare_result",
            "forces.fit": "Setup",
            "forces.identification": "Identification identify",
            "forces.record": "ForceRecord",
            "nets.campaign": "NetCampaign NetFindings measure_nets",
            "nets.vibration": "Vibration",
            "nets.case.build": "load_nets",
            "reading.reader": "read_record",
            "reading.record": "Record",
            "reading.sources": "ClockCorrection ColumnSource LoggerSource TimeSource",
            "survey.case.build": "load_survey",
            "survey.model": "Survey",
            "survey.run": "run_survey",
        },
    )
