// When the 3D view is drawn with fewer pixels: while it is turned by hand and the renderer is too slow for that. At rest it has all
// of them. Pure: times in ms are passed in.

export const kRests_ms = 300;  // after the last movement
const kSlow_ms = 60;           // between drawings
const kQuick_ms = 25;          // then there is time for all pixels
const kSlowFrames = 3;

export class Haste {
  constructor() {
    this.slow_ = 0;
    this.turned_ = -Infinity;
    this.drawn_ = -Infinity;
  }

  // The view is moved.
  turned(now) {
    this.turned_ = now;
  }

  // A drawing begins: true where it is to be coarse.
  drawing(now) {
    const interval = now - this.drawn_;
    this.drawn_ = now;
    if (now - this.turned_ > kRests_ms) return false;
    if (interval > kSlow_ms && interval < 1000) this.slow_ = Math.min(this.slow_ + 1, 2 * kSlowFrames);
    else if (interval < kQuick_ms) this.slow_ = Math.max(this.slow_ - 1, 0);
    return this.slow_ >= kSlowFrames;
  }
}
