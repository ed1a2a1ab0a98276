"""The build of the documentation ends where a page has a link that leads nowhere."""

from pathlib import Path

import pytest

pytest.importorskip("sphinx")
from links_checked import dead_links


def test_links_to_files_and_places_that_are_not_there(tmp_path: Path) -> None:
    (tmp_path / "a b").mkdir()
    (tmp_path / "a b" / "index.html").write_text('<h1 id="図">x</h1><a href="../one.html#here">x</a>', encoding="utf-8")
    (tmp_path / "one.html").write_text(
        '<h1 id="here">x</h1><a href="a%20b/index.html#図"></a><a href="a%20b/"></a><a href="#here"></a>'
        '<a href="https://example.org/x"></a><img src="data:image/png,x"><script>\'<a href="no.html">\'</script>',
        encoding="utf-8",
    )
    assert dead_links(tmp_path) == []
    (tmp_path / "two.html").write_text(
        '<a class="x" href="gone.html"></a><img src="a b/gone.png?v=1"><a href="one.html#there"></a><a href="#up"></a>',
        encoding="utf-8",
    )
    assert dead_links(tmp_path) == [
        "two.html: #up", "two.html: a b/gone.png?v=1", "two.html: gone.html", "two.html: one.html#there",
    ]  # fmt: skip
