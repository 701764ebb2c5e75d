// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

// The panel: what the selected thing holds. All text goes through textContent, so that no name from a log is markup.

function element(tag, attributes = {}, ...children) {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) {
    if (name.startsWith('on')) made.addEventListener(name.slice(2), value);
    else if (value !== null && value !== undefined && value !== false) made.setAttribute(name, value);
  }
  made.append(...children.flat(Infinity).filter(child => child !== null && child !== undefined && child !== false));
  return made;
}

function icon(paths) {
  const svg = document.createElementNS('http://www.w3.org/2000/svg', 'svg');
  svg.setAttribute('viewBox', '0 0 24 24');
  svg.setAttribute('aria-hidden', 'true');
  svg.innerHTML = paths;  // constants of this page only
  return svg;
}
const kIcons = {
  node: '<circle cx="12" cy="12" r="6.5"/><path d="M12 5.5V2M12 22v-3.5M2 12h3.5M18.5 12H22"/>',
  predicted: '<circle cx="12" cy="12" r="8" stroke-dasharray="4 3.5"/>',
  edge: '<circle cx="5" cy="18" r="2.5"/><circle cx="19" cy="6" r="2.5"/><path d="m7 16.2 10-8.4"/>',
  door: '<path d="M6 21V4.5A1.5 1.5 0 0 1 7.5 3h9A1.5 1.5 0 0 1 18 4.5V21M3 21h18M14.5 12v1"/>',
  staircase: '<path d="M3 20h4.5v-4.5H12V11h4.5V6.5H21"/>',
  human: '<circle cx="12" cy="6" r="3"/><path d="M6 21v-4a6 6 0 0 1 12 0v4"/>',
  thing: '<path d="m12 3 8 4.5v9L12 21l-8-4.5v-9zM4 7.5l8 4.5 8-4.5M12 12v9"/>',
  previous: '<path d="m14 6-6 6 6 6"/>',
  next: '<path d="m10 6 6 6-6 6"/>',
  close: '<path d="m6 6 12 12M18 6 6 18"/>',
};

// ---- words and numbers

const words = name => { const text = name.replace(/_/g, ' ').replace(/([a-z])([A-Z])/g, (_, a, b) => a + ' ' + b.toLowerCase()); return text[0].toUpperCase() + text.slice(1); };
const number = (value, digits = 2) => Number(value).toLocaleString('en', { maximumFractionDigits: digits, useGrouping: Math.abs(value) >= 1e4 }).replace(/,/g, '\u202f');
const metres = (value, digits = 2) => Math.abs(value) >= 10000 ? number(value / 1000, 1) + ' km' : number(value, digits) + ' m';
const degrees = radians => number(radians * 180 / Math.PI, 1) + '°';
const plural = (count, one, many = one + 's') => number(count) + ' ' + (count === 1 ? one : many);
const percent = share => Math.round(share * 100) + ' %';

function duration(seconds) {
  if (seconds < 90) return number(seconds, seconds < 10 ? 1 : 0) + ' s';
  const minutes = Math.round(seconds / 60);
  return minutes < 90 ? minutes + ' min' : Math.floor(minutes / 60) + ' h ' + minutes % 60 + ' min';
}

// Stamps before 1980 are those of a log that starts at zero.
function clock(seconds) {
  if (seconds < 315532800) return number(seconds, 1) + ' s';
  return new Date(seconds * 1000).toISOString().slice(0, 19).replace('T', ' ');
}

function span(begin, end) {
  const [first, last] = [clock(begin), clock(end)];
  const sameDay = first.length === 19 && first.slice(0, 10) === last.slice(0, 10);
  return sameDay ? [first.slice(0, 10), element('br'), `${first.slice(11)} – ${last.slice(11)}`] : `${first} – ${last}`;
}

const kUnits = { width: 'm', height: 'm', step_width: 'm', step_height: 'm', step_depth: 'm', size: 'm', velocity: 'm/s', area: 'm²' };

function value(thing) {
  if (Array.isArray(thing)) return thing.map(part => typeof part === 'number' ? number(part) : value(part)).join(', ');
  if (typeof thing === 'number') return number(thing, 3);
  if (typeof thing === 'boolean') return thing ? 'yes' : 'no';
  return thing === null ? '–' : typeof thing === 'object' ? JSON.stringify(thing) : String(thing);
}

