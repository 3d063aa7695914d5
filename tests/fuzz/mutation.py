"""Ways to damage a file, with knowledge of what formats are made of."""

from __future__ import annotations

import copy
import json
import random
import struct
import zlib
from collections.abc import Callable, Sequence
from typing import Any

Mutator = Callable[[bytes, random.Random], bytes]
"""(content, random numbers) -> damaged content."""

WORDS = tuple(
    struct.pack(kind, value)
    for kind in ("<I", ">I")
    for value in (0, 1, 0x7FFFFFFF, 0x80000000, 0xFFFFFFFF, 0x10000, 0x7FC00000)
)
"""Counts at the ends of their types, and NaN."""

JSON_VALUES: tuple[Any, ...] = (
    None, True, -1, 0, 1, 2, 3.5, 1e308, 2**31, 2**32 - 2, 2**63, 10**400, "", "VEC2", "nan", "../x.png", "%2e%2e/x",
    "data:;base64,AAAA", [], [0], {}, [[[]]], [1e301] * 3, [0] * 16,
)  # fmt: skip


def damaged(content: bytes, rng: random.Random, tokens: Sequence[bytes] = ()) -> bytes:
    """One to five injuries: bytes changed, removed, repeated, swapped or overwritten by a token, or the end lost."""
    data = bytearray(content)
    for _ in range(rng.choice((1, 1, 1, 2, 3, 5))):
        # Half of them in the head, where sizes, types and offsets are.
        at = rng.randrange(min(len(data), 160) + 1 if rng.random() < 0.5 else len(data) + 1)
        size = rng.choice((1, 1, 2, 4, 8, 16, 64))
        way = rng.randrange(7)
        if way == 0 and at < len(data):
            data[at] = rng.randrange(256)
        elif way == 1 and at < len(data):
            data[at] ^= 1 << rng.randrange(8)
        elif way == 2:
            del data[at : at + size]
        elif way == 3:
            data[at:at] = data[at : at + size * rng.choice((1, 1, 8))]
        elif way == 4:
            word = rng.choice(tuple(tokens) or WORDS)
            data[at : at + rng.choice((0, len(word), size))] = word
        elif way == 5:
            word = rng.choice(WORDS)
            data[at : at + 4] = word
        elif rng.random() < 0.2:
            del data[at:]
    return bytes(data)


def by_tokens(*tokens: bytes) -> Mutator:
    """Damage of text: tokens of the format come into it."""
    return lambda content, rng: damaged(content, rng, tokens)


def binary(content: bytes, rng: random.Random) -> bytes:
    """Damage of binary data."""
    return damaged(content, rng)


def mutated_value(data: Any, rng: random.Random) -> Any:
    """A JSON value with one to three of the values in it replaced, removed or repeated."""
    data = copy.deepcopy(data)
    for _ in range(rng.randint(1, 3)):
        node = data
        while isinstance(node, (dict, list)) and node:
            key: Any = rng.choice(list(node) if isinstance(node, dict) else range(len(node)))
            if isinstance(node[key], (dict, list)) and node[key] and rng.random() > 0.15:
                node = node[key]
                continue
            way = rng.random()
            if way < 0.15:
                node.pop(key)
            elif way < 0.25 and isinstance(node, list):
                node.insert(key, copy.deepcopy(node[key]))
            else:
                node[key] = rng.choice(JSON_VALUES)
            break
    return data


def json_document(content: bytes, rng: random.Random) -> bytes:
    """Damage of JSON: of its values, or now and then of its bytes."""
    if rng.random() < 0.8:
        try:
            return json.dumps(mutated_value(json.loads(content), rng)).encode()
        except (ValueError, RecursionError):
            pass
    return damaged(content, rng, (b"[", b"]", b"{", b"}", b'"', b",", b":", b"1e999", b"-", b"\\u0000", b"null"))


def glb(content: bytes, rng: random.Random) -> bytes:
    """Damage of a GLB: of the JSON's values, of the chunks' bytes with right sizes, or of anything."""
    way = rng.random()
    try:
        size = struct.unpack_from("<I", content, 12)[0]
        text, rest = content[20 : 20 + size], content[20 + size :]
        if way < 0.6:
            text = json_document(text, rng)
        elif way < 0.8:
            rest = rest[:8] + damaged(rest[8:], rng)
            rest = struct.pack("<I", len(rest) - 8) + rest[4:]
        else:
            return damaged(content, rng)
    except struct.error:
        return damaged(content, rng)
    text += b" " * (-len(text) % 4)
    return content[:8] + struct.pack("<II", 20 + len(text) + len(rest), len(text)) + content[16:20] + text + rest


def png(content: bytes, rng: random.Random) -> bytes:
    """Damage of a PNG, most times with checksums that are right again, so that it gets past them."""
    data = damaged(content, rng)
    return with_checksums(data) if rng.random() < 0.75 else data


def with_checksums(data: bytes) -> bytes:
    """A PNG's chunks with right checksums, as far as they can be made out."""
    result, at = data[:8], 8
    while at + 8 <= len(data):
        length = min(struct.unpack_from(">I", data, at)[0], len(data) - at - 8)
        body = data[at + 4 : at + 8 + length]
        result += data[at : at + 4] + body + struct.pack(">I", zlib.crc32(body))
        at += 12 + length
    return result
