// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

// What one can do with the page: choose, search, switch, step, link, follow.

const byName = id => document.getElementById(id);

// ---- selection and links

const kKinds = { s: 'node', e: 'edge', o: 'entity', p: 'prediction' };

// #node=s12&floor=1
function readHash() {
  const hash = new URLSearchParams(location.hash.slice(1));
  const id = Object.values(kKinds).map(kind => hash.get(kind)).find(Boolean);
  const floor = hash.get('floor');
  return { id: byId.has(id) ? id : null, floor: floor === null || floor === '' ? null : Number(floor) };
}

function writeHash() {
  const parts = [];
  if (state.selection) parts.push(kKinds[state.selection[0]] + '=' + state.selection);
  if (data.floors.length > 1) parts.push('floor=' + state.floor);
  const hash = parts.length ? '#' + parts.join('&') : location.pathname + location.search;
  try { history.replaceState(null, '', hash); } catch { location.hash = hash; }
}

function positionOf(thing) {
  if (thing.pose) return thing.pose;
  if (thing.from) {
    const [a, b] = [byId.get(thing.from).pose, byId.get(thing.to).pose];
    return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
  }
  const outline = thing.areas.length ? thing.areas[0].outline : [];
  return outline.length ? outline.reduce(([x, y], p) => [x + p[0] / outline.length, y + p[1] / outline.length], [0, 0]) : byId.get(thing.node).pose;
}

const floorOf = thing => thing.floor !== undefined ? thing.floor : thing.from ? byId.get(thing.from).floor : null;

// Whether the thing lies where no card hides it.
function inView(thing) {
  const free = freeArea();
  const p = map.latLngToContainerPoint(at(positionOf(thing)));
  return p.x > free.left && p.x < innerWidth - free.right && p.y > free.top && p.y < innerHeight - free.bottom;
}

// `centre`: true moves there, false stays, undefined moves only to what is out of sight.
function select(id, { centre, zoom, animate = true } = {}) {
  const thing = byId.get(id);
  state.selection = thing ? thing.id : null;
  byName('panel').hidden = !thing;
  document.body.classList.toggle('open', Boolean(thing));
  if (thing) {
    if (isPhone()) showLayers(false);
    const floor = floorOf(thing);
    if (floor !== null && floor !== state.floor && data.floors.some(known => known.number === floor)) setFloor(floor);
    fillPanel(thing);
    byName('spoken').textContent = byName('panel-body').querySelector('h2').textContent + ' selected';
    if (centre ?? !inView(thing)) centreOn(positionOf(thing), { zoom, animate });
  }
  writeHash();
  drawScene();
  remember();
}

// To the next sub-map, in the order in which the robot made them.
function step(by) {
  if (data.nodes.length === 0) return;
  const now = data.nodes.findIndex(node => node.id === state.selection);
  const next = now < 0 ? (by > 0 ? 0 : data.nodes.length - 1) : (now + by + data.nodes.length) % data.nodes.length;
  select(data.nodes[next].id);
}

// ---- floors

function setFloor(number) {
  state.floor = number;
  for (const choice of byName('floors').children) {
    const chosen = Number(choice.dataset.floor) === number;
    choice.setAttribute('aria-checked', chosen);
    choice.tabIndex = chosen ? 0 : -1;
  }
  drawScene();
}

function makeFloors() {
  const floors = byName('floors');
  floors.hidden = data.floors.length < 2;
  for (const floor of data.floors.slice().sort((a, b) => b.number - a.number)) {
    floors.append(element('button', {
      type: 'button', role: 'radio', 'data-floor': floor.number, 'aria-label': `Floor ${floor.number}`,
      title: `Floor ${floor.number}` + (floor.height === null ? '' : `, ${metres(floor.height, 1)}`),
      onclick: () => { setFloor(floor.number); writeHash(); remember(); },
    }, String(floor.number)));
  }
  floors.addEventListener('keydown', event => {
    const by = { ArrowUp: -1, ArrowLeft: -1, ArrowDown: 1, ArrowRight: 1 }[event.key];
    if (!by) return;
    event.preventDefault();
    const all = [...floors.children];
    const next = all[(all.indexOf(document.activeElement) + by + all.length) % all.length];
    next.focus();
    next.click();
  });
}

// ---- layers and legend

const swatch = inner => { const svg = icon(inner); svg.setAttribute('viewBox', '0 0 24 14'); svg.setAttribute('class', 'swatch'); return svg; };
const stroke = (name, dash = '') => `<path d="M2 7h20" style="stroke:var(--${name})" stroke-dasharray="${dash}"/>`;

