// Plays the frames, one after the other, never faster than they are drawn.
import type { Shown, Store } from "./store.ts";

export class Player {
  #last = 0; // when a frame was last asked for, ms

  /** `drawn`: is the frame asked for on the stage? */
  constructor(
    private readonly frames: number,
    private readonly store: Store<Shown>,
    private readonly drawn: () => boolean,
  ) {
    store.on(["playing"], () => {
      if (store.now.playing) requestAnimationFrame(this.#tick);
    });
  }

  readonly #tick = (now: number): void => {
    const { playing, frame, rate, loop } = this.store.now;
    if (!playing) return;
    if (now - this.#last >= 1000 / rate - 4 && this.drawn()) {
      this.#last = now;
      if (frame + 1 < this.frames) this.store.set({ frame: frame + 1 });
      else if (loop) this.store.set({ frame: 0 });
      else this.store.set({ playing: false });
    }
    requestAnimationFrame(this.#tick);
  };

  play(): void {
    const { frame, playing } = this.store.now;
    if (this.frames < 2) return;
    if (!playing && frame === this.frames - 1) this.store.set({ frame: 0 });
    this.store.set({ playing: !playing });
  }

  go(frame: number): void {
    this.store.set({ playing: false, frame: Math.min(this.frames - 1, Math.max(0, frame)) });
  }
}
