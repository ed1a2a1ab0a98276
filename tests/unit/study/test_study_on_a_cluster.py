"""A real scheduler and two real workers on loopback; one of them is killed on the way."""

import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
import study_cases

from moyai.core.errors import InputError
from moyai.study.execute import run_study
from moyai.study.plan import load_study

distributed = pytest.importorskip("distributed", reason="needs dask.distributed (extra 'cluster')")

pytestmark = pytest.mark.slow


def _start(*arguments):
    environment = {**os.environ, "PYTHONPATH": str(Path(__file__).parent)}
    return subprocess.Popen(
        [sys.executable, "-m", *arguments], env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL
    )


@pytest.fixture
def cluster(tmp_path):
    yield from started(tmp_path)


@pytest.fixture(scope="module")
def lasting_cluster(tmp_path_factory):
    yield from started(tmp_path_factory.mktemp("cluster"))


def started(tmp_path):
    address = tmp_path / "scheduler.json"
    scheduler = _start(
        "distributed.cli.dask_scheduler", "--host", "127.0.0.1", "--port", "0", "--no-dashboard",
        "--scheduler-file", str(address),
    )  # fmt: skip
    workers = []
    try:
        for _ in range(300):
            if address.exists() and address.stat().st_size:
                break
            time.sleep(0.1)
        workers = [
            _start(
                "distributed.cli.dask_worker", "--scheduler-file", str(address), "--nthreads", "1", "--no-dashboard",
                "--no-nanny", "--local-directory", str(tmp_path),
            )
            for _ in range(2)
        ]  # fmt: skip
        client = distributed.Client(scheduler_file=str(address), set_as_default=False)
        client.wait_for_workers(2, timeout=60)
        yield client, workers
        client.close()
    finally:
        for process in (*workers, scheduler):
            process.kill()
            process.wait()


def test_a_killed_worker_costs_no_case_and_no_bit(cluster, tmp_path, monkeypatch):
    client, workers = cluster
    study = load_study(study_cases.write_study(tmp_path, heights=4, seeds=4))
    killed = []

    def watch(standing):
        if standing.done == 5:
            os.kill(workers[0].pid, signal.SIGKILL)
            killed.append(standing.done)

    # The client's own note of the scheduler is renewed as well, without the workers: it must not be relied on
    monkeypatch.setattr(client, "scheduler_info", lambda n_workers=0: {"workers": {}})
    on_cluster = run_study(study, tmp_path / "cluster", study_cases.slow_case, workers=1, on=client, watch=watch)
    here = run_study(study, tmp_path / "here", study_cases.fast_case, workers=1)
    assert killed
    assert on_cluster.status == here.status == "converged"
    assert np.array_equal(
        on_cluster.tree["SWL"]["response"].values.view(np.int64), here.tree["SWL"]["response"].values.view(np.int64)
    )


PONTOON = """\
moyai: 1
study:
  title: the pontoon itself
  base: {base}
  set: {{analyses: [frequency], site.water_levels: {{SWL: 0 m}}}}
  variations:
    - grid: {{'waves[design storm].significant_height': [0.4 m, 0.7 m]}}
    - seeds: {{path: 'waves[design storm].seed', count: 2}}
"""


@pytest.fixture(scope="module")
def pontoon(tmp_path_factory):
    """The study of the pontoon, and its result by one process."""
    from moyai.cli.runner import run

    folder = tmp_path_factory.mktemp("pontoon")
    path = folder / "study.yaml"
    path.write_text(PONTOON.format(base=Path(__file__).parents[3] / "examples" / "pontoon.yaml"), encoding="utf-8")
    study = load_study(path)
    return study, run_study(study, folder / "here", run, workers=1)


@pytest.mark.parametrize("by_post", [True, False])
def test_the_pontoon_itself_has_the_same_bits_on_a_cluster(lasting_cluster, pontoon, tmp_path, monkeypatch, by_post):
    from moyai.cli.runner import run

    (client, _), (study, here) = lasting_cluster, pontoon
    if by_post:
        monkeypatch.setattr(client, "gather", None)
    else:
        # What is too large for the post, or gets lost in it, is fetched
        monkeypatch.setattr(client, "subscribe_topic", lambda name, handler: None)
        monkeypatch.setattr(client, "unsubscribe_topic", lambda name: None)
    on_cluster = run_study(study, tmp_path / "cluster", run, workers=1, on=client)
    numbers = 0
    for node in here.tree.subtree:
        for name, variable in node.data_vars.items():
            if variable.dtype == float:
                other = on_cluster.tree[node.path][name].values
                assert np.array_equal(variable.values.view(np.int64), other.view(np.int64)), name
                numbers += variable.size
    assert numbers > 500


def test_nobody_at_the_address_says_how_to_start_a_scheduler(tmp_path, monkeypatch):
    monkeypatch.setattr("moyai.study.on_dask._CONNECT", 1.0)
    study = load_study(study_cases.write_study(tmp_path, heights=1, seeds=1))
    with pytest.raises(InputError, match="dask scheduler"):
        run_study(study, tmp_path / "out", study_cases.fast_case, workers=1, on="dask://127.0.0.1:9")


@pytest.mark.parametrize("on", ["tcp://127.0.0.1:8786", "dask://h:port", "dask://h:99999", "dask://:1", "dask://h"])
def test_an_address_of_another_kind_is_refused(tmp_path, on):
    study = load_study(study_cases.write_study(tmp_path, heights=1, seeds=1))
    with pytest.raises(InputError, match="dask://host:port"):
        run_study(study, tmp_path / "out", study_cases.fast_case, workers=1, on=on)
