"""Change bytes at random, as chance, a broken disk or a bad will might: anywhere, or in JSON, YAML and XML as such."""

from __future__ import annotations

import io
import json
import struct
import zipfile
from collections.abc import Callable, Sequence
from random import Random
from typing import Any
from xml.etree import ElementTree

import numpy as np
import yaml

Mutate = Callable[[Random, bytes], bytes]

_DEEP: Any = None
for _ in range(200):
    _DEEP = [_DEEP]
ODD: tuple[Any, ...] = (
    *(None, True, False, 0, 1, -1, 2**31, 2**63, 10**30, -(10**30), 0.5, 1e308, -1e308, 1e-320),
    *(float("nan"), float("inf"), "", " ", "x", "0", "nan", "../../../etc/passwd", "/dev/zero", "\0", "\ud7ff\u2028"),
    *("9" * 5000, "a" * 3000, "<script>alert(1)</script>", "\x1b[2J", [], {}, [[]], [None], {"": {}}, [1, [2, [3]]]),
    *({"a": {"b": {"c": 1}}}, _DEEP, "2024-13-45", "12:61", [0.0, 0.0, 0.0, 0.0], [1e200] * 16),
)
"""Values that stand where another was."""
TOKENS = (
    *(
        b"\0",
        b"\xff",
        b"\xef\xbb\xbf",
        b"\r\n",
        b"\n",
        b'"',
        b"'",
        b",",
        b";",
        b"{",
        b"}",
        b"[",
        b"]",
        b":",
        b"#",
        b"-",
    ),
    *(b"!!set {a}", b"!!int x", b"!!float x", b"!!bool x", b"!!timestamp x", b"!!binary x", b"!!python/name:os.system"),
    *(b"&a [*a]", b"*a", b"<<: {a: 1}", b"0x_", b"2024-13-45", b"1e999", b"NaN", b"9" * 5000, b"[" * 5000, b"%YAML 9"),
    *(
        b"? ",
        b"| \n",
        b"---\n",
        b"...\n",
        b"{{ x }}",
        b"{% if x %}",
        b"{% endif %}",
        b"{{ ''.upper ~ '' }}",
        b"\\u0000",
    ),
    *(
        b"{% for a in intentions %}",
        b"{% endfor %}",
        b"|map('map','upper')",
        b"</think>",
        b"```json\n",
        b"-1",
        b"1e308",
    ),
)
_WORDS = (0, 1, 0x7F, 0x80, 0xFF, 0x7FFF, 0xFFFF, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF)


def anywhere(rng: Random, data: bytes) -> bytes:
    """Some changes of bytes: flipped, cut out, doubled, moved, put in, or the end lost."""
    for _ in range(rng.choice((1, 1, 1, 2, 3, 8))):
        at = rng.randrange(len(data) + 1)
        to = min(len(data), at + rng.choice((1, 1, 2, 4, 16, 200)))
        match rng.randrange(7):
            case 0:
                data = data[:at] + bytes(byte ^ (1 << rng.randrange(8)) for byte in data[at : at + 1]) + data[at + 1 :]
            case 1:
                data = data[:at] + data[to:]
            case 2:
                data = data[:to] + data[at:to] * rng.choice((1, 1, 2, 50)) + data[to:]
            case 3:
                data = data[:at] + rng.choice(TOKENS) + data[at:]
            case 4:
                data = data[:at] + rng.choice(TOKENS) + data[to:]
            case 5:
                data = data[:at] + struct.pack("<I", rng.choice(_WORDS)) + data[at + 4 :]
            case _:
                data = data[:at] if rng.random() < 0.3 else data[:at] + rng.randbytes(to - at) + data[to:]
    return data


def in_json(rng: Random, data: bytes) -> bytes:
    """Some values of a JSON text changed for odd ones."""
    if rng.random() < 0.3:
        return anywhere(rng, data)
    return json.dumps(_other(rng, json.loads(data))).encode()


def in_xml(rng: Random, data: bytes) -> bytes:
    """Some elements of an XML text lost, doubled or moved, or their texts and attributes changed for odd ones."""
    if rng.random() < 0.3:
        return anywhere(rng, data)
    root = ElementTree.fromstring(data)
    for _ in range(rng.choice((1, 1, 2, 3))):
        every = [(one, inner) for one in root.iter() for inner in one]
        if every:
            _change_element(rng, *rng.choice(every), rng.choice(every)[1])
    return ElementTree.tostring(root)


def _change_element(
    rng: Random, parent: ElementTree.Element, one: ElementTree.Element, other: ElementTree.Element
) -> None:
    odd = rng.choice([str(value)[:5000] for value in ODD if value != "\0"])
    match rng.randrange(7):
        case 0:
            parent.remove(one)
        case 1:
            parent.extend([one] * rng.choice((1, 1, 2, 50)))
        case 2 if one not in other.iter() and other not in one.iter():
            other.append(one)
        case 3 if one.attrib:
            one.set(rng.choice(list(one.attrib)), rng.choice((odd, *other.attrib.values())))
        case 4 if one.attrib:
            del one.attrib[rng.choice(list(one.attrib))]
        case 5:
            one.text = rng.choice((odd, other.text))
        case _:
            words = (one.text or "").split() or [""]
            words[rng.randrange(len(words))] = odd
            one.text = " ".join(words)


def in_lines(rng: Random, data: bytes) -> bytes:
    """As `in_json`, in one line of many."""
    lines = data.splitlines()
    if rng.random() < 0.3 or not lines:
        return anywhere(rng, data)
    at = rng.randrange(len(lines))
    lines[at] = in_json(rng, lines[at])
    return b"\n".join(lines)


