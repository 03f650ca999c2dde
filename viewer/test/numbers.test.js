// Tests the computations of the page that need no screen.
import assert from 'node:assert/strict';
import { test } from 'node:test';
import { keyed } from '../src/annotations.js';
import { Clock, speeds } from '../src/clock.js';
import { mapColour } from '../src/colours.js';
import { framed } from '../src/framing.js';
import { digits, roundUp, ticks, withUnit } from '../src/numbers.js';
import { edgeStretch, smoothNormals } from '../src/surface_shape.js';

const everyFrame = (count) => Array.from({ length: count }, (_, i) => i);

test('the clock shows the last stored frame not after the time', () => {
  const clock = new Clock([0, 4, 8, 9], 24);
  for (const [frame, shown] of [[0, 0], [3.9, 0], [4, 4], [7, 4], [8, 8], [9, 9]]) {
    clock.time = frame / 24;
    assert.equal(clock.frame, shown);
  }
});

test('seeking while paused goes to the nearest stored frame', () => {
  const clock = new Clock([0, 4, 8, 9], 24);
  clock.seekTime(3 / 24);
  assert.equal(clock.frame, 4);
  assert.equal(clock.time, 4 / 24);
  clock.seekTime(100);
  assert.equal(clock.frame, 9);
  clock.seekTime(-1);
  assert.equal(clock.frame, 0);
});

test('playing takes as long as the run and begins anew, or ends', () => {
  const clock = new Clock(everyFrame(25), 24);
  clock.play();
  clock.advance(0.5);
  assert.equal(clock.frame, 12);
  clock.advance(0.5);
  assert.equal(clock.frame, 24); // the last frame is seen as well
  clock.advance(1 / 24);
  assert.equal(clock.frame, 0);
  assert.ok(clock.playing);
  clock.loop = false;
  clock.advance(5);
  assert.equal(clock.frame, 24);
  assert.ok(!clock.playing);
  clock.play(); // from the end: from the start
  assert.equal(clock.frame, 0);
});

test('speed stretches time and stays among those offered', () => {
  const clock = new Clock(everyFrame(49), 24);
  clock.speed = 0.25;
  clock.play();
  clock.advance(2);
  assert.equal(clock.frame, 12);
  for (let i = 0; i < 10; ++i) clock.changeSpeed(1);
  assert.equal(clock.speed, speeds.at(-1));
  clock.cycleSpeed();
  assert.equal(clock.speed, speeds[0]);
  clock.changeSpeed(-1);
  assert.equal(clock.speed, speeds[0]);
});

test('stepping pauses and goes around the ends', () => {
  const clock = new Clock([0, 4, 8, 9], 24);
  clock.play();
  clock.step(-1);
  assert.ok(!clock.playing);
  assert.equal(clock.frame, 9);
  clock.step(2);
  assert.equal(clock.frame, 4);
});

test('only slow or thinned play fills in between frames', () => {
  const clock = new Clock([0, 4, 8, 9], 24);
  clock.time = 2 / 24;
  assert.deepEqual(clock.place, { frame: 0, blend: 0 }); // paused
  clock.play();
  assert.equal(clock.place.frame, 0);
  assert.ok(Math.abs(clock.place.blend - 0.5) < 1e-9);
  const whole = new Clock(everyFrame(10), 24);
  whole.play();
  whole.advance(1.4 / 24);
  assert.deepEqual(whole.place, { frame: 1, blend: 0 });
});

test('a run of one frame does not play', () => {
  const clock = new Clock([0], 24);
  clock.play();
  assert.ok(!clock.playing);
  clock.advance(1);
  clock.step(1);
  assert.equal(clock.frame, 0);
});

test('keyed forces are linear between keys and constant outside', () => {
  const keys = [{ time: 1, value: [0, 0, 0] }, { time: 3, value: [4, -2, 0] }];
  assert.deepEqual(keyed(keys, 0), [0, 0, 0]);
  assert.deepEqual(keyed(keys, 2), [2, -1, 0]);
  assert.deepEqual(keyed(keys, 9), [4, -2, 0]);
});

