// Chooses what the camera shows: everything that moves, and static things near it. A floor is too large to be shown
// whole.

/** Whether the points of a track stay where they are. */
function still(track, frames) {
  const size = 3 * track.count;
  for (let i = size; i < frames * size; ++i) if (track.words[i] !== track.words[i - size]) return false;
  return true;
}

function boxOf(tracks) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (const track of tracks) {
    for (let i = 0; i < 3; ++i) {
      low[i] = Math.min(low[i], track.low[i]);
      high[i] = Math.max(high[i], track.low[i] + 65535 * track.step[i]);
    }
  }
  return { low, size: high.map((x, i) => x - low[i]) };
}

/**
 * @returns places: x, y, z of up to about `most` points where skins are over the run, evenly chosen;
 *   bounds: {low, size}, the box of what moves
 */
export function framed(run, most) {
  const frames = run.head.frames.length;
  const tracks = run.head.bodies.map((body) => run.tracks[body.surfaces.skin.track]);
  const moving = tracks.filter((track) => !still(track, frames));
  const bounds = boxOf(moving.length ? moving : tracks);
  const room = 0.5 * Math.hypot(...bounds.size);
  const near = (x, axis) => x > bounds.low[axis] - room && x < bounds.low[axis] + bounds.size[axis] + room;
  const points = tracks.reduce((sum, track) => sum + track.count, 0);
  const frameStride = Math.ceil(frames / 60);
  const pointStride = Math.ceil((points * Math.ceil(frames / frameStride)) / most);
  const places = [];
  for (const track of tracks) {
    const positions = new Float32Array(3 * track.count);
    const last = moving.includes(track) ? frames : 1;
    for (let frame = 0; frame < last; frame += frameStride) {
      track.read({ frame, blend: 0 }, positions);
      for (let p = 0; p < track.count; p += pointStride) {
        const place = positions.subarray(3 * p, 3 * p + 3);
        if (place.every(near)) places.push(...place);
      }
    }
  }
  return { places, bounds };
}
