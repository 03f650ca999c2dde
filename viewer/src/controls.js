// Buttons, keys and fingers.
import { colourings } from './cloth_material.js';
import { keyTable, listen } from './keys.js';
import { digits } from './numbers.js';
import { presets } from './stage.js';
import { choice, tick } from './widgets.js';

const element = (id) => document.getElementById(id);
const words = {
  skin: 'Skin', contour: 'Contour', lattice: 'Lattice', plain: 'Plain', stretch: 'Stretch', checker: 'Checker',
  uv: 'UV', 'three-quarter': '\u00be', front: 'Front', side: 'Side', back: 'Back', top: 'Top', y: 'y', z: 'z',
};
const named = (values) => values.map((value) => [value, words[value]]);
const after = (values, value) => values[(values.indexOf(value) + 1) % values.length];

/** Title and facts above the picture. */
function describe({ run: { head }, stage }) {
  document.querySelector('h1').textContent = head.title;
  const facts = [];
  if (head.bodies.length > 1) facts.push(`${head.bodies.length} bodies`);
  facts.push(`${digits((head.frame_count - 1) / head.frame_rate)} s, ${digits(head.frame_rate)} frames a second`);
  const state = { running: 'still running', interrupted: 'interrupted', failed: 'the solver gave up' }[head.status];
  if (state) facts.push(`${state}: ${head.frame_count} of ${head.last_frame + 1} frames`);
  const cell = stage.gridCell;
  facts.push(`squares of ${cell < 0.01 ? `${digits(1000 * cell)} mm` : cell < 1 ? `${digits(100 * cell)} cm` : `${digits(cell)} m`}`);
  element('facts').textContent = facts.join(' \u00b7 ');
  element('notes').hidden = head.notes.length === 0;
  element('notes').textContent = head.notes.join(' ');
  element('version').textContent = head.muslin;
}

/** Surface, colours, views, and what is shown. Returns the boxes to tick. */
function makeLook(viewer, then, updates) {
  const { stage, bodies, annotations } = viewer;
  const row = (id, options, current, choose) => updates.push(choice(element(id), named(options), current, then(choose)));
  row('surface', viewer.kinds, () => viewer.surface, (kind) => viewer.setSurface(kind));
  row('colouring', colourings, () => viewer.colouring, (name) => viewer.setColouring(name));
  row('preset', Object.keys(presets), () => stage.preset, (name) => stage.setView(name));
  row('up', ['y', 'z'], () => stage.up, (up) => stage.setUp(up));
  element('surface').closest('fieldset').hidden = viewer.kinds.length < 2;
  element('bodies').closest('fieldset').hidden = bodies.length < 2;
  for (const body of bodies) {
    tick(element('bodies'), body.name, true, then((on) => { body.object.visible = on; }), body.colour);
  }
  const box = (text, on, change) => tick(element('shown'), text, on, then(change));
  const boxes = { edges: box('Edges', false, (on) => bodies.forEach((body) => body.showEdges(on))) };
  if (annotations.pins.length) boxes.pins = box('Pins', true, (on) => { annotations.pinsWanted = on; });
  if (annotations.forces.length) boxes.forces = box('Forces', true, (on) => { annotations.forcesWanted = on; });
  boxes.ground = box('Ground', true, (on) => stage.setGround(on));
  boxes.turntable = box('Turntable', false, (on) => { stage.controls.autoRotate = on; });
  return boxes;
}

/** Panels at the side, or at the bottom of a phone; the view makes room for them. */
function makePanels({ stage }, changed) {
  const panels = ['look', 'curves'];
  const layOut = () => {
    const open = panels.map(element).find((panel) => !panel.hidden)?.getBoundingClientRect();
    const top = document.querySelector('header').getBoundingClientRect().bottom;
    const footer = document.querySelector('footer').getBoundingClientRect().top;
    const narrow = open && open.width > 0.6 * innerWidth;
    stage.setInsets({
      left: 0, right: open && !narrow ? innerWidth - open.left : 0,
      top: narrow ? top : Math.min(top, 0.14 * innerHeight), bottom: innerHeight - (narrow ? open.top : footer),
    });
  };
  const openPanel = (name) => {
    for (const each of panels) {
      const open = each === name && element(each).hidden;
      element(each).hidden = !open;
      element(`open-${each}`).setAttribute('aria-expanded', open);
    }
    layOut();
    changed();
  };
  for (const name of panels) element(`open-${name}`).addEventListener('click', () => openPanel(name));
  window.addEventListener('resize', () => {
    layOut();
    changed();
  });
  return { layOut, openPanel };
}

