/** The current time in the recording: play, pause, seek. Independent of drawing. */

export const speeds = [0.1, 0.25, 0.5, 1, 2, 4] as const;

export class Playback {
  playing = false;
  speed = 1;
  /** current frame, with a fraction */
  private at = 0;

  /** `secondsPerFrame`: mean time between frames, above 0. */
  constructor(
    readonly frameCount: number,
    readonly secondsPerFrame: number,
    private readonly onChange: () => void,
  ) {}

  get frame(): number {
    return Math.floor(this.at);
  }
  /** fraction of the way from this frame to the next, 0 to below 1 */
  get share(): number {
    return this.at - this.frame;
  }
  get last(): number {
    return this.frameCount - 1;
  }

  /** Goes to a frame, clamped to the recording. */
  seek(frame: number): void {
    this.at = Math.max(0, Math.min(this.last, Math.round(frame)));
    this.onChange();
  }
  /** Pauses and moves by a number of frames. */
  step(frames: number): void {
    this.playing = false;
    this.seek(frames > 0 ? this.frame + frames : Math.ceil(this.at) + frames);
  }
  toggle(): void {
    this.playing = !this.playing && this.last > 0;
    if (this.playing && this.frame >= this.last) this.at = 0;
    if (!this.playing) this.at = this.frame;
    this.onChange();
  }
  setSpeed(speed: number): void {
    this.speed = speed;
    this.onChange();
  }
  faster(steps: number): void {
    const now = speeds.findIndex((speed) => speed >= this.speed);
    this.setSpeed(speeds[Math.max(0, Math.min(speeds.length - 1, now + steps))]);
  }

  /** Advances by `seconds` of real time; limits long gaps (a sleeping tab) to 0.1 s. */
  advance(seconds: number): void {
    if (!this.playing) return;
    this.at += (Math.min(seconds, 0.1) * this.speed) / this.secondsPerFrame;
    if (this.at >= this.last) {
      this.at = this.last;
      this.playing = false;
    }
    this.onChange();
  }
}
