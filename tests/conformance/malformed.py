"""One file for each way of failing, with the section and field that the error must name.

Built by hand around the smallest valid document: one chart without UV, one material, no texture,
an SDF network with one hidden layer of two.
"""

from __future__ import annotations

import struct
from collections.abc import Iterator
from typing import Any

import msgpack
import numpy as np
import zstandard

from nispcodec.format.codings import entropy
from tests.conformance.builder import Malformed, Row, change, container
from tests.conformance.malformed_mesh import mesh_malformed

FRAME = [0.0, 0.0, 0.0, 1.0]
META: dict[int, Any] = {1: FRAME, 2: {1: {1: [2]}}, 5: b"\0"}
TENSOR_SIZES = (6, 2, 2, 1)


def meta(changes: dict[int, Any] | None = None) -> bytes:
    """META with some fields changed; None removes a field."""
    fields = {**META, **(changes or {})}
    kept = {key: fields[key] for key in sorted(fields) if fields[key] is not None}
    return bytes(msgpack.packb(kept, use_single_float=True))


def dense(count: int) -> bytes:
    """A dense float16 tensor of zeros."""
    return b"\x01\x02" + bytes(2 * count)


def nets(first: bytes | None = None, rest: bytes = b"") -> bytes:
    """NETS with another first tensor (a weight of 2 rows and 3 columns)."""
    tensors = [dense(count) for count in TENSOR_SIZES]
    return b"".join([tensors[0] if first is None else first, *tensors[1:], rest])


def rows(meta_bytes: bytes | None = None, nets_bytes: bytes | None = None) -> list[Row]:
    """The two sections that every file has."""
    return [
        Row(b"META", meta() if meta_bytes is None else meta_bytes),
        Row(b"NETS", nets() if nets_bytes is None else nets_bytes),
    ]


def squeezed(data: bytes) -> bytes:
    """One zstd frame that states its content size."""
    return zstandard.ZstdCompressor(level=19).compress(data)


def noise() -> bytes:
    """NETS that no packing makes shorter."""
    numbers = np.random.default_rng(0).uniform(-1, 1, sum(TENSOR_SIZES)).astype("<f2")
    ends = np.cumsum(TENSOR_SIZES)[:-1]
    return b"".join(b"\x01\x02" + part.tobytes() for part in np.split(numbers, ends))


def with_dictionary(frame: bytes, number: int) -> bytes:
    """A frame whose header states a dictionary ID, of one byte."""
    assert frame[4] & 3 == 0
    start = 5 if frame[4] >> 5 & 1 else 6
    return frame[:4] + bytes([frame[4] | 1]) + frame[5:start] + bytes([number]) + frame[start:]


def all_malformed() -> Iterator[Malformed]:
    """Every way of failing."""
    yield from _headers()
    yield from _entries()
    yield from _sections()
    yield from _packings()
    yield from _encodings()
    yield from _fields()
    yield from _materials()
    yield from _relations()
    yield from _tensors()
    yield from _sparse()
    yield from _entropy()
    yield from mesh_malformed()


def _headers() -> Iterator[Malformed]:
    good = container(rows())
    yield Malformed("empty", b"", "header", "file_length")
    yield Malformed("header-cut", good[:15], "header", "file_length")
    yield Malformed("table-cut", good[:40], "header", "file_length")
    yield Malformed("payload-cut", good[:-1], "NETS", "stored_length")
    yield Malformed("byte-too-many", good + b"\0", "header", "file_length")
    for name, signature in {
        "signature-other": b"\x89PNG\r\n\x1a\n",
        "signature-seven-bit": b"\x09NSP\r\n\x1a\n",
        "signature-crlf-to-lf": b"\x89NSP\n\x1a\n\x01",
        "signature-lf-to-crlf": b"\x89NSP\r\r\n\x1a",
    }.items():
        yield Malformed(name, container(rows(), signature=signature), "header", "signature")
    for major in (0, 2):
        yield Malformed(f"major-{major}", container(rows(), major=major), "header", "major_version")
    yield Malformed("sections-none", container([]), "header", "section_count")
    many = [*rows(), *(Row(b"X%03d" % i, b"", flags=0) for i in range(63))]
    yield Malformed("sections-many", container(many), "header", "section_count")
    yield Malformed("header-checksum", container(rows(), checksum=1), "header", "checksum")


