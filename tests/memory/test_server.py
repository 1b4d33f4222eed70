from __future__ import annotations

import signal
import socket
import subprocess
import sys
import time
from collections.abc import Iterator
from pathlib import Path

import pytest

from coopera.core.errors import ConfigError, MemoryStoreError
from coopera.memory import MemoryStream, streams
from tests.memory.fakes import Letters


def free_port() -> int:
    with socket.socket() as probe:
        probe.bind(("127.0.0.1", 0))
        port: int = probe.getsockname()[1]
        return port


def start(folder: Path, port: int) -> subprocess.Popen[bytes]:
    """Start a Chroma server and wait until it listens."""
    chroma = Path(sys.executable).with_name("chroma")
    command = [str(chroma), "run", "--path", str(folder), "--host", "127.0.0.1", "--port", str(port)]
    server = subprocess.Popen(command, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, cwd=folder)
    give_up = time.monotonic() + 60
    while time.monotonic() < give_up:
        assert server.poll() is None
        with socket.socket() as probe:
            probe.settimeout(1)
            if probe.connect_ex(("127.0.0.1", port)) == 0:
                return server
    server.kill()
    raise AssertionError("the server did not start")


@pytest.fixture
def server(tmp_path: Path) -> Iterator[str]:
    port = free_port()
    process = start(tmp_path, port)
    yield f"http://127.0.0.1:{port}"
    process.kill()
    process.wait()


def test_a_stream_lives_on_a_server_as_in_a_folder(server: str) -> None:
    with MemoryStream.open(server, "x", Letters()) as stream:
        stream.add(["a", "ab"], 3, [{"n": 1}, {}])
        stream.add(["b"], 5)
        stream.forget_from(5)
        stream.add(["c"], 5)
        before = stream.recall("a", 6, 3)
        assert [item.text for item in before] == ["a", "ab", "c"]
    with MemoryStream.open(server, "x", Letters()) as stream:
        assert stream.recall("a", 6, 3) == before
        assert before[0].metadata == {"n": 1}
    assert streams(server) == ["x"]
    with pytest.raises(MemoryStoreError, match="'letters', not 'others'"):
        MemoryStream.open(server, "x", Letters("others"))
    check_that_a_second_writer_is_told(server)


def check_that_a_second_writer_is_told(server: str) -> None:
    code = (
        "import sys; from coopera.memory import MemoryStream; from tests.memory.fakes import Letters\n"
        "MemoryStream.open(sys.argv[1], 'x', Letters()).add(['bad'], 5)"
    )
    with MemoryStream.open(server, "x", Letters()) as stream:
        root = Path(__file__).parents[2]
        subprocess.run([sys.executable, "-c", code, server], check=True, cwd=root)
        with pytest.raises(MemoryStoreError, match="another process writes to this stream"):
            stream.add(["dad"], 6)
        assert [record.text for record in stream.latest(2)] == ["bad", "c"]
        stream.add(["dad"], 6)


@pytest.mark.slow
def test_a_killed_server_has_lost_nothing_when_it_is_back(tmp_path: Path) -> None:
    port = free_port()
    server = start(tmp_path, port)
    stream = MemoryStream.open(f"http://127.0.0.1:{port}", "x", Letters())
    for hour in range(20):
        stream.add(["abcd", "ab"], hour)
    server.send_signal(signal.SIGKILL)
    server.wait()
    with pytest.raises(MemoryStoreError, match="does not answer"):
        stream.add(["late"], 30)
    server = start(tmp_path, port)
    assert len(stream.recall("a", 30, 99)) == 40
    stream.close()
    server.kill()
    server.wait()


def test_a_server_that_is_down_is_told_at_once() -> None:
    with pytest.raises(MemoryStoreError, match="the memory server does not answer"):
        MemoryStream.open(f"http://127.0.0.1:{free_port()}", "x", Letters())


def test_a_server_that_hangs_is_told_after_a_bounded_wait(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("coopera.memory.client._PATIENCE", 0.3)
    with (
        socket.create_server(("127.0.0.1", 0)) as silent,
        pytest.raises(MemoryStoreError, match="does not answer .ReadTimeout"),
    ):
        MemoryStream.open(f"http://127.0.0.1:{silent.getsockname()[1]}", "x", Letters())


@pytest.mark.parametrize("url", ["http://", "http://host:port", "https://:8000"])
def test_a_url_that_is_none_is_told(url: str) -> None:
    with pytest.raises(ConfigError, match="is no address of a memory server"):
        MemoryStream.open(url, "x", Letters())
