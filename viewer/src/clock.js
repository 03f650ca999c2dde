// Holds the present time of the run and moves it during playback, independently of the screen.

export const speeds = [0.1, 0.25, 0.5, 1, 2, 4];

/** Below this many stored frames a second, motion between them is filled in. */
const smoothEnough = 20;

export class Clock {
  /**
   * @param frames numbers of the stored frames, ascending from 0
   * @param frameRate frames of the run per second
   */
  constructor(frames, frameRate) {
    this.frames = frames;
    this.frameRate = frameRate;
    this.end = frames[frames.length - 1] / frameRate; // [s]
    this.time = 0; // [s] of the run
    this.playing = false;
    this.loop = true;
    this.speed = 1;
  }

  /** Index of the stored frame that is shown: the last one not after `time`. */
  get index() {
    const frame = this.time * this.frameRate + 1e-6;
    let low = 0;
    let high = this.frames.length - 1;
    while (low < high) {
      const middle = (low + high + 1) >> 1;
      if (this.frames[middle] <= frame) low = middle;
      else high = middle - 1;
    }
    return low;
  }

  /** The number of the frame that is shown. */
  get frame() {
    return this.frames[this.index];
  }

  /** The place for Track.read: a stored frame, or between two while playing slowly. */
  get place() {
    const index = this.index;
    const next = this.frames[index + 1];
    if (!this.playing || next === undefined) return { frame: index, blend: 0 };
    const gap = next - this.frames[index];
    if ((this.frameRate * this.speed) / gap >= smoothEnough) return { frame: index, blend: 0 };
    const blend = (this.time * this.frameRate - this.frames[index]) / gap;
    return { frame: index, blend: Math.min(Math.max(blend, 0), 1) };
  }

  play() {
    if (this.time >= this.end - 1e-9) this.time = 0;
    this.playing = this.frames.length > 1;
  }

  /** Stops on the stored frame that is shown. */
  pause() {
    this.playing = false;
    this.seekIndex(this.index);
  }

  toggle() {
    if (this.playing) this.pause();
    else this.play();
  }

  seekTime(time) {
    this.time = Math.min(Math.max(time, 0), this.end);
    if (!this.playing) this.seekIndex(this.nearest());
  }

  seekIndex(index) {
    const last = this.frames.length - 1;
    this.time = this.frames[Math.min(Math.max(index, 0), last)] / this.frameRate;
  }

  stopAt(index) {
    this.playing = false;
    this.seekIndex(index);
  }

  /** Pauses and goes `count` stored frames on, around the ends. */
  step(count) {
    this.pause();
    const n = this.frames.length;
    this.seekIndex((((this.index + count) % n) + n) % n);
  }

  changeSpeed(direction) {
    const at = speeds.indexOf(this.speed) + direction;
    this.speed = speeds[Math.min(Math.max(at, 0), speeds.length - 1)];
  }

  /** The next speed; after the fastest the slowest. */
  cycleSpeed() {
    this.speed = speeds[(speeds.indexOf(this.speed) + 1) % speeds.length];
  }

  /** Lets `seconds` of the viewer's life go by. */
  advance(seconds) {
    if (!this.playing) return;
    this.time += seconds * this.speed;
    // The last frame stays for as long as every other.
    const end = this.end + 1 / this.frameRate;
    if (this.time < end) return;
    if (this.loop) {
      this.time %= end;
    } else {
      this.time = this.end;
      this.playing = false;
    }
  }

  nearest() {
    const index = this.index;
    const next = this.frames[index + 1];
    if (next === undefined) return index;
    const frame = this.time * this.frameRate;
    return next - frame < frame - this.frames[index] ? index + 1 : index;
  }
}
