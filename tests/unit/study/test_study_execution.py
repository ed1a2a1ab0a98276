"""A study in processes on this machine: same bits, failures as rows, stops and goes on, full disks, other studies."""

import json
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
from moyai.core.results import read_result
from moyai.study.execute import run_study
from moyai.study.ledger import Ledger, LedgerRecord
from moyai.study.local import run_processes
from moyai.study.plan import load_study
from moyai.study.work import Task


def responses(result):
    return result.tree["SWL"]["response"].values


@pytest.mark.slow
def test_two_workers_give_the_same_bits_as_one(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=3, seeds=3))
    here = run_study(study, tmp_path / "here", study_cases.fast_case, workers=1)
    apart = run_study(study, tmp_path / "apart", study_cases.slow_case, workers=2)
    assert here.status == apart.status == "converged"
    assert np.array_equal(responses(here).view(np.int64), responses(apart).view(np.int64))
    expected = [[study_cases.response(0.2 + 0.05 * i, 5.0, seed) for seed in (1, 2, 3)] for i in range(3)]
    # The file holds the heights with two decimals
    assert np.allclose(responses(here), expected, rtol=1e-12)


def test_failures_become_labelled_rows_and_the_rest_goes_on(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=2, seeds=4))
    result = run_study(study, tmp_path / "out", study_cases.failing_case, workers=1)
    assert result.status == "outside_validity"
    status = result.tree["case_status"].values
    assert (status[:, 1] == "failed").all() and (status[:, 2] == "failed").all()
    assert (status[:, [0, 3]] == "converged").all()
    message = result.tree["case_message"].values
    assert "the float sinks" in message[0, 1] and "make it lighter" in message[0, 1]
    assert "ZeroDivisionError" in message[0, 2]
    assert np.isnan(responses(result)[:, 1:3]).all()
    assert np.isfinite(responses(result)[:, [0, 3]]).all()
    retried = run_study(study, tmp_path / "out", study_cases.fast_case, workers=1, retry_failed=True)
    assert retried.status == "converged"


@pytest.mark.slow
def test_a_case_that_kills_its_worker_is_a_failed_row(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=1, seeds=3))
    here = run_study(study, tmp_path / "here", study_cases.fast_case, workers=1)
    result = run_study(study, tmp_path / "out", study_cases.deadly_case, workers=2)
    assert result.tree["case_status"].values.tolist() == [["converged", "failed", "converged"]]
    assert "died twice" in result.tree["case_message"].values[0, 1]
    # the others have the bits of one worker
    assert np.array_equal(responses(here)[:, [0, 2]].view(np.int64), responses(result)[:, [0, 2]].view(np.int64))


@pytest.mark.slow
def test_a_case_that_kills_fresh_workers_is_not_taken_for_workers_that_do_not_start(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=1, seeds=2))
    task = Task(study.base, study.base_path.resolve(), study.wanted, None, study_cases.deadly_case)
    (record,) = run_processes(task, study.cases[1:], workers=1)
    assert record.status == "failed" and "died twice" in record.message


@pytest.mark.slow
def test_a_worker_that_died_once_costs_nothing(tmp_path, monkeypatch):
    monkeypatch.setenv("MOYAI_TEST_MARK", str(tmp_path / "mark"))
    study = load_study(study_cases.write_study(tmp_path, heights=1, seeds=3))
    result = run_study(study, tmp_path / "out", study_cases.once_deadly_case, workers=2)
    assert (tmp_path / "mark").exists()
    assert result.status == "converged"


def test_a_stopped_study_keeps_what_is_done_and_goes_on(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=2, seeds=4))
    ran = []

    def stop_after_three(case, progress):
        if len(ran) == 3:
            raise KeyboardInterrupt
        ran.append(case.model.waves[0].seed)
        return study_cases.fast_case(case, progress)

    first = run_study(study, tmp_path / "out", stop_after_three, workers=1)
    assert first.status == "interrupted" and "3 of 8" in first.message
    again = []

    def count(case, progress):
        again.append(1)
        return study_cases.fast_case(case, progress)

    second = run_study(study, tmp_path / "out", count, workers=1)
    assert len(again) == 5 and second.status == "converged"


@pytest.mark.slow
def test_workers_stop_in_the_middle_of_a_long_case(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=1, seeds=4))

    def stop(standing):
        raise KeyboardInterrupt

    began = time.monotonic()
    run_study(study, tmp_path / "out", study_cases.fast_case, workers=2, watch=stop)
    assert time.monotonic() - began < 20.0


