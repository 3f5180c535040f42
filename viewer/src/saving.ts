// The picture and the film of what is seen, as files.
import { h } from "./html.ts";
import type { Shown, Store } from "./store.ts";

/** What puts its picture on a canvas, with `least_ratio` px or more for one of the page. */
export interface Composed {
  compose(canvas: HTMLCanvasElement, least_ratio: number): void;
}

export function save(blob: Blob, name: string): void {
  const address = URL.createObjectURL(blob);
  const link = h("a", { href: address, download: name });
  link.click();
  setTimeout(() => URL.revokeObjectURL(address), 10_000);
}

export function save_picture(stage: Composed, name: string): Promise<void> {
  const canvas = h("canvas");
  stage.compose(canvas, 2);
  return new Promise((done) =>
    canvas.toBlob((blob) => {
      if (blob) save(blob, `${name}.png`);
      done();
    }, "image/png"),
  );
}

const film_ratio = 1.5; // px for one of the page: sharp, and drawn in time
const kinds = [
  ["video/webm;codecs=vp9", "webm"], ["video/webm;codecs=vp8", "webm"], ["video/webm", "webm"], ["video/mp4", "mp4"],
];

/** Films the frames from the first to the last at the rate of the player; `bring` draws a frame, `tell` hears how far
 *  it is. `stop` ends it early; what there is by then is saved. Throws where the browser records no film. */
export async function save_film(
  stage: Composed,
  store: Store<Shown>,
  frames: number,
  name: string,
  bring: () => Promise<void>,
  tell: (done: number) => void,
  stop: () => boolean,
): Promise<void> {
  const kind = typeof MediaRecorder === "undefined" ? undefined : kinds.find(([k]) => MediaRecorder.isTypeSupported(k));
  if (!kind) throw new Error("this browser cannot record films; udar movie makes one");
  const canvas = h("canvas");
  const { frame: before, rate } = store.now;
  store.set({ playing: false, frame: 0 });
  await bring();
  stage.compose(canvas, film_ratio);
  const stream = canvas.captureStream(0);
  const track = stream.getVideoTracks()[0] as CanvasCaptureMediaStreamTrack;
  const recorder = new MediaRecorder(stream, { mimeType: kind[0], videoBitsPerSecond: 12_000_000 });
  const parts: Blob[] = [];
  recorder.ondataavailable = (event) => parts.push(event.data);
  const ended = new Promise((done) => (recorder.onstop = done));
  recorder.start(1000);
  // The recorder keeps real time: a frame lasts as long in the film as here.
  for (let frame = 0; frame < frames && !stop(); ++frame) {
    const begin = performance.now();
    store.set({ frame });
    await bring();
    stage.compose(canvas, film_ratio);
    track.requestFrame();
    tell(frame + 1);
    await new Promise((done) => setTimeout(done, Math.max(0, 1000 / rate - (performance.now() - begin))));
  }
  recorder.stop();
  await ended;
  store.set({ frame: before });
  save(new Blob(parts, { type: kind[0] }), `${name}.${kind[1]}`);
}
