/** How fine to draw while things move, so that a slow machine keeps up. Still pictures are always fine. */

const slowMs = 42;
const fastMs = 19;
const least = 0.35;
const patience = 3;

export class Quality {
  /** share of the screen's pixels in each direction, least to 1 */
  share = 1;
  private slow = 0;
  private fast = 0;

  /** Tells how long after the last picture this one came, while both were part of one motion. */
  note(interval: number): void {
    this.slow = interval > slowMs ? this.slow + 1 : 0;
    this.fast = interval < fastMs ? this.fast + 1 : 0;
    if (this.slow >= patience) this.set(this.share * Math.max(0.6, Math.sqrt(slowMs / interval)));
    else if (this.fast >= 20 * patience) this.set(this.share * 1.25);
  }

  private set(share: number): void {
    this.share = Math.max(least, Math.min(1, share));
    this.slow = this.fast = 0;
  }
}