def _entries() -> Iterator[Malformed]:
    claims: dict[str, tuple[dict[str, Any], str, str]] = {
        "code-lower-case": ({"code": b"nets"}, "header", "section_code"),
        "code-not-ascii": ({"code": b"N\xc9TS"}, "header", "section_code"),
        "code-punctuation": ({"code": b"N_TS"}, "header", "section_code"),
        "flags-unknown": ({"flags": 5}, "NETS", "flags"),
        "flags-ancillary": ({"flags": 0}, "NETS", "flags"),
        "offset-gap": ({"offset": 1000}, "NETS", "offset"),
        "offset-overlap": ({"offset": 16}, "NETS", "offset"),
        "stored-too-long": ({"stored": 2**32 - 1}, "NETS", "stored_length"),
        "stored-too-short": (
            {"stored": 1, "decoded": 1, "checksum": 0xA505DF1B},
            "header",
            "file_length",
        ),
        "decoded-not-stored": ({"decoded": 5}, "NETS", "decoded_length"),
        "payload-checksum": ({"checksum": 5}, "NETS", "checksum"),
    }
    for name, (claim, section, field) in claims.items():
        yield Malformed(name, container(change(rows(), b"NETS", **claim)), section, field)


def _sections() -> Iterator[Malformed]:
    two = rows()
    lower = [*two, Row(b"nets", b"", flags=0)]
    yield Malformed("code-lower-case-ancillary", container(lower), "header", "section_code")
    for code in (b"META", b"TXTR"):
        whole = [*rows(meta({8: [{1: "a"}]})), Row(b"TXTR", b"1234")]
        name = f"{code.decode().lower()}-ancillary"
        yield Malformed(name, container(change(whole, code, flags=0)), code.decode(), "flags")
    start, sizes = 58, [len(row.payload) for row in two]
    turned = change(change(two, b"META", offset=start + sizes[1]), b"NETS", offset=start)
    file = container(turned)[:start] + two[1].payload + two[0].payload
    yield Malformed("payload-order", file, "META", "offset")
    wrong = container(change(two, b"META", checksum=5))
    yield Malformed("meta-checksum", wrong, "META", "checksum")
    unknown = [*two, Row(b"ZZZZ", b"abc", flags=0, checksum=5)]
    yield Malformed("ancillary-checksum", container(unknown), "ZZZZ", "checksum")
    yield Malformed("section-order", container(two[::-1]), "header", "section_order")
    yield Malformed("section-twice", container([*two, two[1]]), "header", "section_order")
    critical = [*two, Row(b"ZZZZ", b"")]
    yield Malformed("critical-unknown", container(critical), "ZZZZ", "section_code")
    yield Malformed("meta-missing", container(two[1:]), "META", "section")
    yield Malformed("nets-missing", container(two[:1]), "NETS", "section")
    yield Malformed("txtr-unasked", container([*two, Row(b"TXTR", b"")]), "TXTR", "section")
    textured = rows(meta({8: [{1: "a", 3: 5}, {1: "b"}]}))
    yield Malformed("txtr-missing", container(textured), "TXTR", "section")
    short = [*textured, Row(b"TXTR", b"1234")]
    yield Malformed("txtr-too-short", container(short), "TXTR", "length")
    none_left = [*textured, Row(b"TXTR", b"12345")]
    yield Malformed("texture-last-empty", container(none_left), "TXTR", "length")