function switchRows() {
  const entities = name => data.entities.filter(entity => (kEntitySwitches[entity.class] || 'entities') === name).length;
  return [
    ['plan', 'Walls and free space', '<rect x="3" y="1" width="18" height="12" rx="2" style="fill:var(--free);stroke:var(--wall)"/>'],
    ['places', 'Places in colour', '<circle cx="6" cy="7" r="4" style="fill:oklch(0.72 0.13 255);stroke:none"/><circle cx="13" cy="7" r="4" style="fill:oklch(0.75 0.13 32);stroke:none"/><circle cx="19" cy="7" r="4" style="fill:oklch(0.77 0.13 170);stroke:none"/>', data.totals.places],
    ...layerTypes.map(type => ['layer:' + type, words(type), [[5, 4], [9, 9], [13, 5], [17, 10], [20, 4]].map(([x, y]) => `<circle cx="${x}" cy="${y}" r="1.4" style="fill:var(--thing);stroke:none"/>`).join('')]),
    ['graph', 'Graph', '<path d="M6 10 18 4" style="stroke:var(--observed)"/><circle cx="5" cy="10" r="3" style="fill:var(--observed);stroke:none"/><circle cx="19" cy="4" r="3" style="fill:var(--observed);stroke:none"/>', data.nodes.length],
    ['labels', 'Labels', '<text x="12" y="11" text-anchor="middle" style="font:600 11px system-ui,sans-serif;fill:currentColor;stroke:none">s12</text>'],
    ['refined', 'Trajectory, refined', stroke('refined')],
    ['travelled', 'Trajectory, as travelled', stroke('travelled', '2 4')],
    ['doors', 'Doors', '<path d="M4 7h16" style="stroke:var(--door);stroke-width:4"/>', entities('doors')],
    ['stairs', 'Stairs', '<path d="M5 2h14v10H5zM9.7 2v10M14.3 2v10" style="stroke:var(--stairs);stroke-width:1.5"/>', entities('stairs')],
    ['entities', 'People and things', '<rect x="5" y="2" width="10" height="10" rx="1" style="stroke:var(--thing)"/><circle cx="19" cy="7" r="3" style="stroke:var(--human)"/>', entities('entities')],
    ['predictions', 'Predictions', '<circle cx="12" cy="7" r="5.5" stroke-dasharray="3 2.5" style="stroke:var(--predicted);fill:color-mix(in srgb, var(--predicted) 20%, transparent)"/>', data.predictions.length],
  ];
}

// Only what this map holds.
function graphLegend() {
  const dot = (name, hollow) => element('i', { class: 'dot' + (hollow ? ' hollow' : ''), style: `--c:var(--${name})` });
  const dash = (name, pattern) => { const svg = icon(stroke(name, pattern)); svg.setAttribute('viewBox', '0 0 24 14'); return svg; };
  const has = kind => data.edges.some(edge => edge.kind === kind);
  return element('div', { class: 'legend' }, [
    element('span', {}, dot('observed'), 'observed'),
    data.nodes.some(node => node.kind === 'predicted') && element('span', {}, dot('predicted', true), 'predicted'),
    has('loop') && element('span', {}, dash('loop', '2 4'), 'loop closure'),
    has('overlap') && element('span', {}, dash('overlap', '1 4'), 'overlap, no way'),
    has('door') && element('span', {}, dash('door'), 'through a door'),
    (has('stairs') || has('lift')) && element('span', {}, dash('stairs'), has('lift') ? 'stairs, lift' : 'stairs'),
  ]);
}

function makeSwitches() {
  for (const [name, label, picture, count] of switchRows()) {
    const input = element('input', { type: 'checkbox', role: 'switch', 'data-switch': name });
    input.checked = state.on[name];
    input.addEventListener('change', () => { state.on[name] = input.checked; drawScene(); remember(); });
    byName('switches').append(element('label', { class: 'switch' + (count === 0 ? ' bare' : '') },
      swatch(picture), element('span', { class: 'name' }, label), count !== undefined && element('span', { class: 'count' }, count === 0 ? 'none' : number(count)), input));
    if (name === 'graph' && data.nodes.length > 0) byName('switches').append(graphLegend());
  }
}

function showLayers(shown) {
  document.body.classList.toggle('layers', shown);
  byName('layers-button').setAttribute('aria-expanded', shown);
}

// ---- header