def left_after(session: int, seconds: float) -> list[str]:
    """Return the processes of a session that are still there when the time is up; a loaded machine ends them late."""
    deadline = time.monotonic() + seconds
    while True:
        reported = subprocess.run(["pgrep", "-s", str(session)], capture_output=True, text=True, check=False)
        left = reported.stdout.split()
        if not left or time.monotonic() > deadline:
            return left
        time.sleep(0.2)


@pytest.mark.slow
@pytest.mark.skipif(sys.platform == "win32", reason="kill -9 is of POSIX")
def test_kill_9_loses_at_most_the_cases_in_flight_and_leaves_no_process(tmp_path):
    path = study_cases.write_study(tmp_path, heights=10, seeds=4)
    script = tmp_path / "script.py"
    script.write_text(
        "import sys\nfrom pathlib import Path\n"
        f"sys.path.insert(0, {str(Path(__file__).parent)!r})\n"
        "import study_cases\nfrom moyai.study.execute import run_study\nfrom moyai.study.plan import load_study\n"
        "if __name__ == '__main__':\n"
        f"    study = load_study({str(path)!r})\n"
        f"    run_study(study, Path({str(tmp_path / 'out')!r}), study_cases.slow_case, workers=2)\n",
        encoding="utf-8",
    )
    process = subprocess.Popen([sys.executable, str(script)], start_new_session=True)
    ledger = tmp_path / "out" / "study.jsonl"
    for _ in range(600):
        if ledger.exists() and len(ledger.read_text(encoding="utf-8").splitlines()) > 5:
            break
        time.sleep(0.05)
    os.kill(process.pid, signal.SIGKILL)
    process.wait()
    assert not left_after(process.pid, 30.0)
    done = len(ledger.read_text(encoding="utf-8").splitlines()) - 1
    assert 5 <= done < 40
    study = load_study(path)
    ran = []

    def count(case, progress):
        ran.append(1)
        return study_cases.fast_case(case, progress)

    result = run_study(study, tmp_path / "out", count, workers=1)
    assert result.status == "converged"
    assert len(ran) == 40 - done


def test_a_damaged_last_line_is_one_case_to_run_again(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=1, seeds=3))
    run_study(study, tmp_path / "out", study_cases.fast_case, workers=1)
    ledger = tmp_path / "out" / "study.jsonl"
    raw = ledger.read_bytes()
    ledger.write_bytes(raw[:-40])
    ran = []

    def count(case, progress):
        ran.append(case.model.waves[0].seed)
        return study_cases.fast_case(case, progress)

    result = run_study(study, tmp_path / "out", count, workers=1)
    assert ran == [3] and result.status == "converged"
    assert ledger.read_bytes().splitlines()[:-1] == raw.splitlines()[:-1]


def test_a_folder_of_another_study_is_refused_and_left_alone(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=1, seeds=2))
    run_study(study, tmp_path / "out", study_cases.fast_case, workers=1)
    before = (tmp_path / "out" / "study.jsonl").read_bytes()
    other = load_study(study_cases.write_study(tmp_path, heights=1, seeds=3))
    with pytest.raises(InputError, match="another study"):
        run_study(other, tmp_path / "out", study_cases.fast_case, workers=1)
    assert (tmp_path / "out" / "study.jsonl").read_bytes() == before


def test_a_second_run_in_the_same_folder_is_refused_while_the_first_is_at_work(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=2, seeds=2))
    reported = []

    def meddle(standing):
        if standing.done == 2:
            with pytest.raises(InputError, match="another run is at work"):
                run_study(study, tmp_path / "out", study_cases.fast_case, workers=1)
            reported.append(standing.done)

    run_study(study, tmp_path / "out", study_cases.fast_case, workers=1, watch=meddle)
    assert reported == [2]
    assert len((tmp_path / "out" / "study.jsonl").read_text(encoding="utf-8").splitlines()) == 1 + 4
    # The folder is free again afterwards
    assert run_study(study, tmp_path / "out", study_cases.fast_case, workers=1).status == "converged"


def test_a_changed_base_case_is_another_study(tmp_path):
    path = study_cases.write_study(tmp_path, heights=1, seeds=2)
    first = load_study(path)
    base = tmp_path / "base.yaml"
    base.write_text(base.read_text(encoding="utf-8").replace("draught: 3 m", "draught: 2.9 m"), encoding="utf-8")
    assert load_study(path).key != first.key


def test_every_case_is_written_at_once_and_the_disk_is_asked_once_a_second(tmp_path, monkeypatch):
    asked = []
    monkeypatch.setattr(os, "fsync", asked.append)
    ledger = Ledger(tmp_path, "key", "title")
    for index in range(50):
        ledger.add(LedgerRecord(index, "converged", "", 1.0, {"x": index}))
        # What the system holds outlives the process, whatever ends it
        assert len((tmp_path / "study.jsonl").read_text(encoding="utf-8").splitlines()) == index + 2
    assert len(asked) <= 2
    ledger.settle()
    assert 2 <= len(asked) <= 3

    def full(number):
        raise OSError(28, "No space left on device")

    monkeypatch.setattr(os, "fsync", full)
    with pytest.raises(InputError, match="No space left on device; the cases finished before are safe"):
        ledger.settle()
    ledger.close()