test('numbers are round and short', () => {
  assert.equal(roundUp(0.7), 1);
  assert.equal(roundUp(13), 20);
  assert.equal(roundUp(0.021), 0.05);
  assert.equal(roundUp(5), 5);
  assert.deepEqual(ticks(-0.5, 2.1, 4), [0, 1, 2]);
  assert.equal(digits(1234.5), '1230');
  assert.equal(digits(-0.5), '\u22120.5');
  assert.equal(digits(Infinity), '\u2013');
  assert.equal(withUnit(12345, 'J'), '12.3\u00a0kJ');
  assert.equal(withUnit(-0.0477, 'J'), '\u221247.7\u00a0mJ');
  assert.equal(withUnit(0, 'J'), '0\u00a0J');
});

test('stretch colours are those of the pictures', () => {
  // src/muslin/render/colour.cpp: from indigo to yellow, lighter and lighter.
  const luminance = ([r, g, b]) => 0.2126 * r + 0.7152 * g + 0.0722 * b;
  for (let i = 0; i < 10; ++i) assert.ok(luminance(mapColour(i / 10)) < luminance(mapColour((i + 1) / 10)));
  assert.ok(mapColour(0)[2] > mapColour(0)[1]);
  assert.ok(mapColour(1)[0] > 2 * mapColour(1)[2]);
});

test('normals of a bent strip are smooth where its groups say so', () => {
  // Two unit squares at a right angle, one normal each side of the fold or one for both.
  const positions = new Float32Array([0, 0, 0, 1, 0, 0, 0, 0, -1, 1, 0, -1, 0, 1, 0, 1, 1, 0]);
  const triangles = new Uint32Array([0, 1, 3, 0, 3, 2, 4, 5, 1, 4, 1, 0]);
  const points = new Uint32Array([0, 1, 2, 3, 4, 5]);
  const shape = { triangles, points, normals: new Uint32Array([0, 1, 2, 3, 4, 5]) };
  const out = new Float32Array(18);
  smoothNormals(positions, shape, new Float32Array(18), out);
  const at = (v) => Array.from(out.subarray(3 * v, 3 * v + 3)).map((x) => Math.round(1000 * x) / 1000 + 0);
  assert.deepEqual(at(2), [0, 1, 0]);
  const fold = at(0);
  assert.ok(Math.abs(Math.abs(fold[1]) - Math.SQRT1_2) < 1e-3 && Math.abs(Math.abs(fold[2]) - Math.SQRT1_2) < 1e-3);
  for (let v = 0; v < 6; ++v) assert.ok(Math.abs(Math.hypot(...out.subarray(3 * v, 3 * v + 3)) - 1) < 1e-6);
});

test('stretch is the largest of the edges of a point, never negative', () => {
  const positions = new Float32Array([0, 0, 0, 1.2, 0, 0, 1.2, 0.5, 0]);
  const out = new Float32Array(3);
  edgeStretch(positions, new Uint32Array([0, 1, 1, 2]), new Float32Array([1, 1]), out);
  assert.ok(Math.abs(out[0] - 20) < 1e-4 && Math.abs(out[1] - 20) < 1e-4);
  assert.equal(out[2], 0);
});

test('the camera looks at what moves, not at the ends of the floor', () => {
  const track = (low, size, positions) => ({
    count: positions[0].length / 3, low, step: size.map((x) => x / 65535),
    words: Uint16Array.from(positions.flat()),
    read({ frame }, out) {
      const n = this.count;
      for (let p = 0; p < n; ++p) for (let axis = 0; axis < 3; ++axis) {
        out[3 * p + axis] = this.low[axis] + this.step[axis] * this.words[(3 * frame + axis) * n + p];
      }
    },
  });
  const cloth = track([0, 0, 0], [1, 1, 1], [[0, 65535, 0, 0, 0, 65535], [0, 65535, 0, 65535, 0, 65535]]);
  const floor = track([-50, -1, -50], [101, 0, 101], [[0, 65535, 0, 0, 0, 65535], [0, 65535, 0, 0, 0, 65535]]);
  const run = {
    tracks: [cloth, floor],
    head: { frames: [0, 1], bodies: [0, 1].map((k) => ({ surfaces: { skin: { track: k } } })) },
  };
  const { places, bounds } = framed(run, 1000);
  assert.deepEqual(bounds.low, [0, 0, 0]);
  assert.equal(places.length, 12); // two points at two frames, none of the floor
  run.tracks = [floor, floor]; // nothing moves: all is looked at
  assert.ok(framed(run, 1000).places.length > 0);
});
