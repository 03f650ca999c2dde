// The page: opens the run and ties clock, stage, curves and buttons together.
import { Annotations } from './annotations.js';
import { Body } from './body.js';
import { Clock, speeds } from './clock.js';
import { colourings } from './cloth_material.js';
import { css, mapColour } from './colours.js';
import { makePlots } from './curves.js';
import { makeControls } from './controls.js';
import { framed } from './framing.js';
import { digits, roundUp } from './numbers.js';
import { openRun } from './run_data.js';
import { Stage, presets } from './stage.js';

const element = (id) => document.getElementById(id);

/** Up is where gravity does not pull; y, if there is none. */
function upAxis(run) {
  const gravity = run.head.forces.find((force) => force.type === 'gravity');
  if (!gravity) return 'y';
  const [x, y, z] = gravity.keys[0].value;
  return z < 0 && -z > Math.abs(y) && -z > Math.abs(x) ? 'z' : 'y';
}

/** Choices after the # of the address: look=stretch&frame=24&play=0. */
function wishes() {
  return new URLSearchParams(location.hash.slice(1));
}

class Viewer {
  constructor(run) {
    this.run = run;
    const { head } = run;
    this.clock = new Clock(head.frames, head.frame_rate);
    const { places, bounds } = framed(run, 30000);
    this.stage = new Stage(element('view'), places);
    this.bodies = head.bodies.map((body) => new Body(run, body));
    this.annotations = new Annotations(run, bounds, element('labels'));
    this.stage.beside = this.annotations.reach();
    for (const each of [...this.bodies, this.annotations]) this.stage.world.add(each.object);
    this.kinds = ['skin', 'contour', 'lattice'].filter((kind) => head.bodies.some((body) => body.surfaces[kind]));
    this.surface = 'skin';
    this.colouring = 'plain';
    this.plots = makePlots(element('curves'), run, (time) => this.seek(() => this.clock.seekTime(time)));
    this.stage.setUp(upAxis(run));
    this.setTheme(wishes().get('theme') ?? (matchMedia('(prefers-color-scheme: dark)').matches ? 'dark' : 'light'));
    this.applyLook();
    this.stale = true;
  }

  /** Something about what is shown changed. */
  refresh() {
    this.stale = true;
  }

  seek(change) {
    change();
    this.refresh();
  }

  setTheme(name) {
    this.theme = name;
    document.documentElement.classList.toggle('dark', name === 'dark');
    this.stage.setTheme(name === 'dark');
    for (const plot of this.plots) plot.forget();
    this.refresh();
  }

  setSurface(kind) {
    if (!this.kinds.includes(kind)) return;
    this.surface = kind;
    this.applyLook();
  }

  setColouring(name) {
    if (!colourings.includes(name)) return;
    this.colouring = name;
    this.applyLook();
  }

  /** Upper end of the stretch colours [%]. */
  get stretchMax() {
    return roundUp(Math.max(...this.bodies.map((body) => body.surface.largestStretch), 0.1));
  }

  applyLook() {
    for (const body of this.bodies) body.showSurface(this.surface);
    const most = this.stretchMax;
    for (const body of this.bodies) body.setColouring(this.colouring, most);
    const scale = element('scale');
    scale.hidden = this.colouring !== 'stretch';
    scale.children[0].textContent = 'Stretch of edges';
    const stops = Array.from({ length: 11 }, (_, i) => css(mapColour(i / 10)));
    scale.children[1].style.background = `linear-gradient(to right, ${stops.join(', ')})`;
    scale.children[3].textContent = `${digits(most)} %`;
    this.refresh();
  }

  /** Moves everything to the present and draws, where something changed. */
  draw() {
    this.stage.resize();
    const { clock } = this;
    if (clock.playing !== this.wasPlaying || this.stale) this.onState?.();
    this.wasPlaying = clock.playing;
    const { place } = clock;
    const key = `${place.frame} ${place.blend}`;
    if (this.stale || key !== this.shown) {
      this.shown = key;
      this.stale = false;
      for (const body of this.bodies) body.moveTo(place);
      this.annotations.moveTo(place, clock.playing ? clock.time : clock.frame / clock.frameRate);
      const row = Math.min(clock.frame, this.run.head.frame_count - 1);
      for (const plot of this.plots) plot.moveTo(clock.frame / clock.frameRate, row);
      this.onMove?.();
      this.stage.invalidate();
    }
    if (this.stage.draw()) this.annotations.placeLabels(this.stage);
  }

  start() {
    let before = performance.now();
    const tick = (now) => {
      // A page that was in the background goes on where it was.
      this.clock.advance(Math.min((now - before) / 1000, 0.25));
      before = now;
      this.draw();
      requestAnimationFrame(tick);
    };
    requestAnimationFrame(tick);
  }

  /** A picture of the view, as a PNG to keep. */
  savePicture() {
    this.stage.invalidate();
    this.draw();
    this.stage.canvas.toBlob((blob) => {
      const link = document.createElement('a');
      link.href = URL.createObjectURL(blob);
      link.download = `${document.title.replace(/[^\w-]+/g, '_')}.${String(this.clock.frame).padStart(4, '0')}.png`;
      link.click();
      setTimeout(() => URL.revokeObjectURL(link.href), 1000);
    });
  }
}

function grantWishes(viewer) {
  const wish = wishes();
  if (wish.has('surface')) viewer.setSurface(wish.get('surface'));
  if (wish.has('colours')) viewer.setColouring(wish.get('colours'));
  if (wish.has('speed') && speeds.includes(Number(wish.get('speed')))) viewer.clock.speed = Number(wish.get('speed'));
  if (wish.has('view') && presets[wish.get('view')]) viewer.stage.preset = wish.get('view');
  const calm = matchMedia('(prefers-reduced-motion: reduce)').matches;
  if (wish.has('frame')) viewer.clock.seekTime(Number(wish.get('frame')) / viewer.run.head.frame_rate);
  if (wish.get('play') !== '0' && !calm && !wish.has('frame')) viewer.clock.play();
}

async function begin() {
  const trouble = element('trouble'); // says "Opening" until then
  try {
    const viewer = new Viewer(await openRun(document));
    grantWishes(viewer);
    makeControls(viewer);
    trouble.hidden = true;
    viewer.start();
    window.muslin = viewer; // for scripts and tests
  } catch (error) {
    trouble.hidden = false;
    trouble.textContent = /webgl/i.test(error.message)
      ? 'This browser cannot draw in three dimensions (WebGL is off).' : error.message;
    throw error;
  }
}

begin();
