/** Chooses the resolution while the picture moves, so that slow machines keep up. Still pictures have full resolution. */

const slowMs = 42;
const fastMs = 19;
const minShare = 0.35;
const minStreak = 3; // pictures

export class Quality {
  /** share of the screen's pixels in each direction, minShare to 1 */
  share = 1;
  private slow = 0;
  private fast = 0;

  /** Records the milliseconds between two pictures of one motion. */
  record(interval: number): void {
    this.slow = interval > slowMs ? this.slow + 1 : 0;
    this.fast = interval < fastMs ? this.fast + 1 : 0;
    if (this.slow >= minStreak) this.set(this.share * Math.max(0.6, Math.sqrt(slowMs / interval)));
    else if (this.fast >= 20 * minStreak) this.set(this.share * 1.25);
  }

  private set(share: number): void {
    this.share = Math.max(minShare, Math.min(1, share));
    this.slow = this.fast = 0;
  }
}
