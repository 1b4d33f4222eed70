"""Files of elsewhere: how much of them is read, and one sentence for what is not."""

from __future__ import annotations

import io
import json
import os
import struct
import zipfile
import zlib
from pathlib import Path

import numpy as np
import pytest
from PIL import Image

from coopera.core.errors import LONGEST, ConfigError
from coopera.core.foreign.arrays import read_arrays
from coopera.core.foreign.files import load_json, read_json, read_limited, read_text
from coopera.core.foreign.pictures import MOST_PIXELS, open_picture
from coopera.core.foreign.tables import read_table


def test_a_file_is_read_up_to_its_limit_and_not_a_byte_further(tmp_path: Path) -> None:
    path = tmp_path / "a"
    path.write_bytes(b"x" * 10)
    assert read_limited(path, 10) == b"x" * 10
    with pytest.raises(ConfigError, match="a: the list has more than 9 bytes"):
        read_limited(path, 9, "list")


def test_a_device_without_an_end_is_refused_at_the_limit() -> None:
    with pytest.raises(ConfigError, match="more than 1 MiB"):
        read_limited(Path("/dev/zero"), 2**20)


@pytest.mark.parametrize("name", ["missing", "", "a\0b", "x" * 300])
def test_what_cannot_be_opened_is_one_sentence(tmp_path: Path, name: str) -> None:
    with pytest.raises(ConfigError, match=r"there is no such file|the file cannot be read"):
        read_text(tmp_path / name)


