"""A scheduler that is lost costs no case: one message, and the same command runs the cases again."""

import pytest

from moyai.core.errors import InputError
from moyai.study import on_dask
from moyai.study.axes import Combination


class Future:
    def __init__(self, status):
        self.status, self.key = status, "key"

    def exception(self):
        return None


@pytest.mark.parametrize("status", ["cancelled", "lost"])
def test_a_case_that_nobody_knows_of_any_more_is_no_failure(status):
    with pytest.raises(InputError, match="the connection to the scheduler of the cluster was lost; start"):
        list(on_dask._records(None, [(Future(status), Combination(3, (), ()))], {}))


def test_errors_of_a_lost_client_become_one_message():
    distributed = pytest.importorskip("distributed", reason="needs dask.distributed (extra 'cluster')")
    lost = type("ClosedClientError", (Exception,), {})

    class Client(distributed.Client):
        def __init__(self):
            pass

        def __del__(self):
            pass

        def nthreads(self):
            return {"worker": 1}

    with pytest.raises(InputError, match="connection to the scheduler"), on_dask._client(Client()):
        raise lost("gone")
    with pytest.raises(ZeroDivisionError), on_dask._client(Client()):
        raise ZeroDivisionError
