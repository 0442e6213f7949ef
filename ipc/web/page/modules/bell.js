// A bell without a sound file. Browsers allow sound only after the first interaction with a page.

let context = null;

export function allow_bell() {
  context ??= new (window.AudioContext ?? window.webkitAudioContext)();
  if (context.state === "suspended") context.resume();
}

export function ring() {
  document.documentElement.dataset.rung = String(Number(document.documentElement.dataset.rung ?? 0) + 1);
  if (!context || context.state !== "running") return false;
  const now = context.currentTime;
  for (const [frequency, loudness, length] of [[880, 0.18, 0.5], [1760, 0.06, 0.25]]) {
    const tone = context.createOscillator();
    const gain = context.createGain();
    tone.frequency.value = frequency;
    gain.gain.setValueAtTime(loudness, now);
    gain.gain.exponentialRampToValueAtTime(0.0005, now + length);
    tone.connect(gain).connect(context.destination);
    tone.start(now);
    tone.stop(now + length);
  }
  return true;
}
