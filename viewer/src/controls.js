// Buttons, keys and fingers.
import { colourings } from './cloth_material.js';
import { css } from './colours.js';
import { digits } from './numbers.js';
import { presets } from './stage.js';

const element = (id) => document.getElementById(id);
const names = {
  skin: 'Skin', contour: 'Contour', lattice: 'Lattice', own: 'Own', stretch: 'Stretch', checker: 'Checker',
  texture: 'Texture', 'three-quarter': '\u00be', front: 'Front', side: 'Side', back: 'Back', top: 'Top', y: 'y', z: 'z',
};

/** A row of buttons of which one is chosen. */
function choice(id, values, current, choose) {
  const row = element(id);
  const buttons = values.map((value) => {
    const button = document.createElement('button');
    button.type = 'button';
    button.textContent = names[value];
    button.dataset.value = value;
    button.setAttribute('role', 'radio');
    button.addEventListener('click', () => choose(value));
    row.append(button);
    return button;
  });
  row.addEventListener('keydown', (event) => {
    const move = { ArrowLeft: -1, ArrowUp: -1, ArrowRight: 1, ArrowDown: 1 }[event.key];
    if (!move) return;
    event.preventDefault();
    event.stopPropagation();
    const at = buttons.indexOf(document.activeElement);
    const next = buttons[(at + move + buttons.length) % buttons.length];
    next.focus();
    next.click();
  });
  const update = () => {
    for (const button of buttons) {
      const chosen = button.dataset.value === current();
      button.setAttribute('aria-checked', chosen);
      button.tabIndex = chosen ? 0 : -1;
    }
    if (!buttons.some((button) => button.tabIndex === 0)) buttons[0].tabIndex = 0;
  };
  update();
  return update;
}

function check(parent, label, on, change, colour) {
  const line = document.createElement('label');
  const box = document.createElement('input');
  box.type = 'checkbox';
  box.checked = on;
  box.addEventListener('change', () => change(box.checked));
  line.append(box);
  if (colour) {
    const dot = document.createElement('i');
    dot.style.background = css(colour.map((x) => Math.round(255 * x)));
    line.append(dot);
  }
  const text = document.createElement('span');
  text.textContent = label;
  line.append(text);
  parent.append(line);
  return box;
}

function describe(viewer) {
  const { head } = viewer.run;
  document.querySelector('h1').textContent = head.title;
  const facts = [];
  if (head.bodies.length > 1) facts.push(`${head.bodies.length} bodies`);
  facts.push(`${digits(head.frame_count > 1 ? (head.frame_count - 1) / head.frame_rate : 0)} s at ${digits(head.frame_rate)} frames a second`);
  const unfinished = { running: 'still running', interrupted: 'interrupted', failed: 'the solver gave up' }[head.status];
  if (unfinished) facts.push(`${unfinished}: ${head.frame_count} of ${head.last_frame + 1} frames`);
  element('facts').textContent = facts.join(' \u00b7 ');
  element('notes').hidden = head.notes.length === 0;
  element('notes').textContent = head.notes.join(' ');
  element('version').textContent = head.muslin;
}