def _packings() -> Iterator[Malformed]:
    content = meta({10: {"note": "again " * 30}})
    packed, noisy = squeezed(content), noise()
    checked = zstandard.ZstdCompressor(write_checksum=True).compress(content)
    unsized = zstandard.ZstdCompressor(write_content_size=False).compress(content)
    cases = {
        "zstd-noise": (b"\xff" * 8, len(content), "payload"),
        "zstd-cut": (packed[:-1], len(content), "payload"),
        "zstd-two-frames": (packed + b"\x50\x2a\x4d\x18\0\0\0\0", len(content), "payload"),
        "zstd-skippable": (b"\x50\x2a\x4d\x18\x04\0\0\0abcd", len(content), "payload"),
        "zstd-dictionary": (with_dictionary(packed, 7), len(content), "payload"),
        "zstd-dictionary-0": (with_dictionary(packed, 0), len(content), "payload"),
        "zstd-checksum": (checked, len(content), "payload"),
        "zstd-no-size": (unsized, len(content), "content_size"),
        "zstd-other-size": (packed, len(content) + 1, "content_size"),
        "zstd-not-smaller": (packed, len(packed), "decoded_length"),
    }
    for name, (payload, decoded, field) in cases.items():
        claim = {"payload": payload, "flags": 3, "decoded": decoded}
        yield Malformed(name, container(change(rows(), b"META", **claim)), "META", field)
    claim = {"payload": squeezed(noisy), "flags": 3, "decoded": len(noisy)}
    longer = container(change(rows(), b"NETS", **claim))
    yield Malformed("zstd-longer", longer, "NETS", "decoded_length")
    size = 2**25 + 1
    bomb = Row(b"TXTR", squeezed(bytes(size)), flags=3, decoded=size)
    file = container([*rows(meta({8: [{1: "a"}]})), bomb])
    yield Malformed("zstd-bomb", file, "header", "decoded_length")


def _encodings() -> Iterator[Malformed]:
    good = meta()
    cases = {
        "msgpack-empty": (b"", "msgpack"),
        "msgpack-cut": (good[:-1], "msgpack"),
        "msgpack-extra": (good + b"\x01", "msgpack"),
        "msgpack-nil": (_instead("material", b"\xc0"), "type"),
        "msgpack-extension": (_instead("material", b"\xd4\x05\x00"), "msgpack"),
        "msgpack-not-utf8": (_instead("text", b"\xa1\xff"), "msgpack"),
        "msgpack-key-order": (b"\x83" + good[23:-4] + good[1:23] + good[-4:], "msgpack"),
        "msgpack-key-twice": (b"\x84" + good[1:23] + good[1:], "msgpack"),
        "msgpack-key-map": (b"\x81\x80\x01", "msgpack"),
        "msgpack-long-integer": (_instead("width", b"\xcc\x02"), "msgpack"),
        "msgpack-long-map": (
            b"\xde\x00" + good[:1].replace(b"\x83", b"\x03") + good[1:],
            "msgpack",
        ),
        "msgpack-long-str": (_instead("text", b"\xd9\x01a"), "msgpack"),
        "msgpack-long-bin": (_instead("flags", b"\xc5\x00\x01\x00"), "msgpack"),
        "msgpack-long-array": (_instead("widths", b"\xdc\x00\x01\x02"), "msgpack"),
        "msgpack-signed-positive": (_instead("width", b"\xd0\x02"), "msgpack"),
        "msgpack-long-negative": (_instead("text", b"\xd1\xff\x80"), "msgpack"),
        "msgpack-wide-float": (_instead("x", b"\xcb" + struct.pack(">d", 0.5)), "msgpack"),
        "msgpack-nan": (_instead("x", b"\xca" + struct.pack(">f", float("nan"))), "number"),
        "msgpack-infinity": (_instead("x", b"\xca" + struct.pack(">f", float("inf"))), "number"),
        "msgpack-deep": (b"\x81\x01" + b"\x91" * 8 + b"\x01", "depth"),
        "msgpack-very-deep": (b"\x91" * 4000, "msgpack"),
        "msgpack-array-bomb": (b"\x81\x01\xdd\xff\xff\xff\xff", "msgpack"),
        "msgpack-long-text": (_instead("text", b"\xda\x04\x01" + b"a" * 1025), "msgpack"),
        "msgpack-not-a-map": (b"\x90", "document"),
    }
    for name, (data, field) in cases.items():
        yield Malformed(name, container(rows(data)), "META", field)
    crowd = msgpack.packb({1: [[1] * 4095 for _ in range(5)]})
    long = bytes(2**18 + 1)
    for name, data, field in (("crowd", crowd, "values"), ("too-long", long, "length")):
        claim = {"payload": squeezed(data), "flags": 3, "decoded": len(data)}
        file = container(change(rows(), b"META", **claim))
        yield Malformed(f"msgpack-{name}", file, "META", field)