def test_a_full_disk_says_so_and_keeps_the_cases_before(tmp_path):
    ledger = Ledger(tmp_path, "key", "title")
    ledger.add(LedgerRecord(0, "converged", "", 1.0, {}))

    class Full:
        def write(self, text):
            raise OSError(28, "No space left on device")

        def close(self):
            raise OSError(28, "No space left on device")

    whole = ledger._file
    ledger._file = Full()
    with pytest.raises(InputError, match="No space left on device; the cases finished before are safe"):
        ledger.add(LedgerRecord(1, "converged", "", 1.0, {}))
    ledger.close()
    whole.close()
    again = Ledger(tmp_path, "key", "title")
    assert [record.index for record in again.records()] == [0]
    again.close()


def test_numbers_survive_the_diary_to_the_last_bit(tmp_path):
    rng = np.random.default_rng(5)
    numbers = rng.standard_normal(200) * 10.0 ** rng.integers(-300, 300, 200)
    ledger = Ledger(tmp_path, "key", "title")
    ledger.add(LedgerRecord(0, "converged", "", 1.0, {"a": {"values": numbers.tolist()}}))
    read = next(ledger.records()).values["a"]["values"]
    ledger.close()
    assert np.array_equal(np.array(read).view(np.int64), numbers.view(np.int64))


def test_results_of_every_case_and_the_whole_study_can_be_read_back(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=2, seeds=2, keep="results"))
    result = run_study(study, tmp_path / "out", study_cases.fast_case, workers=1)
    result.write(tmp_path / "out" / "study.nc")
    back = read_result(tmp_path / "out" / "study.nc")
    assert np.array_equal(responses(back), responses(result))
    assert back.tree["SWL"]["response"].dims == ("significant_height", "seed")
    assert list(back.tree["SWL"]["tension"].coords["line"].values) == ["seaward", "shoreward"]
    assert back.tree["SWL"]["significant_height"].attrs["units"] == "m"
    one = read_result(tmp_path / "out" / "cases" / "000003" / "results.nc")
    assert one.tree["SWL"]["response"].item() == responses(result)[1, 1]


def test_asked_for_responses_are_reduced_by_the_worker(tmp_path):
    study = load_study(
        study_cases.write_study(
            tmp_path, heights=1, seeds=2, responses="[{variable: SWL/series, reduce: maximum}]", watch="SWL/response"
        )
    )
    standings = []
    result = run_study(study, tmp_path / "out", study_cases.fast_case, workers=1, watch=standings.append)
    value = responses(result)
    assert np.array_equal(result.tree["SWL"]["series_maximum"].values, np.maximum(value, 3 * value))
    assert "series" not in result.tree["SWL"]
    assert standings[-1].largest[0] == value.max() and standings[-1].smallest[0] == value.min()


def test_a_response_that_does_not_exist_fails_by_name(tmp_path):
    study = load_study(
        study_cases.write_study(tmp_path, heights=1, seeds=1, responses="[{variable: HWL/series, reduce: maximum}]")
    )
    result = run_study(study, tmp_path / "out", study_cases.fast_case, workers=1)
    assert result.status == "failed"
    assert "SWL/series" in str(result.tree["case_message"].values[0, 0])


def test_lost_lines_leave_gaps_where_there_is_no_such_line(tmp_path):
    study = load_study(study_cases.write_text(tmp_path, "- lines_lost: true"))
    result = run_study(study, tmp_path / "out", study_cases.fast_case, workers=1)
    assert list(result.tree["SWL"]["lost_line"].values) == ["intact", "one of seaward", "shoreward"]
    count = result.tree["SWL"]["count"].sel(line="seaward").values
    assert count.tolist() == [2.0, 1.0, 2.0]
    gone = result.tree["SWL"]["count"].sel(line="shoreward").values
    assert gone[:2].tolist() == [1.0, 1.0] and np.isnan(gone[2])


def test_the_diary_is_plain_lines(tmp_path):
    study = load_study(study_cases.write_study(tmp_path, heights=1, seeds=1))
    run_study(study, tmp_path / "out", study_cases.fast_case, workers=1)
    lines = (tmp_path / "out" / "study.jsonl").read_text(encoding="utf-8").splitlines()
    assert json.loads(lines[0])["title"] == "test"
    assert json.loads(lines[1])["status"] == "converged"
