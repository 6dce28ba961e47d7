/** Tests of numbers, checksums and packing. */
import assert from "node:assert/strict";
import { test } from "node:test";
import { Reader } from "../../src/format/bytes";
import { crc32 } from "../../src/format/crc32";
import { unpack } from "../../src/format/unpack";
import { Writer, zstdRaw } from "../encode";

const packed = (method: number, rawLength: number, bytes: Uint8Array): Uint8Array => {
  const out = new Writer();
  out.u8(method);
  out.bytes(new Uint8Array(3));
  out.u32(rawLength);
  out.bytes(bytes);
  return out.done();
};
const fromBase64 = (text: string) => new Uint8Array(Buffer.from(text, "base64"));

/** The same words 200 times, packed by the zstd command: level 19 without checksum, level 3 with checksum. */
const words = "fase fase fase fase, broad phase and narrow phase, ".repeat(200);
const zstdFrames = [
  "KLUv/QBoXQEA8gEHDNA9qCRDnqIceBHhLYa9zJvF7tEXWn4ZBo+eAgMAoscqjqGJDcjlDQ==",
  "KLUv/QRYhQEA8GZhc2UgLCBicm9hZCBwaGFzZSBhbmQgbmFycm93LAUAj8cqDjIFiKpfaA4DcnkDzzYIzw==",
];

test("crc32 equals the bitwise definition for every length and offset", () => {
  assert.equal(crc32(new TextEncoder().encode("123456789")), 0xcbf43926);
  const bytes = Uint8Array.from({ length: 100 }, (_, i) => (i * 37) & 255);
  for (let from = 0; from < 20; ++from)
    for (let to = from; to < 100; to += 7) {
      let c = 0xffffffff;
      for (let i = from; i < to; ++i) {
        c ^= bytes[i];
        for (let bit = 0; bit < 8; ++bit) c = c & 1 ? (c >>> 1) ^ 0xedb88320 : c >>> 1;
      }
      assert.equal(crc32(bytes, from, to), (c ^ 0xffffffff) >>> 0);
    }
});

test("varuints and varints round-trip up to 2^53 - 1", () => {
  const numbers = [0, 1, 127, 128, 16383, 16384, 2 ** 31, 2 ** 32 + 5, 2 ** 52, Number.MAX_SAFE_INTEGER];
  const out = new Writer();
  for (const n of numbers) out.varuint(n);
  for (const n of numbers.slice(0, -2)) {
    out.varint(n);
    out.varint(-n);
  }
  const read = new Reader(out.done(), "test");
  for (const n of numbers) assert.equal(read.varuint(), n);
  for (const n of numbers.slice(0, -2)) {
    assert.equal(read.varint(), n);
    assert.equal(read.varint(), n === 0 ? 0 : -n);
  }
  assert.equal(read.left, 0);
});

test("an unterminated, too large or truncated varuint is refused", () => {
  for (const bytes of [
    new Uint8Array(11).fill(255),
    new Uint8Array(10).fill(0xff).fill(0x7f, 9),
    new Uint8Array([0x80]),
    new Uint8Array(0),
  ])
    assert.throws(() => new Reader(bytes, "test").varuint(), /test, byte \d+/);
});

test("rows are ascending and below their limit", () => {
  const out = new Writer();
  out.rows([3, 4, 9]);
  assert.deepEqual([...out.done()], [3, 0, 4]);
  assert.deepEqual([...new Reader(out.done(), "test").rows(3, 10)], [3, 4, 9]);
  assert.throws(() => new Reader(out.done(), "test").rows(3, 9), /row 9; expected below 9/);
});

test("byte planes round-trip", () => {
  const out = new Writer();
  out.planes16([0, 1, 256, 65535, 4660]);
  assert.deepEqual([...new Reader(out.done(), "test").planes16(5)], [0, 1, 256, 65535, 4660]);
});

test("reading past the end names the offset", () => {
  const read = new Reader(new Uint8Array(10), "here");
  read.u64();
  assert.throws(() => read.u32(), /here, byte 8: found 2 bytes; expected 4/);
});

test("chunk bodies packed by the zstd command unpack to the same bytes", () => {
  for (const frame of zstdFrames) {
    const raw = unpack(packed(1, words.length, fromBase64(frame)), "test");
    assert.equal(new TextDecoder().decode(raw), words);
  }
});

test("a long frame unpacks in slices, and partially when its beginning is enough", () => {
  const raw = Uint8Array.from({ length: 500_000 }, (_, i) => (i * i) & 255);
  const body = packed(1, raw.length, zstdRaw(raw).packed);
  assert.deepEqual(unpack(body, "test"), raw);
  const start = unpack(body, "test", 12);
  assert.ok(start.length >= 12 && start.length < raw.length);
  assert.deepEqual(start, raw.subarray(0, start.length));
});

test("broken, oversized and unknown packings are refused with a reason", () => {
  const frame = fromBase64(zstdFrames[0]);
  const cases: [Uint8Array, RegExp][] = [
    [packed(2, 5, new Uint8Array(5)), /method 2/],
    [packed(0, 6, new Uint8Array(5)), /found 5 bytes; expected 6/],
    [packed(1, 2 ** 31, frame), /expands to 2147483648 bytes, limit/],
    [packed(1, words.length + 1, frame), /zstd frame; expected/],
    [packed(1, words.length, frame.subarray(0, frame.length - 4)), /broken|found/],
    [packed(1, 10, new Uint8Array(10)), /no zstd frame/],
    [new Uint8Array(5), /expected at least 8/],
    // a window of 2 GiB in the header must not be allocated
    [packed(1, 4, Uint8Array.of(0x28, 0xb5, 0x2f, 0xfd, 0, 21 << 3, 1, 0, 0)), /window/],
  ];
  for (const [body, reason] of cases) assert.throws(() => unpack(body, "test"), reason);
});