def _instead(what: str, encoded: bytes) -> bytes:
    """META of a sound file but for the encoding of one value."""
    sound = meta({10: {"note": 7}, 7: [{1: "b"}]})
    values = {
        "x": b"\xca\0\0\0\0",
        "widths": b"\x91\x02",
        "width": b"\x02",
        "flags": b"\xc4\x01\0",
        "text": b"\x07",
        "material": b"\xa1b",
    }
    before = {"width": b"\x81\x01\x91", "text": b"note"}.get(what, b"")
    assert before + values[what] in sound
    return sound.replace(before + values[what], before + encoded, 1)


_FIELDS: dict[str, tuple[dict[int, Any], str]] = {
    "key-unknown": ({99: 1}, "document.keys"),
    "frame-missing": ({1: None}, "document.frame"),
    "frame-of-three": ({1: FRAME[1:]}, "document.frame"),
    "frame-of-integers": ({1: [0, 0, 0, 1]}, "document.frame"),
    "frame-flat": ({1: [0.0] * 4}, "document.frame"),
    "networks-missing": ({2: None}, "document.keys"),
    "networks-unknown": ({2: {1: {1: [2]}, 4: {1: [2]}}}, "networks.keys"),
    "sdf-missing": ({2: {}}, "networks.sdf"),
    "charts-none": ({3: 0}, "document.charts"),
    "charts-default": ({3: 1}, "document.charts"),
    "charts-many": ({3: 65536}, "document.charts"),
    "chart-materials-length": ({4: b"\0\0"}, "document.chart_materials"),
    "chart-materials-default": ({4: b"\0"}, "document.chart_materials"),
    "chart-has-uv-length": ({5: b"\0\0"}, "document.chart_has_uv"),
    "chart-has-uv-tail": ({5: b"\x01"}, "document.chart_has_uv"),
    "chart-has-uv-default": ({5: b"\x80"}, "document.chart_has_uv"),
    "uv-map-default": ({6: [0.0, 0.0, 1.0, 1.0]}, "document.uv_map"),
    "half-thickness-integer": ({9: 1}, "document.half_thickness"),
    "half-thickness-negative-zero": ({9: -0.0}, "document.half_thickness"),
    "uv-map-negative-zero": ({6: [-0.0, 0.0, 1.0, 1.0]}, "document.uv_map"),
    "openings-default": ({11: False}, "document.openings"),
    "openings-alone": ({11: True}, "document.openings"),
    "info-empty": ({10: {}}, "document.info"),
    "info-list": ({10: [1]}, "document.info"),
    "info-key-reserved": ({10: {0: 1}}, "document.info.0"),
    "info-key-unknown": ({10: {31: 1}}, "document.info.31"),
    "info-key-by-name": ({10: {"seed": 1}}, "document.info.seed"),
    "info-key-bool": ({10: {True: 1}}, "document.info.True"),
    "info-value": ({10: {1: [1]}}, "document.info.preset"),
    "info-seed-float": ({10: {2: 1.5}}, "document.info.seed"),
    "info-measure-text": ({10: {5: "small"}}, "document.info.distance_error"),
    "info-measure-bool": ({10: {6: True}}, "document.info.chart_accuracy"),
    "info-text-control": ({10: {"tool": "a\nb"}}, "document.info.tool"),
    "info-key-control": ({10: {"a\x00b": 1}}, "document.info"),
    "preset-control": ({10: {1: "a\x7fb"}}, "document.info.preset"),
    "preset-reserved": ({10: {1: 0}}, "document.info.preset"),
    "preset-unknown": ({10: {1: 5}}, "document.info.preset"),
    "preset-by-name": ({10: {1: "paper"}}, "document.info.preset"),
}
_SPECS: dict[str, tuple[dict[int, Any], str]] = {
    "hidden-missing": ({}, "hidden"),
    "hidden-empty": ({1: []}, "hidden"),
    "hidden-deep": ({1: [1] * 33}, "hidden"),
    "hidden-zero": ({1: [0]}, "hidden"),
    "hidden-wide": ({1: [1025]}, "hidden"),
    "hidden-text": ({1: ["a"]}, "hidden"),
    "encoding-reserved": ({1: [2], 2: 0}, "encoding"),
    "encoding-unknown": ({1: [2], 2: 3}, "encoding"),
    "encoding-default": ({1: [2], 2: 1}, "encoding"),
    "levels-none": ({1: [2], 2: 2}, "levels"),
    "levels-many": ({1: [2], 2: 2, 3: 17}, "levels"),
    "levels-alone": ({1: [2], 3: 2}, "levels"),
    "sdf-conditioned": ({1: [2], 4: 2}, "conditioning"),
    "embedding-alone": ({1: [2], 5: 4}, "embedding"),
    "activation-unknown": ({1: [2], 6: 3}, "activation"),
    "w0-zero": ({1: [2], 7: 0.0}, "w0"),
    "w0-large": ({1: [2], 7: 1001.0}, "w0"),
    "output-unknown": ({1: [2], 8: 4}, "output"),
    "mirror-default": ({1: [2], 9: 0}, "mirror"),
    "mirror-side-alone": ({1: [2], 9: 8}, "mirror"),
    "mirror-bit-unknown": ({1: [2], 9: 64}, "mirror"),
    "mirror-negative": ({1: [2], 9: -1}, "mirror"),
    "mirror-flag": ({1: [2], 9: True}, "mirror"),
    "init-seed-default": ({1: [2], 10: 0}, "init_seed"),
    "init-seed-negative": ({1: [2], 10: -1}, "init_seed"),
    "init-seed-large": ({1: [2], 10: 2**32}, "init_seed"),
    "spec-key-unknown": ({1: [2], 11: 1}, "keys"),
}


