// The keys of the keyboard: their actions, and the list that explains them.

/** [what the list shows, what it says, {key: action}] */
export function keyTable(act) {
  const view = (name) => () => act.view(name);
  return [
    [['Space'], 'play or pause', { ' ': act.toggle, k: act.toggle }],
    [['\u2190', '\u2192'], 'a frame back or on; ten with Shift', { ArrowLeft: () => act.step(-1), ArrowRight: () => act.step(1) }],
    [['Home', 'End'], 'first or last frame', { Home: act.first, End: act.last }],
    [[',', '.'], 'slower or faster', { ',': act.slower, '.': act.faster }],
    [['R'], 'again and again', { r: act.loop }],
    [['1', '2', '3', '4', '5'], 'view from three quarters, front, side, back, top',
      { 1: view('three-quarter'), 2: view('front'), 3: view('side'), 4: view('back'), 5: view('top') }],
    [['M'], 'skin, contour or lattice', { m: act.nextSurface }],
    [['V'], 'colours: plain, stretch, checker, UV', { v: act.nextColouring }],
    [['E', 'P', 'O', 'G'], 'edges, pins, forces, ground', { e: act.edges, p: act.pins, o: act.forces, g: act.ground }],
    [['T'], 'turntable', { t: act.turntable }],
    [['U'], 'which axis is up', { u: act.up }],
    [['L', 'C'], 'look, curves', { l: act.look, c: act.curves }],
    [['D'], 'light or dark', { d: act.theme }],
    [['S'], 'save a picture', { s: act.picture }],
    [['F'], 'full screen', { f: act.fullScreen }],
    [['?'], 'these keys', { '?': act.help }],
  ];
}

/** Listens for the keys of the table and lists them in `list`, a <dl>. */
export function listen(table, list, blocked) {
  const actions = {};
  for (const [caps, words, some] of table) {
    Object.assign(actions, some);
    const term = document.createElement('dt');
    for (const cap of caps) {
      const key = document.createElement('kbd');
      key.textContent = cap;
      term.append(key);
    }
    const description = document.createElement('dd');
    description.textContent = words;
    list.append(term, description);
  }
  window.addEventListener('keydown', (event) => {
    if (event.ctrlKey || event.metaKey || event.altKey || blocked()) return;
    const control = event.target instanceof HTMLButtonElement || event.target.type === 'checkbox';
    if (event.key === ' ' && control) return; // presses what has the focus
    const action = actions[event.key] ?? actions[event.key.toLowerCase()];
    if (!action) return;
    event.preventDefault();
    const times = event.shiftKey && event.key.startsWith('Arrow') ? 10 : 1;
    for (let i = 0; i < times; ++i) action();
  });
}
