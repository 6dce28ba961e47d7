/** Reads numbers from bytes, front to back. Reading past the end is an error that names the offset. */

/** An error in a recording, with a message for the user. */
export class RecordingError extends Error {
  override name = "RecordingError";
}

const utf8 = new TextDecoder("utf-8");

/** A cursor over bytes. `what` names the bytes in errors; `offset` is that of the next byte. */
export class Reader {
  offset = 0;
  private readonly view: DataView;

  constructor(
    readonly bytes: Uint8Array,
    readonly what: string,
  ) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  get left(): number {
    return this.bytes.length - this.offset;
  }

  fail(problem: string): never {
    throw new RecordingError(`${this.what}, byte ${this.offset}: ${problem}`);
  }

  /** Skips `count` bytes and returns the offset of the first. */
  advance(count: number): number {
    const start = this.offset;
    if (!(count <= this.left)) this.fail(`found ${this.left} bytes; expected ${count}`);
    this.offset = start + count;
    return start;
  }

  u8(): number {
    return this.bytes[this.advance(1)];
  }
  u16(): number {
    return this.view.getUint16(this.advance(2), true);
  }
  u32(): number {
    return this.view.getUint32(this.advance(4), true);
  }
  u64(): bigint {
    return this.view.getBigUint64(this.advance(8), true);
  }
  /** Reads a u64 that a double represents exactly. */
  count64(): number {
    const value = this.u64();
    if (value > BigInt(Number.MAX_SAFE_INTEGER)) this.fail(`found ${value}; expected below 2^53`);
    return Number(value);
  }
  f32(): number {
    return this.view.getFloat32(this.advance(4), true);
  }
  f64(): number {
    return this.view.getFloat64(this.advance(8), true);
  }
  /** Reads a size: an f32 that is finite and above 0. */
  size(): number {
    const value = this.f32();
    if (!(value > 0 && value < Infinity)) this.fail(`found size ${value}; expected a number above 0`);
    return value;
  }

  varuint(): number {
    const { bytes } = this;
    let at = this.offset;
    const first = bytes[at];
    if (first < 128) {
      this.offset = at + 1;
      return first;
    }
    let value = 0;
    let scale = 1;
    for (let i = 0; i < 10; ++i) {
      if (at >= bytes.length) this.fail("found the end inside a number");
      const byte = bytes[at++];
      value += (byte & 127) * scale;
      if (byte < 128) {
        if (value > Number.MAX_SAFE_INTEGER) this.fail("found a number of 2^53 or more");
        this.offset = at;
        return value;
      }
      scale *= 128;
    }
    return this.fail("found a number of more than 10 bytes");
  }
  varint(): number {
    const u = this.varuint();
    return u % 2 === 0 ? u / 2 : -(u + 1) / 2;
  }
  /** Reads the length of a list whose elements take at least `bytesEach` bytes each. */
  count(bytesEach: number): number {
    const count = this.varuint();
    if (count * bytesEach > this.left) this.fail(`found a list of ${count}, but only ${this.left} bytes follow`);
    return count;
  }
  text(): string {
    const length = this.count(1);
    const at = this.advance(length);
    return utf8.decode(this.bytes.subarray(at, at + length));
  }
  vec3(): [number, number, number] {
    return [this.f32(), this.f32(), this.f32()];
  }
  floats(count: number): Float32Array {
    const at = this.advance(4 * count);
    const out = new Float32Array(count);
    for (let i = 0; i < count; ++i) out[i] = this.view.getFloat32(at + 4 * i, true);
    return out;
  }
  words(count: number): Uint32Array {
    const at = this.advance(4 * count);
    const out = new Uint32Array(count);
    for (let i = 0; i < count; ++i) out[i] = this.view.getUint32(at + 4 * i, true);
    return out;
  }
  octets(count: number): Uint8Array {
    const at = this.advance(count);
    return this.bytes.subarray(at, at + count);
  }
  /** Reads `count` 16-bit numbers, stored as all low bytes, then all high bytes. */
  planes16(count: number): Uint16Array {
    const at = this.advance(2 * count);
    const { bytes } = this;
    const out = new Uint16Array(count);
    for (let i = 0; i < count; ++i) out[i] = bytes[at + i] | (bytes[at + count + i] << 8);
    return out;
  }
  /** Reads signed numbers, each stored as the difference to the previous one. */
  running(count: number): Float64Array {
    const out = new Float64Array(count);
    for (let i = 0, sum = 0; i < count; ++i) out[i] = sum += this.varint();
    return out;
  }
  /** Reads strictly ascending row numbers, all below `below`. */
  rows(count: number, below: number): Uint32Array {
    const out = new Uint32Array(count);
    for (let i = 0, row = -1; i < count; ++i) {
      row += this.varuint() + 1;
      if (row >= below) this.fail(`found row ${row}; expected below ${below}`);
      out[i] = row;
    }
    return out;
  }
}