def _fields() -> Iterator[Malformed]:
    cases = dict(_FIELDS)
    for name, (fields, field) in _SPECS.items():
        cases[name] = ({2: {1: fields}}, f"networks.sdf.{field}")
    wider = {"mirror-side-alone": 8, "sdf-conditioned": 8, "embedding-alone": 14}
    for name, (changes, field) in cases.items():
        data = nets(dense(wider.get(name, 6)))
        yield Malformed(name, container(rows(meta(changes), data)), "META", field)


def _materials() -> Iterator[Malformed]:
    cases: dict[str, tuple[dict[int, Any], str]] = {
        "name-control": ({1: "a\nb"}, "name"),
        "name-delete": ({1: "a\x7f"}, "name"),
        "roughness-default": ({4: 1.0}, "roughness"),
        "metallic-negative-zero": ({3: -0.0}, "metallic"),
        "base-color-of-three": ({2: [0.5, 0.5, 0.5]}, "base_color"),
        "alpha-mode-unknown": ({6: 4}, "alpha_mode"),
        "double-sided-number": ({8: 1}, "double_sided"),
        "slot-unknown": ({9: {6: {}}}, "maps.keys"),
        "wrap-unknown": ({9: {1: {2: 4}}}, "maps.base_color.wrap_u"),
        "filter-unknown": ({9: {1: {4: 3}}}, "maps.base_color.filter"),
        "map-key-unknown": ({9: {1: {6: 1}}}, "maps.base_color.keys"),
        "material-key-unknown": ({10: 1}, "keys"),
    }
    for name, (fields, field) in cases.items():
        yield Malformed(name, container(rows(meta({7: [fields]}))), "META", f"materials.0.{field}")
    last = {1: "z"}
    textures: dict[str, tuple[list[dict[int, Any]], str]] = {
        "texture-nameless": ([{3: 1}, last], "name"),
        "texture-name-empty": ([{1: ""}], "name"),
        "texture-path": ([{1: "../a.png"}], "name"),
        "texture-path-slash": ([{1: "a/b"}], "name"),
        "texture-path-backslash": ([{1: "a\\b"}], "name"),
        "texture-path-drive": ([{1: "c:b"}], "name"),
        "texture-path-dot": ([{1: "."}], "name"),
        "texture-path-dots": ([{1: ".."}], "name"),
        "texture-name-delete": ([{1: "a\x7f"}], "name"),
        "texture-length-zero": ([{1: "a", 3: 0}, last], "length"),
        "texture-default-ending": ([{1: "a.png"}], "name"),
        "texture-mime-unknown": ([{1: "a", 2: 5}], "mime"),
        "texture-length-missing": ([{1: "a"}, last], "length"),
        "texture-length-negative": ([{1: "a", 3: -1}, last], "length"),
        "texture-length-of-last": ([{1: "a", 3: 1}], "keys"),
        "texture-key-unknown": ([{1: "a", 4: 1}], "keys"),
    }
    for name, (listed, field) in textures.items():
        file = container([*rows(meta({8: listed})), Row(b"TXTR", b"12")])
        yield Malformed(name, file, "META", f"textures.0.{field}")


