/** Reads numbers from bytes, front to back; whatever runs past the end is an error with its place. */

/** What is wrong with a recording, in words for the person who opened it. */
export class RecordingError extends Error {
  override name = "RecordingError";
}

const utf8 = new TextDecoder("utf-8");

/** A cursor over bytes. `what` names the bytes in errors; `at` is the offset of the next byte. */
export class Reader {
  at = 0;
  private readonly view: DataView;

  constructor(
    readonly bytes: Uint8Array,
    readonly what: string,
  ) {
    this.view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  }

  get left(): number {
    return this.bytes.length - this.at;
  }

  fail(problem: string): never {
    throw new RecordingError(`${this.what}, byte ${this.at}: ${problem}`);
  }

  /** Moves over `count` bytes and returns where they began. */
  take(count: number): number {
    const at = this.at;
    if (!(count <= this.left)) this.fail(`found ${this.left} bytes, need ${count}`);
    this.at = at + count;
    return at;
  }

  u8(): number {
    return this.bytes[this.take(1)];
  }
  u16(): number {
    return this.view.getUint16(this.take(2), true);
  }
  u32(): number {
    return this.view.getUint32(this.take(4), true);
  }
  u64(): bigint {
    return this.view.getBigUint64(this.take(8), true);
  }
  /** A u64 that must be exact as a double. */
  count64(): number {
    const value = this.u64();
    if (value > BigInt(Number.MAX_SAFE_INTEGER)) this.fail(`found ${value}, need below 2^53`);
    return Number(value);
  }
  f32(): number {
    return this.view.getFloat32(this.take(4), true);
  }
  f64(): number {
    return this.view.getFloat64(this.take(8), true);
  }
  /** An f32 that must be finite and above 0: a size. */
  size(): number {
    const value = this.f32();
    if (!(value > 0 && value < Infinity)) this.fail(`found size ${value}, need a number above 0`);
    return value;
  }

  varuint(): number {
    const { bytes } = this;
    let at = this.at;
    const first = bytes[at];
    if (first < 128) {
      this.at = at + 1;
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
        this.at = at;
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
  /** A varuint that counts things of at least `bytesEach` bytes that follow. */
  count(bytesEach: number): number {
    const count = this.varuint();
    if (count * bytesEach > this.left) this.fail(`found a list of ${count}, but only ${this.left} bytes follow`);
    return count;
  }
  text(): string {
    const length = this.count(1);
    const at = this.take(length);
    return utf8.decode(this.bytes.subarray(at, at + length));
  }
  vec3(): [number, number, number] {
    return [this.f32(), this.f32(), this.f32()];
  }
  floats(count: number): Float32Array {
    const at = this.take(4 * count);
    const out = new Float32Array(count);
    for (let i = 0; i < count; ++i) out[i] = this.view.getFloat32(at + 4 * i, true);
    return out;
  }
  words(count: number): Uint32Array {
    const at = this.take(4 * count);
    const out = new Uint32Array(count);
    for (let i = 0; i < count; ++i) out[i] = this.view.getUint32(at + 4 * i, true);
    return out;
  }
  octets(count: number): Uint8Array {
    const at = this.take(count);
    return this.bytes.subarray(at, at + count);
  }
  /** `count` 16-bit numbers, stored as all low bytes, then all high bytes. */
  planes16(count: number): Uint16Array {
    const at = this.take(2 * count);
    const { bytes } = this;
    const out = new Uint16Array(count);
    for (let i = 0; i < count; ++i) out[i] = bytes[at + i] | (bytes[at + count + i] << 8);
    return out;
  }
  /** Signed numbers, each the difference to the one before. */
  running(count: number): Float64Array {
    const out = new Float64Array(count);
    for (let i = 0, sum = 0; i < count; ++i) out[i] = sum += this.varint();
    return out;
  }
  /** Strictly rising row numbers, all below `below`. */
  rows(count: number, below: number): Uint32Array {
    const out = new Uint32Array(count);
    for (let i = 0, row = -1; i < count; ++i) {
      row += this.varuint() + 1;
      if (row >= below) this.fail(`found row ${row}, need below ${below}`);
      out[i] = row;
    }
    return out;
  }
}
