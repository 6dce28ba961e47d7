/** Runs work in slices while the browser is idle. */

const minMs = 6;
const timeoutMs = 120;

/** Runs jobs in order. A job that throws is removed and reported. */
export class IdleQueue {
  private readonly jobs: { work: Iterator<unknown>; done: () => void }[] = [];
  private running = false;

  constructor(private readonly onError: (error: unknown) => void) {}

  /** Adds a job; `first`: before all waiting jobs. */
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
      requestIdleCallback((deadline) => this.run(deadline.timeRemaining()), { timeout: timeoutMs });
    else setTimeout(() => this.run(minMs), 4);
  }

  private run(idleMs: number): void {
    const end = performance.now() + Math.max(minMs, idleMs);
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