function makeHeader() {
  const { totals } = data;
  byName('title').textContent = data.title;
  byName('title').title = data.title;
  const rows = [
    [number(totals.submaps), totals.submaps === 1 ? 'sub-map' : 'sub-maps'],
    totals.places > 1 && [number(totals.places), 'places'],
    data.floors.length > 1 && [number(data.floors.length), 'floors'],
    [metres(totals.distance, totals.distance < 100 ? 1 : 0), 'travelled', 'plain'],
    [number(totals.area, totals.area < 100 ? 1 : 0) + ' m²', 'free floor', 'plain'],
  ];
  byName('totals').append(...rows.filter(Boolean).map(([amount, name, look]) => element('div', { class: look }, element('dt', {}, name), element('dd', {}, amount))));
  const sessions = data.sessions.map(session => [session.kind, session.poses && `poses: ${session.poses}`].filter(Boolean).join(', '));
  byName('credit').textContent = [...new Set(sessions)].concat(`prodomos ${data.version}`, 'Leaflet').join(' · ');
  byName('empty').hidden = data.nodes.length > 0;
}

// ---- search

const searchIndex = once(() => things.map(thing => {
  const detail = thing.class ? words(thing.class).toLowerCase() + ' in ' + thing.submap
    : thing.from ? `${thing.kind}, ${thing.from} – ${thing.to}`
    : thing.probability !== undefined ? `prediction, ${thing.state}`
    : [thing.kind === 'predicted' ? 'predicted sub-map' : 'sub-map', placeName(thing.place), floorName(thing.floor)].filter(Boolean).join(', ');
  return { thing, detail, text: `${thing.id} ${detail}`.toLowerCase() };
}));

function search(typed) {
  const query = typed.trim().toLowerCase();
  if (!query) return [];
  const rank = ({ thing, text }) => thing.id === query || thing.id === 's' + query ? 0 : thing.id.startsWith(query) ? 1 : text.includes(query) ? 2 : 3;
  return searchIndex().map(entry => ({ ...entry, rank: rank(entry) })).filter(entry => entry.rank < 3)
    .sort((a, b) => a.rank - b.rank).slice(0, 30);
}

function makeSearch() {
  const [input, list] = [byName('search'), byName('found')];
  let hits = [];
  let chosen = 0;
  const mark = () => [...list.children].forEach((item, i) => {
    item.setAttribute('aria-selected', i === chosen && hits.length > 0);
    if (i === chosen && hits.length) { input.setAttribute('aria-activedescendant', item.id); item.scrollIntoView({ block: 'nearest' }); }
  });
  const close = () => { list.hidden = true; input.setAttribute('aria-expanded', false); input.removeAttribute('aria-activedescendant'); };
  const take = hit => { input.value = ''; close(); input.blur(); select(hit.thing.id, { centre: true }); };
  const open = () => {
    hits = search(input.value);
    chosen = 0;
    list.replaceChildren(...hits.map((hit, i) => element('li', { role: 'option', id: 'found-' + i, onpointerdown: event => { event.preventDefault(); }, onclick: () => take(hit) },
      element('i', { class: 'dot' + (hit.thing.kind === 'predicted' ? ' hollow' : hit.thing.class ? ' square' : ''), style: '--c:' + colorOf(hit.thing) }),
      element('b', {}, hit.thing.id), element('span', {}, hit.detail))));
    if (hits.length === 0) list.append(element('li', { class: 'none' }, 'Nothing of that name'));
    list.hidden = !input.value.trim();
    input.setAttribute('aria-expanded', !list.hidden);
    mark();
  };
  input.addEventListener('input', open);
  input.addEventListener('focus', open);
  input.addEventListener('blur', close);
  input.addEventListener('keydown', event => {
    if (event.key === 'Enter' && hits[chosen]) take(hits[chosen]);
    else if (event.key === 'Escape') { input.value = ''; close(); input.blur(); }
    else if (event.key === 'ArrowDown' || event.key === 'ArrowUp') {
      chosen = (chosen + (event.key === 'ArrowDown' ? 1 : -1) + hits.length) % (hits.length || 1);
      mark();
    } else return;
    event.preventDefault();
    event.stopPropagation();
  });
}

// ---- pointer and keys

function makePointer() {
  const touch = matchMedia('(pointer: coarse)').matches;
  map.on('click', event => {
    const thing = pick(event.latlng, touch ? 18 : 8);
    select(thing ? thing.id : null);
  });
  const hint = L.tooltip({ direction: 'top', offset: [0, -12], opacity: 1, interactive: false });
  map.on('mousemove', event => {
    const thing = touch ? null : pick(event.latlng, 6);
    byName('map').classList.toggle('pointing', Boolean(thing));
    if (!thing) { hint.remove(); return; }
    const kind = thing.class || (thing.from ? thing.kind + ' edge' : thing.probability !== undefined ? 'prediction' : placeName(thing.place) || '');
    hint.setLatLng(thing.from || thing.areas ? event.latlng : at(positionOf(thing))).setContent(element('div', {}, thing.id, element('span', {}, kind.replace('_', ' ')))).addTo(map);
  });
  map.on('mouseout zoomstart', () => hint.remove());
  map.on('zoomend', () => {
    byName('map').classList.toggle('crisp', map.getZoom() > 5.2);
    drawScene();
  });
  map.on('moveend', remember);
  byName('zoom-in').addEventListener('click', () => map.zoomIn());
  byName('zoom-out').addEventListener('click', () => map.zoomOut());
  byName('fit').addEventListener('click', () => fit());
  byName('layers-button').addEventListener('click', () => showLayers(!document.body.classList.contains('layers')));
}