def in_yaml(rng: Random, data: bytes) -> bytes:
    """Some values of a YAML text changed for odd ones."""
    if rng.random() < 0.5:
        return anywhere(rng, data)
    changed = _other(rng, yaml.load(data, yaml.CSafeLoader))
    if rng.random() < 0.5:  # JSON is YAML, and is written faster
        return json.dumps(changed, ensure_ascii=False).encode("utf-8", "surrogatepass")
    return yaml.dump(changed, Dumper=yaml.CSafeDumper, allow_unicode=True).encode("utf-8", "surrogatepass")


def in_cells(rng: Random, data: bytes) -> bytes:
    """Some cells of a comma-separated text changed."""
    lines = data.split(b"\n")
    if rng.random() < 0.4:
        return anywhere(rng, data)
    for _ in range(rng.choice((1, 1, 2, 5))):
        at = rng.randrange(len(lines))
        cells = lines[at].split(b",")
        cells[rng.randrange(len(cells))] = rng.choice([*TOKENS, *(str(one)[:4000].encode() for one in ODD[:30])])
        lines[at] = b",".join(cells)
        if rng.random() < 0.2:
            lines.insert(rng.randrange(len(lines)), lines[at])
    return b"\n".join(lines)


def in_glb(rng: Random, data: bytes) -> bytes:
    """The description of a binary glTF file changed, the rest kept; or its bytes."""
    if rng.random() < 0.3:
        return anywhere(rng, data)
    (size,) = struct.unpack_from("<I", data, 12)
    text = in_json(rng, data[20 : 20 + size])
    body = struct.pack("<II", len(text), 0x4E4F534A) + text + data[20 + size :]
    return b"glTF" + struct.pack("<II", 2, 12 + len(body)) + body


def in_npy(rng: Random, data: bytes) -> bytes:
    """The header of a NumPy file changed, or its bytes."""
    if rng.random() < 0.3:
        return anywhere(rng, data)
    end = 10 + struct.unpack_from("<H", data, 8)[0]
    kinds = ("'<f8'", "'|O'", "'<U1000000000'", "'|V0'", "'<i2'", "[('a', '<f8')]", "'<M8[s]'", "'>c16'", "3", "'<f4'")
    shapes = (
        "(10, 322)",
        "()",
        "(-1,)",
        "(10000000000,)",
        "(0, 322)",
        "(2, 322, 1)",
        "('a',)",
        "3",
        "(1e3,)",
        "(322,)",
    )
    head = f"{{'descr': {rng.choice(kinds)}, 'fortran_order': {rng.choice(('True', 'False', '7'))}, "
    text = anywhere(rng, data[10:end]) if rng.random() < 0.3 else f"{head}'shape': {rng.choice(shapes)}, }}\n".encode()
    version = rng.choice((b"\x01\x00", b"\x01\x00", b"\x02\x00", b"\x03\x00", b"\x09\x00"))
    return b"\x93NUMPY" + version + struct.pack("<H", len(text)) + text + data[end:]


def in_npz(rng: Random, data: bytes) -> bytes:
    """Members of a NumPy archive changed, or its bytes."""
    if rng.random() < 0.4:
        return anywhere(rng, data)
    out = io.BytesIO()
    with zipfile.ZipFile(io.BytesIO(data)) as old, zipfile.ZipFile(out, "w", zipfile.ZIP_DEFLATED) as new:
        for name in old.namelist():
            chance = rng.random()
            if chance < 0.1:
                continue
            content = old.read(name)
            if chance < 0.35:
                content = in_npy(rng, content)
            elif chance < 0.5:
                content = _as_npy(np.array(rng.choice((0, 30.0, -1, 1e400, "x", b"y", [1, 2], [[]], [[1.0]], 1 + 2j))))
            new.writestr(name, content)
    return out.getvalue()


def _as_npy(array: Any) -> bytes:
    out = io.BytesIO()
    np.save(out, array, allow_pickle=False)
    return out.getvalue()


def _other(rng: Random, data: Any) -> Any:
    """Data with one to three places changed."""
    for _ in range(rng.choice((1, 1, 2, 3))):
        data = _changed(rng, data)
    return data


def _changed(rng: Random, data: Any) -> Any:
    """A copy of data that is different at one place, which is the likelier the nearer it is to the root."""
    if not isinstance(data, dict | list) or not data or rng.random() < 0.05:
        return rng.choice(ODD)
    copied: Any = data.copy()
    key: Any = rng.choice(list(data)) if isinstance(data, dict) else rng.randrange(len(data))
    match rng.randrange(12):
        case 0:
            del copied[key]
        case 1 if isinstance(copied, dict):
            copied[rng.choice(("", "x", "id", "__class__", "a" * 3000))] = rng.choice(ODD)
        case 1:
            copied.insert(key, copied[rng.randrange(len(copied))])
        case 2 if isinstance(copied, dict):
            copied[key] = copied[rng.choice(list(copied))]
        case 2:
            copied *= rng.choice((2, 3, 40))
        case 3:
            copied[key] = rng.choice(ODD)
        case _:
            copied[key] = _changed(rng, data[key])
    return copied


def blend(rng: Random, seeds: Sequence[bytes]) -> bytes:
    """A seed; now and then the beginning of one and the end of another."""
    one = rng.choice(seeds)
    if len(seeds) < 2 or rng.random() < 0.9:
        return one
    other = rng.choice(seeds)
    return one[: rng.randrange(len(one) + 1)] + other[rng.randrange(len(other) + 1) :]