export function makeControls(viewer) {
  const { clock, stage, bodies, annotations } = viewer;
  const updates = [];
  const changed = () => {
    for (const update of updates) update();
    viewer.refresh();
  };
  const then = (action) => (...values) => {
    action(...values);
    changed();
  };

  // Looks.
  updates.push(choice('surface', viewer.kinds, () => viewer.surface, then((kind) => viewer.setSurface(kind))));
  updates.push(choice('colouring', colourings, () => viewer.colouring, then((name) => viewer.setColouring(name))));
  updates.push(choice('preset', Object.keys(presets), () => '', then((name) => stage.setView(name))));
  updates.push(choice('up', ['y', 'z'], () => stage.up, then((up) => stage.setUp(up))));
  element('surface').closest('fieldset').hidden = viewer.kinds.length < 2;
  const shown = element('shown');
  const toggles = {
    edges: check(shown, 'Edges', false, then((on) => bodies.forEach((body) => body.showEdges(on)))),
    pins: annotations.pins.length && check(shown, 'Pins', true, then((on) => { annotations.pinsWanted = on; })),
    forces: annotations.forces.length && check(shown, 'Forces', true, then((on) => { annotations.forcesWanted = on; })),
    ground: check(shown, 'Ground', true, then((on) => stage.setGround(on))),
    turn: check(shown, 'Turntable', false, then((on) => { stage.controls.autoRotate = on; })),
  };
  const flip = (name) => toggles[name] && toggles[name].click();
  element('bodies-set').hidden = bodies.length < 2;
  for (const body of bodies) {
    check(element('bodies'), body.name, true, then((on) => { body.object.visible = on; }), body.colour);
  }

  // Panels.
  const panels = ['look', 'curves'];
  const narrow = () => matchMedia('(max-width: 640px)').matches;
  const layOut = () => {
    const open = panels.some((name) => !element(name).hidden);
    stage.insets = narrow()
      ? { left: 0, right: 0, top: 110, bottom: open ? 0.46 * innerHeight + 110 : 130 }
      : { left: 0, right: open ? 330 : 0, top: 60, bottom: 84 };
    stage.resize();
    stage.setView(stage.preset);
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
  const openHelp = () => element('help').showModal();
  element('open-help').addEventListener('click', openHelp);
  const changeTheme = then(() => viewer.setTheme(viewer.theme === 'dark' ? 'light' : 'dark'));
  element('theme').addEventListener('click', changeTheme);
  element('picture').addEventListener('click', () => viewer.savePicture());
  const fullScreen = () => (document.fullscreenElement ? document.exitFullscreen() : document.documentElement.requestFullscreen?.());
  element('fullscreen').addEventListener('click', fullScreen);

  // Time.
  const slider = element('time');
  slider.max = clock.frames.length - 1;
  slider.addEventListener('input', then(() => {
    const wasPlaying = clock.playing;
    clock.seekIndex(Number(slider.value));
    clock.playing = wasPlaying;
  }));
  const step = then((count) => clock.step(count));
  const toggle = then(() => clock.toggle());
  const changeSpeed = then((direction) => clock.changeSpeed(direction));
  const toggleLoop = then(() => { clock.loop = !clock.loop; });
  element('play').addEventListener('click', toggle);
  element('back').addEventListener('click', () => step(-1));
  element('on').addEventListener('click', () => step(1));
  element('speed').addEventListener('click', then(() => { clock.speed = clock.speed === 4 ? 0.1 : clock.speed; clock.changeSpeed(clock.speed === 0.1 ? 0 : 1); }));
  element('loop').addEventListener('click', toggleLoop);
  const frame = document.createElement('b');
  const seconds = document.createTextNode('');
  element('now').append(frame, seconds);
  const digitsOfRate = clock.frameRate >= 100 ? 3 : 2;
  const showTime = () => {
    slider.value = clock.index;
    const time = (clock.frame / clock.frameRate).toFixed(digitsOfRate);
    frame.textContent = `${clock.frame}`;
    seconds.textContent = ` / ${clock.frames[clock.frames.length - 1]} \u00b7 ${time} s`;
    slider.setAttribute('aria-valuetext', `frame ${clock.frame}, ${time} seconds`);
    document.body.classList.toggle('playing', clock.playing);
    element('play').setAttribute('aria-label', clock.playing ? 'Pause' : 'Play');
  };
  viewer.onMove = showTime;
  updates.push(showTime, () => {
    element('speed').textContent = `${clock.speed}\u00d7`;
    element('loop').setAttribute('aria-pressed', clock.loop);
  });

  // Keys.
  const surfaceKey = () => viewer.setSurface(viewer.kinds[(viewer.kinds.indexOf(viewer.surface) + 1) % viewer.kinds.length]);
  const colourKey = () => viewer.setColouring(colourings[(colourings.indexOf(viewer.colouring) + 1) % colourings.length]);
  const toEnd = then((index) => { clock.pause(); clock.seekIndex(index); });
  const keys = [
    [['Space', 'K'], 'play or pause', toggle],
    [['\u2190', '\u2192'], 'a frame back or on; with Shift ten', null],
    [['Home', 'End'], 'first or last frame', null],
    [[',', '.'], 'slower or faster', null],
    [['R'], 'again and again', toggleLoop],
    [['1', '\u2026', '5'], `views: ${Object.keys(presets).join(', ')}`, null],
    [['0'], 'fit the view', then(() => stage.setView(stage.preset))],
    [['M'], 'skin, contour, lattice', then(surfaceKey)],
    [['V'], 'colours: own, stretch, checker, texture', then(colourKey)],
    [['E', 'P', 'O', 'G'], 'edges, pins, forces, ground', null],
    [['T'], 'turntable', () => flip('turn')],
    [['U'], 'which axis is up', then(() => stage.setUp(stage.up === 'y' ? 'z' : 'y'))],
    [['L', 'C'], 'look, curves', null],
    [['D'], 'light or dark', changeTheme],
    [['S'], 'save a picture', () => viewer.savePicture()],
    [['F'], 'full screen', fullScreen],
    [['?'], 'these keys', openHelp],
  ];
  const list = document.querySelector('#help dl');
  for (const [caps, what] of keys) {
    const term = document.createElement('dt');
    for (const cap of caps) {
      const key = document.createElement('kbd');
      key.textContent = cap;
      term.append(key);
    }
    const text = document.createElement('dd');
    text.textContent = what;
    list.append(term, text);
  }
  const actions = {
    ' ': toggle, k: toggle, r: toggleLoop, t: () => flip('turn'), d: changeTheme, s: () => viewer.savePicture(),
    f: fullScreen, '?': openHelp, u: then(() => stage.setUp(stage.up === 'y' ? 'z' : 'y')),
    0: then(() => stage.setView(stage.preset)), m: then(surfaceKey), v: then(colourKey),
    e: () => flip('edges'), p: () => flip('pins'), o: () => flip('forces'), g: () => flip('ground'),
    l: () => openPanel('look'), c: () => openPanel('curves'),
    ',': () => changeSpeed(-1), '.': () => changeSpeed(1),
    Home: () => toEnd(0), End: () => toEnd(clock.frames.length - 1),
  };
  Object.keys(presets).forEach((name, i) => { actions[i + 1] = then(() => stage.setView(name)); });
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || element('help').open) return;
    const onButton = event.target instanceof HTMLButtonElement || event.target.type === 'checkbox';
    if (event.key === ' ' && onButton) return; // presses the button
    const arrow = { ArrowLeft: -1, ArrowRight: 1 }[event.key];
    const action = arrow ? () => step(arrow * (event.shiftKey ? 10 : 1)) : actions[event.key] ?? actions[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    action();
  });
  window.addEventListener('resize', () => {
    layOut();
    viewer.refresh();
  });

  describe(viewer);
  layOut();
  changed();
}