// ["Step width", "0.9 m"].
const attribute = ([name, held]) => [words(name), value(held) + (kUnits[name] ? ' ' + kUnits[name] : '')];

// ---- parts

const facts = rows => element('dl', { class: 'facts' }, rows.filter(row => row && row[1] !== null && row[1] !== undefined && row[1] !== '')
  .map(([name, text]) => [element('dt', {}, name), element('dd', {}, ...[text].flat())]));

const part = (title, ...children) => element('section', {}, element('h3', {}, title), ...children);

function link(thing, detail, end) {
  return element('li', {}, element('button', { type: 'button', 'data-id': thing.id, onclick: () => select(thing.id, { centre: true }) },
    element('i', { class: 'dot' + (thing.kind === 'predicted' ? ' hollow' : thing.class ? ' square' : ''), style: '--c:' + colorOf(thing) }),
    element('b', {}, thing.id), element('span', {}, detail), end ? element('span', { class: 'end' }, end) : null));
}
const links = items => element('ul', { class: 'links' }, items);

function colorOf(thing) {
  if (thing.class) return entityColor(thing);
  if (thing.from) return edgeColor(thing);
  if (thing.probability !== undefined) return colors.predicted;
  return nodeColor(thing);
}

const button = (label, picture, action) => element('button', { type: 'button', class: 'icon small', 'aria-label': label, title: label, onclick: action }, icon(picture));

function head(thing, title, subtitle, picture, steps = false) {
  return element('div', { class: 'head' },
    element('span', { class: 'mark', style: '--c:' + colorOf(thing) }, icon(picture)),
    element('div', {}, element('h2', {}, title), element('p', {}, subtitle)),
    steps && button('Previous sub-map', kIcons.previous, () => step(-1)),
    steps && button('Next sub-map', kIcons.next, () => step(1)),
    button('Close', kIcons.close, () => select(null)));
}

const placeName = place => place === null ? null : 'place ' + place;
const floorName = floor => floor === null ? null : 'floor ' + floor;

function pose([x, y, z, yaw]) {
  return `${number(x)}, ${number(y)}${Math.abs(z) >= 0.005 ? ', ' + number(z) : ''} m, ${degrees(yaw)}`;
}

let thumbUrl = null;

// The sub-map's own grid, its x-axis up.
function thumbnail(node) {
  if (!node.thumb) return null;
  if (thumbUrl) URL.revokeObjectURL(thumbUrl);
  thumbUrl = imageUrl(withPalette(node.thumb.png, planPalette(false)));
  const [height, width] = node.thumb.size;
  const [x, y] = node.thumb.corner;
  const box = Math.min(152 / height, 290 / width);
  const robot = icon('<path d="M12 1 21 22 12 17 3 22z"/>');
  robot.setAttribute('class', 'robot');
  robot.style.left = 100 * (1 + y / width) + '%';
  robot.style.top = 100 * (1 + x / height) + '%';
  return element('figure', { class: 'thumb', style: 'margin-inline:0' },
    element('div', { class: 'sheet', style: `width:${width * box}px;height:${height * box}px` },
      element('img', { src: thumbUrl, alt: `Grid of ${node.id}, seen from above, its heading up` }), robot),
    element('figcaption', {}, `${number(height, 0)} × ${number(width, 0)} m`));
}

// ---- one panel for each kind of thing