def test_json_has_a_bearable_depth_and_number_of_values(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    assert load_json("[" * 60 + "]" * 60)
    for deep in ("[" * 70 + "]" * 70, '{"a":' * 70 + "1" + "}" * 70, "[" * 100_000):
        with pytest.raises(ValueError, match="nested too deeply"):
            load_json(deep)
    monkeypatch.setattr("coopera.core.foreign.files.MOST_VALUES", 100)
    (tmp_path / "many.json").write_text(json.dumps([0] * 200))
    with pytest.raises(ConfigError, match=r"many.json: this is not valid JSON \(it holds more than 100 values\)"):
        read_json(tmp_path / "many.json")


def test_a_number_of_five_thousand_digits_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.json").write_text("9" * 5000)
    with pytest.raises(ConfigError, match="not valid JSON"):
        read_json(tmp_path / "a.json")


def test_a_table_has_a_bearable_number_of_lines(monkeypatch: pytest.MonkeyPatch) -> None:
    assert [row.cells for row in read_table(Path("a.csv"), "a,b\n\n1,2\n")] == [["a", "b"], ["1", "2"]]
    monkeypatch.setattr("coopera.core.foreign.tables.MOST_LINES", 3)
    with pytest.raises(ConfigError, match="a.csv: at most 3 lines"):
        read_table(Path("a.csv"), "1\n" * 4)


def test_an_archive_that_unpacks_to_gigabytes_is_refused_before_it_is_unpacked(tmp_path: Path) -> None:
    packed = zlib.compressobj(9, zlib.DEFLATED, -15)
    piece = packed.compress(b"\0" * 2**20) + packed.flush()
    path = tmp_path / "bomb.npz"
    with zipfile.ZipFile(path, "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("poses.npy", b"\0" * 2**20)
    data = bytearray(path.read_bytes())
    for mark, at in ((b"PK\x03\x04", 22), (b"PK\x01\x02", 24)):  # it says that 3.2 GB are in it
        struct.pack_into("<I", data, data.index(mark) + at, 3_200_000_000)
    path.write_bytes(data)
    assert len(piece) < len(data) < 3000
    with pytest.raises(ConfigError, match="unpacked it has more than 128 MiB"):
        read_arrays(path, ("poses",))


def npy(kind: str, shape: str, data: bytes = b"") -> bytes:
    head = f"{{'descr': {kind}, 'fortran_order': False, 'shape': {shape}, }}\n".encode()
    return b"\x93NUMPY\x01\x00" + struct.pack("<H", len(head)) + head + data


@pytest.mark.parametrize(
    "data",
    [
        npy("'<f8'", "(10000000000,)"),
        npy("'<f8'", "(-1,)"),
        npy("'<f8'", "('a',)"),
        npy("'|O'", "(1,)", b"\x80\x04N."),
        npy("'<U1000000000'", "()"),
        npy("'|V0'", "(10000000000,)"),
        npy("3", "()"),
        npy("'<f8'", "(" * 200),
        b"\x93NUMPY\x09\x00",
        b"PK\x01\x02" * 1001,
        b"",
    ],
)
def test_an_array_that_is_not_as_it_says_is_one_sentence(tmp_path: Path, data: bytes) -> None:
    (tmp_path / "a.npy").write_bytes(data)
    with pytest.raises(ConfigError, match=r"a\.npy cannot be read: .") as err:
        read_arrays(tmp_path / "a.npy", ("poses",))
    assert "\n" not in str(err.value)


@pytest.mark.parametrize("order", ["C", "F"])
def test_arrays_are_read_as_numpy_wrote_them(tmp_path: Path, order: str) -> None:
    rows = np.asarray(np.arange(12.0).reshape(3, 4), order=order)  # type: ignore[call-overload]
    np.save(tmp_path / "a.npy", rows)
    np.savez_compressed(tmp_path / "a.npz", poses=rows, rate=np.array(30), other=rows)
    assert np.array_equal(read_arrays(tmp_path / "a.npy", ()), rows)
    found = read_arrays(tmp_path / "a.npz", ("poses", "rate", "missing"))
    assert isinstance(found, dict)
    assert sorted(found) == ["poses", "rate"]
    assert np.array_equal(found["poses"], rows)


def test_a_way_of_packing_that_may_ask_for_gigabytes_is_refused(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "a.npz", "w", zipfile.ZIP_LZMA) as archive:
        archive.writestr("poses.npy", npy("'<f8'", "()", b"\0" * 8))
    with pytest.raises(ConfigError, match="compressed in a way"):
        read_arrays(tmp_path / "a.npz", ("poses",))


def picture(width: int, height: int) -> bytes:
    out = io.BytesIO()
    Image.new("RGB", (4, 4)).save(out, "PNG")
    head = b"IHDR" + struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    data = out.getvalue()
    return data[:12] + head + struct.pack(">I", zlib.crc32(head)) + data[33:]


def test_a_picture_that_claims_more_pixels_than_bearable_is_refused_before_it_is_decoded() -> None:
    side = int(MOST_PIXELS**0.5) + 1
    with pytest.raises(ValueError, match="too large"), open_picture(picture(side, side)):
        raise AssertionError("it was opened")
    with open_picture(picture(4, 4)) as image:
        assert image.convert("RGB").size == (4, 4)


@pytest.mark.parametrize("data", [b"", b"\x89PNG\r\n\x1a\n", picture(4, 4)[:38], b"GIF89a" + b"\0" * 100])
def test_what_is_no_picture_is_a_value_error(data: bytes) -> None:
    with pytest.raises(ValueError, match="."), open_picture(data) as image:
        image.convert("RGB")


def test_an_error_never_shows_all_of_a_long_text() -> None:
    assert str(ConfigError("short")) == "short"
    said = str(ConfigError("begins " + "x" * 10**6 + " ends"))
    assert len(said) <= LONGEST
    assert said.startswith("begins")
    assert said.endswith("ends")
    assert str(ConfigError("a file called\na\u2028b")) == "a file called a b"


def test_a_folder_in_place_of_a_file_is_one_sentence(tmp_path: Path) -> None:
    os.mkdir(tmp_path / "folder")
    with pytest.raises(ConfigError, match=r"the file cannot be read \(is a directory\)"):
        read_text(tmp_path / "folder")
