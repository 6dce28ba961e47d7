/** CRC-32 as in zip, PNG and Ethernet, eight bytes at a time. Source: Kounavis and Berry 2005, "slicing-by-8". */

const tables = Array.from({ length: 8 }, () => new Uint32Array(256));
for (let n = 0; n < 256; ++n) {
  let c = n;
  for (let bit = 0; bit < 8; ++bit) c = c & 1 ? (c >>> 1) ^ 0xedb88320 : c >>> 1;
  tables[0][n] = c;
}
for (let n = 0; n < 256; ++n)
  for (let k = 1; k < 8; ++k) tables[k][n] = (tables[k - 1][n] >>> 8) ^ tables[0][tables[k - 1][n] & 255];

/** Returns the checksum of bytes [from, to). */
export function crc32(bytes: Uint8Array, from = 0, to = bytes.length): number {
  const [t0, t1, t2, t3, t4, t5, t6, t7] = tables;
  let c = 0xffffffff;
  let i = from;
  for (; i + 8 <= to; i += 8) {
    c ^= bytes[i] | (bytes[i + 1] << 8) | (bytes[i + 2] << 16) | (bytes[i + 3] << 24);
    c =
      t7[c & 255] ^
      t6[(c >>> 8) & 255] ^
      t5[(c >>> 16) & 255] ^
      t4[c >>> 24] ^
      t3[bytes[i + 4]] ^
      t2[bytes[i + 5]] ^
      t1[bytes[i + 6]] ^
      t0[bytes[i + 7]];
  }
  for (; i < to; ++i) c = (c >>> 8) ^ t0[(c ^ bytes[i]) & 255];
  return (c ^ 0xffffffff) >>> 0;
}
