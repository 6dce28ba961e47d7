/** Runs work in the browser's idle moments, a slice at a time. */

const leastMs = 6;
const patienceMs = 120;

/** Jobs run one after the other; a job that throws is dropped and reported. */
export class IdleQueue {
  private readonly jobs: { work: Iterator<unknown>; done: () => void }[] = [];
  private running = false;

  constructor(private readonly onError: (error: unknown) => void) {}

  /** `first`: before all that waits. */
  add(work: Iterator<unknown>, options: { first?: boolean; done?: () => void } = {}): void {
    const job = { work, done: options.done ?? (() => {}) };
    if (options.first) this.jobs.unshift(job);
    else this.jobs.push(job);
    if (!this.running) this.schedule();
  }

  private schedule(): void {
    this.running = this.jobs.length > 0;
    if (!this.running) return;
    if ("requestIdleCallback" in window)
      requestIdleCallback((deadline) => this.run(deadline.timeRemaining()), { timeout: patienceMs });
    else setTimeout(() => this.run(leastMs), 4);
  }

  private run(free: number): void {
    const end = performance.now() + Math.max(leastMs, free);
    while (this.jobs.length > 0 && performance.now() < end) {
      const job = this.jobs[0];
      let isDone: boolean;
      try {
        isDone = job.work.next().done === true;
      } catch (error) {
        this.jobs.splice(this.jobs.indexOf(job), 1);
        this.onError(error);
        continue;
      }
      if (!isDone) continue;
      this.jobs.splice(this.jobs.indexOf(job), 1);
      job.done();
    }
    this.schedule();
  }
}