def _relations() -> Iterator[Malformed]:
    spec = {1: [2]}
    many = b"".join(dense(count) for _ in range(2) for count in TENSOR_SIZES)
    cases: dict[str, tuple[dict[int, Any], bytes, str]] = {
        "materials-none": ({7: []}, nets(), "document.materials"),
        "chart-material-unknown": ({4: b"\x01"}, nets(), "document.chart_materials"),
        "map-texture-unknown": ({7: [{9: {1: {}}}]}, nets(), "materials.0.maps.base_color.texture"),
        "chart-network-missing": ({3: 2, 5: b"\0"}, nets(), "networks.chart"),
        "chart-network-unasked": ({2: {1: spec, 2: spec}}, many, "networks.chart"),
        "openings-with-uv": (
            {3: 2, 5: None, 11: True, 2: {1: spec, 2: spec, 3: spec}},
            b"".join(dense(n) for n in (*TENSOR_SIZES, 6, 2, 4, 2, 6, 2, 4, 2)),
            "document.openings",
        ),
        "uv-network-missing": ({5: None}, nets(), "networks.uv"),
    }
    for name, (changes, data, field) in cases.items():
        yield Malformed(name, container(rows(meta(changes), data)), "META", field)


def _tensors() -> Iterator[Malformed]:
    infinite = b"\x01\x02" + struct.pack("<6e", *[float("inf")] * 6)
    large = b"\x19\0\0\0\x3f\x05" + struct.pack("<6i", *[-(2**31)] * 6)
    overflow = b"\x19" + struct.pack("<f", 3e38) + b"\x03" + b"\x7f" * 6
    cases = {
        "coding-reserved": (b"\x08" + dense(6)[1:], "coding"),
        "wide-tag-cut": (b"\0", "coding"),
        "wide-tag-reserved": (b"\0\0\0\x04", "coding"),
        "wide-tag-short-enough": (b"\0\x01\0\0" + dense(6)[1:], "coding"),
        "wide-tag-coding-unknown": (b"\0\x08\0\0", "coding"),
        "wide-tag-step-unknown": (b"\0\x01\x08\0\0\x03" + bytes(6), "step"),
        "wide-tag-joined-dense": (b"\0\x01\0\x04", "joined"),
        "wide-tag-joined-many": (b"\0\x06\0\x04", "joined"),
        "delta-init-without-step": (b"\x07\0" + dense(6)[1:], "step"),
        "joined-dense": (b"\x41" + dense(6)[1:], "joined"),
        "number-kind-reserved": (b"\x01\0" + bytes(12), "number_kind"),
        "number-kind-of-symbols": (b"\x01\x03" + bytes(6), "number_kind"),
        "number-kind-of-floats": (b"\x19\0\0\0\x3f\x02" + bytes(12), "number_kind"),
        "step-zero": (b"\x19\0\0\0\0\x03" + bytes(6), "step"),
        "step-negative": (b"\x19" + struct.pack("<f", -1) + b"\x03" + bytes(6), "step"),
        "step-nan": (b"\x11" + struct.pack("<e", float("nan")) + b"\x03" + bytes(6), "step"),
        "row-shifts-tail": (b"\x29\0\x03" + bytes(6), "row_shifts"),
        "step-same-as-none": (b"\x21\x03" + bytes(6), "step"),
    }
    for name, (tensor, field) in cases.items():
        file = container(rows(None, nets(tensor)))
        yield Malformed(name, file, "NETS", f"sdf.weight.0.{field}")
    for name, tensor in {
        "weights-infinite": infinite,
        "weights-overflow": overflow,
        "symbol-large": large,
    }.items():
        yield Malformed(name, container(rows(None, nets(tensor))), "NETS", "sdf.weight.0")
    same = b"\x21\x03"
    between = b"\x09\xd0\x03" + bytes(6) + dense(2) + same + bytes(2) + dense(1)
    after = container(rows(None, between))
    yield Malformed("step-same-after-none", after, "NETS", "sdf.weight.1.step")
    both = meta({2: {1: {1: [2]}, 2: {1: [2]}}, 3: 2, 5: b"\0"})
    stepped = nets()[: -len(dense(1))] + b"\x09\xd0\x03\0"
    chart = same + bytes(6) + dense(2) + dense(4) + dense(2)
    across = container(rows(both, stepped + chart))
    yield Malformed("step-same-of-another-network", across, "NETS", "chart.weight.0.step")
    yield Malformed("nets-cut", container(rows(None, nets()[:-1])), "NETS", "sdf.bias.1.values")
    yield Malformed("nets-extra", container(rows(None, nets(rest=b"\0"))), "NETS", "end")
    wide = meta({2: {1: {1: [1024, 1024]}}})
    yield Malformed("weights-many", container(rows(wide)), "NETS", "weights")