function nodePanel(node) {
  const predicted = node.kind === 'predicted';
  const entities = data.entities.filter(entity => entity.submap === node.id);
  const predictions = data.predictions.filter(prediction => prediction.node === node.id || prediction.mergedInto === node.id);
  return [
    head(node, node.id, [predicted ? 'Predicted sub-map' : 'Sub-map', placeName(node.place), floorName(node.floor)].filter(Boolean).join(' · '),
      predicted ? kIcons.predicted : kIcons.node, true),
    thumbnail(node),
    facts([
      ['Pose', pose(node.pose)],
      !predicted && ['Time', span(node.begin, node.end)],
      !predicted && ['Took', duration(node.end - node.begin)],
      !predicted && ['Distance', metres(node.distance)],
      !predicted && ['Readings', number(node.readings)],
      node.moved > 0.005 && ['Moved by refinement', metres(node.moved)],
      ['Session', sessionName(node.session)],
    ]),
    part('Neighbours', links(neighboursOf(node.id).map(({ node: other, edge }) => link(other, neighbourText(node, other, edge), metres(edge.length, 1))))),
    predictions.length > 0 && part('Predictions', links(predictions.map(prediction => link(prediction, prediction.state, percent(prediction.probability))))),
    entities.length > 0 && part('Entities', links(entities.map(entity => link(entity, words(entity.class).toLowerCase(), percent(entity.confidence))))),
    node.layers.length > 0 && part('Layers', node.layers.map(layer => [element('p', { class: 'sub' }, words(layer.type)),
      layer.fault ? element('p', {}, layer.fault) : facts(layer.summary.map(([name, text]) => [words(name), text]))])),
  ];
}

const neighbourText = (node, other, edge) => [edge.kind, other.floor !== node.floor && floorName(other.floor)].filter(Boolean).join(' · ');

function sessionName(id) {
  const session = data.sessions.find(candidate => candidate.id === id);
  return session ? `${id} · ${session.log}` : id;
}

function edgePanel(edge) {
  const cause = byId.get(edge.cause);
  return [
    head(edge, edge.id, words(edge.kind) + ' edge', kIcons.edge),
    facts([
      ['Length', metres(edge.length)],
      ['Transform', pose(edge.transform)],
      edge.sigma && ['Standard deviation', `${metres(edge.sigma[0], 3)}, ${metres(edge.sigma[1], 3)}, ${degrees(edge.sigma[2])}`],
    ]),
    part('Joins', links([edge.from, edge.to].map(id => byId.get(id)).map(node => link(node, [placeName(node.place), floorName(node.floor)].filter(Boolean).join(' · '))))),
    cause && part('Through', links([link(cause, words(cause.class).toLowerCase())])),
  ];
}

function entityPanel(entity) {
  const predictions = data.predictions.filter(prediction => prediction.cause === entity.id);
  const submap = byId.get(entity.submap);
  return [
    head(entity, words(entity.class), `${entity.id} · ${words(entity.mobility).toLowerCase()}`, kIcons[entity.class] || kIcons.thing),
    facts([
      ['Pose', pose(entity.pose)],
      ['Confidence', percent(entity.confidence)],
      ['Seen', plural(entity.observations, 'time')],
      ['Between', span(entity.firstSeen, entity.lastSeen)],
      ...Object.entries(entity.attributes).filter(([, held]) => !Array.isArray(held) || held.length < 4).map(attribute),
    ]),
    predictions.length > 0 && part('Predicts', links(predictions.map(prediction => link(prediction, prediction.state, percent(prediction.probability))))),
    submap && part('Held by', links([link(submap, placeName(submap.place))])),
  ];
}

function predictionPanel(prediction) {
  const things = [prediction.node, prediction.cause, prediction.mergedInto].map(id => byId.get(id)).filter(Boolean);
  return [
    head(prediction, prediction.id, `Prediction · ${prediction.state}`, kIcons.predicted),
    element('div', { class: 'meter', role: 'img', 'aria-label': 'Probability ' + percent(prediction.probability) },
      element('i', { style: `width:${100 * prediction.probability}%` })),
    facts([
      ['Probability', percent(prediction.probability)],
      ['Expected area', number(prediction.expectedArea, 1) + ' m²'],
      ['Made', clock(prediction.made)],
      prediction.settled !== null && ['Settled', clock(prediction.settled)],
    ]),
    part('Belongs to', links(things.map(thing => link(thing, thing.class ? words(thing.class).toLowerCase() : thing.kind)))),
  ];
}

function fillPanel(thing) {
  const make = { s: nodePanel, e: edgePanel, o: entityPanel, p: predictionPanel }[thing.id[0]];
  const body = document.getElementById('panel-body');
  body.replaceChildren(...make(thing).filter(Boolean));
  body.scrollTop = 0;
}
