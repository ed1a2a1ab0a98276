"""The ``moyai measure`` commands: from records and pictures to statistics and coefficients."""

from __future__ import annotations

import typer

from moyai.cli.help_pages import SpokenGroup
from moyai.cli.measuring_decay import decay
from moyai.cli.measuring_flume import flume
from moyai.cli.measuring_forces import forces
from moyai.cli.measuring_nets import nets
from moyai.cli.measuring_records import records
from moyai.cli.measuring_snaps import snaps
from moyai.cli.measuring_streaks import streaks
from moyai.cli.measuring_tide import tide

measure = typer.Typer(
    name="measure",
    cls=SpokenGroup,
    no_args_is_help=True,
    rich_markup_mode=None,
    help="Turn records and pictures into statistics and coefficients.",
)
measure.command()(decay)
measure.command()(flume)
measure.command()(forces)
measure.command()(nets)
measure.command()(records)
measure.command()(snaps)
measure.command()(streaks)
measure.command()(tide)