def _sparse() -> Iterator[Malformed]:
    one = b"\x02\0\x3c"
    cases = {
        "coo-count": (b"\x02\x07", "count"),
        "coo-count-long": (b"\x02\x80\0\x02", "count"),
        "coo-count-endless": (b"\x02" + b"\x80" * 6, "count"),
        "coo-row": (b"\x02\x02\x01\x01\0\0" + one + b"\0\x3c", "row"),
        "coo-row-step": (b"\x02\x01\x02\0" + one, "row_step"),
        "coo-column": (b"\x02\x02\0\0\x02\0" + one + b"\0\x3c", "column"),
        "coo-column-gap": (b"\x02\x01\0\x03" + one, "column_gap"),
        "csr-row-count": (b"\x04\x04\0", "row_count"),
        "csr-column": (b"\x04\x02\0\x02\0" + one + b"\0\x3c", "column"),
        "csc-column": (b"\x03\x02\0\0\x01\x01" + one + b"\0\x3c", "column"),
        "dia-count": (b"\x05\x05", "diagonal_count"),
        "dia-gap": (b"\x05\x01\x04", "diagonal_gap"),
        "dia-diagonal": (b"\x05\x02\x03\0", "diagonal"),
    }
    for name, (tensor, field) in cases.items():
        file = container(rows(None, nets(tensor)))
        yield Malformed(name, file, "NETS", f"sdf.weight.0.{field}")