function makeKeys() {
  addEventListener('keydown', event => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    if (event.key === 'Escape') { showLayers(false); select(null); byName('map').focus(); return; }
    if (event.target.matches('input[type=text]')) return;
    const action = { f: () => fit(), '/': () => byName('search').focus(), '[': () => step(-1), ']': () => step(1) }[event.key];
    if (!action) return;
    event.preventDefault();
    action();
  });
}

// A phone's sheet: drag the grip to size it, far down to close it.
function makeSheet() {
  const [panel, grip] = [byName('panel'), document.querySelector('.grip')];
  grip.addEventListener('pointerdown', event => {
    grip.setPointerCapture(event.pointerId);
    panel.classList.add('dragged');
    const from = event.clientY;
    const height = panel.offsetHeight;
    const move = moved => document.documentElement.style.setProperty('--sheet', Math.max(80, Math.min(innerHeight * 0.88, height + from - moved.clientY)) + 'px');
    const stop = () => {
      grip.removeEventListener('pointermove', move);
      panel.classList.remove('dragged');
      if (panel.offsetHeight < 130) { document.documentElement.style.removeProperty('--sheet'); select(null); }
    };
    grip.addEventListener('pointermove', move);
    grip.addEventListener('pointerup', stop, { once: true });
    grip.addEventListener('pointercancel', stop, { once: true });
  });
}

// ---- following a map that is being written: the page loads itself anew and looks as before

const kMemory = 'prodomos ' + location.pathname;

function remember() {
  if (!data.followSeconds) return;
  try {
    sessionStorage.setItem(kMemory, JSON.stringify({ centre: map.getCenter(), zoom: map.getZoom(), floor: state.floor, selection: state.selection, on: state.on,
      layers: document.body.classList.contains('layers'), paused: byName('live').getAttribute('aria-pressed') === 'true' }));
  } catch { /* a browser without storage follows, but forgets its view */ }
}

function remembered() {
  if (!data.followSeconds) return null;
  try { return JSON.parse(sessionStorage.getItem(kMemory)); } catch { return null; }
}

function follow(memory) {
  if (!data.followSeconds) return;
  const live = byName('live');
  let held = false;
  const show = paused => { live.setAttribute('aria-pressed', paused); live.textContent = paused ? 'paused' : 'live'; live.title = paused ? 'Follow the map again' : 'Stop following the map'; };
  show(Boolean(memory && memory.paused));
  live.hidden = false;
  live.addEventListener('click', () => { show(live.getAttribute('aria-pressed') !== 'true'); remember(); });
  addEventListener('pointerdown', () => { held = true; });
  for (const end of ['pointerup', 'pointercancel']) addEventListener(end, () => { held = false; });
  setInterval(() => {
    const busy = held || document.hidden || document.activeElement === byName('search') || live.getAttribute('aria-pressed') === 'true';
    if (!busy) { remember(); location.reload(); }
  }, data.followSeconds * 1000);
}

// ---- start

function start() {
  readColors();
  const memory = remembered();
  if (memory) Object.assign(state.on, memory.on);
  makeHeader();
  makeFloors();
  makeSwitches();
  makeSearch();
  makePointer();
  makeKeys();
  makeSheet();
  const linked = readHash();
  if (linked.floor !== null && data.floors.some(floor => floor.number === linked.floor)) state.floor = linked.floor;
  else if (memory && data.floors.some(floor => floor.number === memory.floor)) state.floor = memory.floor;
  fit(false);
  painting.addTo(map);
  setFloor(state.floor);
  showLayers(Boolean(memory && memory.layers));
  if (memory) map.setView(memory.centre, memory.zoom, { animate: false });
  if (linked.id) select(linked.id, memory ? { centre: false } : { centre: true, zoom: Math.max(map.getZoom(), 4.5), animate: false });
  addEventListener('hashchange', () => {
    const { id, floor } = readHash();
    if (floor !== null && data.floors.some(known => known.number === floor)) setFloor(floor);
    select(id, { centre: true });
  });
  matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => { readColors(); drawScene(); if (state.selection) fillPanel(byId.get(state.selection)); });
  follow(memory);
}

start();
