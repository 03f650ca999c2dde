// Decodes the data that `muslin view` put into the page: its description, its arrays, and the motion of its
// points. The file format is that of src/muslin/view/ (point_packer.hpp, page_content.hpp).

/** Bytes of base64 text. */
export function fromBase64(text) {
  const binary = atob(text);
  const bytes = new Uint8Array(binary.length);
  for (let i = 0; i < binary.length; ++i) bytes[i] = binary.charCodeAt(i);
  return bytes;
}

/** Bytes of a zlib stream (RFC 1950). */
export async function inflated(bytes) {
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Uint8Array(await new Response(stream).arrayBuffer());
}

/** Points that move: 16-bit numbers over the box of their whole motion. */
export class Track {
  /** @param {{points: number, low: number[], size: number[]}} description */
  constructor(description, frameCount) {
    this.count = description.points;
    this.low = description.low;
    this.step = description.size.map((size) => size / 65535);
    this.words = new Uint16Array(3 * this.count * frameCount); // by frame, then axis, then point
  }

  /** Reads the record of a frame; returns where the next one begins. Frames come in order. */
  decode(bytes, at, frame) {
    const n = this.count;
    for (let axis = 0; axis < 3; ++axis) {
      const way = bytes[at++];
      const low = at;
      const high = at + n;
      at += 2 * n;
      const now = (3 * frame + axis) * n;
      const before = frame > 0 ? now - 3 * n : -1;
      const earlier = frame > 1 ? now - 6 * n : -1;
      let beside = 0;
      for (let p = 0; p < n; ++p) {
        const folded = bytes[low + p] | (bytes[high + p] << 8);
        let off = (folded >> 1) ^ -(folded & 1);
        if (way & 2) off += beside;
        beside = off;
        let expected = before < 0 ? 0 : this.words[before + p];
        if (way & 1) expected = 2 * expected - this.words[earlier + p];
        this.words[now + p] = expected + off;
      }
    }
    return at;
  }

  /** Writes x, y, z of every point into `out`; between two frames along a straight line. */
  read(place, out) {
    const n = this.count;
    for (let axis = 0; axis < 3; ++axis) {
      const low = this.low[axis];
      const step = this.step[axis];
      const first = (3 * place.frame + axis) * n;
      if (place.blend > 0) {
        const next = first + 3 * n;
        for (let p = 0; p < n; ++p) {
          const a = this.words[first + p];
          out[3 * p + axis] = low + step * (a + place.blend * (this.words[next + p] - a));
        }
      } else {
        for (let p = 0; p < n; ++p) out[3 * p + axis] = low + step * this.words[first + p];
      }
    }
    return out;
  }
}

/** The run in the page. Errors: any, if the page is damaged or the browser too old. */
export async function openRun(page) {
  if (typeof DecompressionStream === 'undefined') {
    throw new Error('This page needs a browser of 2023 or later.');
  }
  const head = JSON.parse(page.getElementById('run').textContent);
  const store = page.getElementById('data');
  const bytes = await inflated(fromBase64(store.textContent));
  store.remove(); // frees the text
  return runFrom(head, bytes);
}

/** @returns {{head, tracks: Track[], floats, indices}} */
export function runFrom(head, bytes) {
  // Copies, so that what held the frames can go.
  const arrays = bytes.slice(0, head.frames_at).buffer;
  const floats = (array) => new Float32Array(arrays, array.at, array.count);
  const indices = (array) => new Uint32Array(arrays, array.at, array.count);
  const tracks = head.tracks.map((track) => new Track(track, head.frames.length));
  let at = head.frames_at;
  for (let frame = 0; frame < head.frames.length; ++frame) {
    for (const track of tracks) at = track.decode(bytes, at, frame);
  }
  if (at !== bytes.length) throw new Error('This page is damaged: it ends too early or too late.');
  return { head, tracks, floats, indices };
}