def _entropy() -> Iterator[Malformed]:
    """The first tensor symbols in the coding entropy, with a good header and stream to break."""
    small = entropy.SymbolRun(np.array([1, 0, 0, -1, 0, 1], np.int32))
    large = entropy.SymbolRun(np.array([516, 0, 3, -9, 0, 1], np.int32))
    header, stream = small.header(), entropy.encode([small])
    wide, wide_stream = large.header(), entropy.encode([large])
    yield from _heads()
    cases = {
        "stream-missing": (header, b"", "words"),
        "stream-half-a-state": (header, stream[:2], "words"),
        "stream-cut": (wide, wide_stream[:4], "words"),
        "stream-final-state": (header, b"\0\x40" + stream[2:], "final_state"),
        "stream-too-long": (header, stream + b"\0\0", "end"),
        "stream-odd": (header, stream + b"\0", "end"),
        "open-bits-cut": (wide, wide_stream[:-1], "open_bits"),
        "magnitude-above-limit": (b"\x81\x04" + wide[2:], wide_stream, "magnitude"),
    }
    for name, (start, end, field) in cases.items():
        first = b"\x1e" + struct.pack("<f", 0.5) + start
        yield Malformed(name, container(rows(None, nets(first, end))), "NETS", field)
    three = entropy.SymbolRun(np.array([300, 300, 300, 0, 0, 0], np.int32))
    tail = entropy.encode([three])
    first = b"\x1e" + struct.pack("<f", 0.5) + three.header()
    tail = tail[:-1] + bytes([tail[-1] | 1])
    yield Malformed("open-bits-tail", container(rows(None, nets(first, tail))), "NETS", "open_bits")


def _heads() -> Iterator[Malformed]:
    step = struct.pack("<f", 0.5)
    cases = {
        "top-kind": (b"\x06\x03", "number_kind"),
        "top-large": (b"\x06\x02\x80\xf8\x01\0", "top"),
        "limit-above-top": (b"\x06\x02\x05\x06", "limit"),
        "limit-large": (b"\x1e" + step + b"\x80\x80\x80\x04", "limit"),
        "zeros-none": (b"\x1e" + step + b"\x01\x80\0", "zeros"),
    }
    for name, (tensor, field) in cases.items():
        file = container(rows(None, nets(tensor)))
        yield Malformed(name, file, "NETS", f"sdf.weight.0.{field}")
    last = [dense(count) for count in TENSOR_SIZES[:-1]]
    file = container(rows(None, b"".join([*last, b"\x3e\0"])))
    yield Malformed("row-shifts-cut", file, "NETS", "sdf.bias.1.row_shifts")
    scales = {"delta-init-scale-large": b"\x80\x80\x80\x04", "delta-init-scale-cut": b""}
    for name, scale in scales.items():
        file = container(rows(None, b"".join([*last, b"\x1f" + step + scale])))
        yield Malformed(name, file, "NETS", "sdf.bias.1.init_scale")
    # All move as far as symbols go, and where initial weights begin that is further.
    far = entropy.SymbolRun(np.full(6, 2**23 - 1, np.int32))
    first = b"\x1f" + step + b"\x64" + far.header()
    file = container(rows(None, nets(first, entropy.encode([far]))))
    yield Malformed("delta-init-symbol-large", file, "NETS", "sdf.weight.0")
    yield _low_state()
    joined = b"".join(dense(count) for count in TENSOR_SIZES[:-1]) + b"\x5e" + step + b"\0"
    yield Malformed("joined-many", container(rows(None, joined)), "NETS", "sdf.bias.1.joined")


def _low_state() -> Malformed:
    """A stream of one token that ends as it should, from a state that no encoder ends with."""
    one = entropy.SymbolRun(np.array([1], np.int32))
    starts, _ = one.tokens()
    stream = struct.pack("<3H", 0, starts[0] + 1, 0)
    last = [dense(count) for count in TENSOR_SIZES[:-1]]
    record = b"\x1e" + struct.pack("<f", 0.5) + one.header()
    file = container(rows(None, b"".join([*last, record, stream])))
    return Malformed("stream-first-state", file, "NETS", "first_state")
