/** Chooses what moving pictures leave out, so that slow machines keep up. Still pictures leave out nothing. */

/** What a picture leaves out. */
export interface Saving {
  /** share of the screen's pixels in each direction, above 0 to 1 */
  share: number;
  shadows: boolean;
  /** 0: shapes as fine as this machine draws them; each further step is coarser */
  coarser: number;
}
export const savesNothing: Saving = { share: 1, shadows: true, coarser: 0 };

const slowMs = 42;
const fastMs = 19;
/** above this, fewer pixels alone are not enough: 5 pictures per second, with a margin */
const tooSlowMs = 140;
const minShare = 0.3;
/** the same when nothing else is left to save */
const leastShare = 0.2;
const minPictures = 3;
const windowMs = 250;
const firstPatienceMs = 1000;
const maxPatienceMs = 60_000;

export class Quality {
  private share = 1;
  private sum = 0;
  private count = 0;
  private fastFor = 0;
  private patience = firstPatienceMs;
  private readonly lastLevel: number;

  /**
   * Level 0 saves pixels only, level 1 leaves out shadows, each further level draws shapes one step coarser.
   * `coarserSteps`: how many such steps there are. `level`: where to begin.
   */
  constructor(
    coarserSteps: number,
    private level = 0,
  ) {
    this.lastLevel = 1 + coarserSteps;
    this.level = Math.min(level, this.lastLevel);
    if (level > 0) this.share = minShare;
  }

  /** What the next picture of a motion leaves out. */
  get saving(): Saving {
    return savingOf(this.level, this.share);
  }

  /** Records the milliseconds between two pictures of one motion. Decides by the mean of several: intervals are uneven. */
  record(interval: number): void {
    this.sum += interval;
    ++this.count;
    const isClear = this.count >= minPictures || this.sum > 2 * minPictures * tooSlowMs;
    if (this.sum < windowMs || !isClear) return;
    const mean = this.sum / this.count;
    const isFast = mean < (this.share < minShare ? tooSlowMs / 2 : this.level > 0 ? slowMs : fastMs);
    this.fastFor = isFast ? this.fastFor + this.sum : 0;
    this.sum = this.count = 0;
    if (this.fastFor >= this.patience) this.saveLess();
    else if (mean > slowMs) this.saveMore(mean);
  }

  private saveMore(mean: number): void {
    const isUrgent = mean > 2 * tooSlowMs;
    if (mean > tooSlowMs && (this.share <= minShare || isUrgent) && this.level < this.lastLevel) {
      ++this.level;
      this.share = Math.min(this.share, minShare);
      this.patience = Math.min(maxPatienceMs, 2 * this.patience);
      return;
    }
    const least = this.level === this.lastLevel && mean > tooSlowMs ? leastShare : minShare;
    this.share = Math.min(this.share, Math.max(least, this.share * Math.max(0.6, Math.sqrt(slowMs / mean))));
  }

  private saveLess(): void {
    this.fastFor = 0;
    if (this.share < minShare) this.share = minShare;
    else if (this.level > 0) --this.level;
    else this.share = Math.min(1, this.share * 1.25);
  }
}

/** What a level leaves out. */
export const savingOf = (level: number, share: number): Saving => ({
  share,
  shadows: level === 0,
  coarser: Math.max(0, level - 1),
});