/** The bar below. */
function makeTransport(viewer, then, updates) {
  const { clock } = viewer;
  const slider = element('time');
  slider.max = clock.frames.length - 1;
  slider.addEventListener('input', then(() => clock.seekIndex(Number(slider.value))));
  element('play').addEventListener('click', then(() => clock.toggle()));
  element('back').addEventListener('click', then(() => clock.step(-1)));
  element('on').addEventListener('click', then(() => clock.step(1)));
  element('speed').addEventListener('click', then(() => clock.cycleSpeed()));
  element('loop').addEventListener('click', then(() => { clock.loop = !clock.loop; }));
  const frame = document.createElement('b');
  const rest = document.createTextNode('');
  element('now').append(frame, rest);
  const decimals = clock.frameRate > 100 ? 3 : 2;
  viewer.onMove = () => {
    slider.value = clock.index;
    const time = (clock.frame / clock.frameRate).toFixed(decimals);
    frame.textContent = clock.frame;
    rest.textContent = ` / ${clock.frames.at(-1)} \u00b7 ${time} s`;
    slider.setAttribute('aria-valuetext', `frame ${clock.frame}, ${time} seconds`);
  };
  updates.push(viewer.onMove);
  // Playing may also end by itself, so this is looked at whenever something is drawn.
  viewer.onState = () => {
    document.body.classList.toggle('playing', clock.playing);
    element('play').setAttribute('aria-label', clock.playing ? 'Pause' : 'Play');
    element('speed').textContent = `${clock.speed}\u00d7`;
    element('speed').setAttribute('aria-label', `Speed ${clock.speed}`);
    element('loop').setAttribute('aria-pressed', clock.loop);
  };
}

export function makeControls(viewer) {
  const { clock, stage } = viewer;
  const updates = [];
  const changed = () => {
    for (const update of updates) update();
    viewer.refresh();
  };
  const then = (action) => (...values) => {
    action(...values);
    changed();
  };
  const boxes = makeLook(viewer, then, updates);
  const { layOut, openPanel } = makePanels(viewer, changed);
  makeTransport(viewer, then, updates);
  stage.controls.addEventListener('start', () => changed());

  const act = {
    toggle: then(() => clock.toggle()),
    step: then((count) => clock.step(count)),
    first: then(() => clock.stopAt(0)),
    last: then(() => clock.stopAt(clock.frames.length - 1)),
    slower: then(() => clock.changeSpeed(-1)),
    faster: then(() => clock.changeSpeed(1)),
    loop: then(() => { clock.loop = !clock.loop; }),
    view: then((name) => stage.setView(name)),
    up: then(() => stage.setUp(stage.up === 'y' ? 'z' : 'y')),
    nextSurface: then(() => viewer.setSurface(after(viewer.kinds, viewer.surface))),
    nextColouring: then(() => viewer.setColouring(after(colourings, viewer.colouring))),
    look: () => openPanel('look'),
    curves: () => openPanel('curves'),
    theme: then(() => viewer.setTheme(viewer.theme === 'dark' ? 'light' : 'dark')),
    picture: () => viewer.savePicture(),
    fullScreen: () => (document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen?.()),
    help: () => element('help').showModal(),
  };
  for (const name of ['edges', 'pins', 'forces', 'ground', 'turntable']) act[name] = () => boxes[name]?.click();
  for (const [id, action] of [['theme', act.theme], ['picture', act.picture], ['fullscreen', act.fullScreen], ['open-help', act.help]]) {
    element(id).addEventListener('click', action);
  }
  listen(keyTable(act), document.querySelector('#help dl'), () => element('help').open);

  describe(viewer);
  layOut();
  changed();
}
