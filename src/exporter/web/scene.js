// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

// The plan: images of the floor below, one canvas with everything else above. Leaflet pans and zooms; metres are its
// coordinates (x = lng, y = lat).

const at = ([x, y]) => L.latLng(y, x);
const onFloor = thing => thing.floor === null || state.floor === null || thing.floor === state.floor;

const map = L.map('map', {
  crs: L.CRS.Simple, attributionControl: false, zoomControl: false, zoomSnap: 0, zoomDelta: 0.75, minZoom: -3, maxZoom: 8,
  wheelPxPerZoomLevel: 110, keyboardPanDelta: 110, inertia: true, maxBoundsViscosity: 0.6,
});
map.createPane('plan').style.zIndex = 250;
L.control.scale({ imperial: false, maxWidth: 120 }).addTo(map);

// One path that paints all vectors, in layer pixels.
const Painting = L.Path.extend({
  initialize(options) { L.setOptions(this, options); },
  _project() { this._pxBounds = this._renderer._bounds; },
  _update() { this._updatePath(); },
  _updatePath() {
    if (!this._map || !this._renderer._drawing) return;
    const scale = map.options.crs.scale(map.getZoom());
    const origin = map.getPixelOrigin();
    paint(this._renderer._ctx, scale, ([x, y]) => [x * scale - origin.x, -y * scale - origin.y]);
  },
});
const painting = new Painting({ interactive: false, renderer: L.canvas({ padding: 0.3 }) });

const images = new Map();  // by name: {overlay, url, palette}

function showImage(name, image, palette) {
  const shown = images.get(name);
  if (shown && shown.palette === palette) return shown.overlay.addTo(map);
  if (shown) { shown.overlay.remove(); URL.revokeObjectURL(shown.url); }
  const url = imageUrl(palette ? withPalette(image.png, JSON.parse(palette)) : decodeBase64(image.png));
  const [x, y] = image.corner;
  const overlay = L.imageOverlay(url, [at([x, y]), at([x + image.size[0], y + image.size[1]])], { pane: 'plan', alt: '' });
  images.set(name, { overlay, url, palette });
  return overlay.addTo(map);
}

// Whether cells are so small on the screen that the overview shows more of the walls.
const seenFromAfar = floor => Boolean(floor.overview) && map.options.crs.scale(map.getZoom()) * floor.plan.pixel < 0.7;

function drawScene() {
  const palette = JSON.stringify(planPalette(state.on.places));
  const wanted = new Set();
  data.floors.forEach((floor, index) => {
    if (state.floor !== null && floor.number !== state.floor) return;
    if (floor.plan && state.on.plan) {
      const coarse = seenFromAfar(floor);
      const name = (coarse ? 'overview' : 'plan') + index;
      wanted.add(name);
      showImage(name, coarse ? floor.overview : floor.plan, palette);
    }
    for (const layer of floor.layers) {
      const name = layer.type + index;
      if (layer.image && state.on['layer:' + layer.type]) { wanted.add(name); showImage(name, layer.image, null); }
    }
  });
  for (const [name, { overlay }] of images) if (!wanted.has(name)) overlay.remove();
  painting.redraw();
}

// ---- painting

let nodeRadius = 8;

function paint(ctx, scale, px) {
  const length = medianEdgeLength() * scale;
  nodeRadius = Math.max(3, Math.min(8.5, length * 0.26));
  ctx.lineJoin = ctx.lineCap = 'round';
  paintLayers(ctx, scale, px);
  paintTrajectories(ctx, px);
  paintTrails(ctx, px);
  paintSelectedArea(ctx, px);
  if (state.on.predictions) for (const prediction of data.predictions.filter(onFloor)) paintPrediction(ctx, px, prediction);
  if (state.on.graph) paintEdges(ctx, px);
  for (const entity of data.entities.filter(onFloor)) if (entityShown(entity)) paintEntity(ctx, px, entity);
  if (state.on.graph) paintNodes(ctx, px);
}

const medianEdgeLength = once(() => {
  const lengths = data.edges.map(edge => edge.length).sort((a, b) => a - b);
  return lengths.length ? Math.max(0.5, lengths[lengths.length >> 1]) : 5;
});

function line(ctx, px, points, color, width, dash = []) {
  ctx.beginPath();
  points.forEach((point, i) => ctx[i ? 'lineTo' : 'moveTo'](...px(point)));
  ctx.strokeStyle = color;
  ctx.lineWidth = width;
  ctx.setLineDash(dash);
  ctx.stroke();
  ctx.setLineDash([]);
}

function paintLayers(ctx, scale, px) {
  for (const floor of data.floors) {
    if (state.floor !== null && floor.number !== state.floor) continue;
    for (const layer of floor.layers) {
      if (!state.on['layer:' + layer.type]) continue;
      for (const shape of layer.shapes) line(ctx, px, shape.points, shape.color, 1.5);
    }
  }
}

function paintTrajectories(ctx, px) {
  for (const piece of data.trajectory.filter(onFloor)) {
    if (state.on.travelled) line(ctx, px, piece.travelled, colors.travelled, 1.5, [2, 4]);
    if (state.on.refined) line(ctx, px, piece.refined, colors.refined, 1.75);
  }
}

function paintTrails(ctx, px) {
  if (!state.on.entities) return;
  ctx.globalAlpha = 0.7;
  for (const trail of data.trails.filter(onFloor)) line(ctx, px, trail.points, colors.human, 2, [1, 4]);
  ctx.globalAlpha = 1;
}

// What the selected sub-map saw, framed.
function paintSelectedArea(ctx, px) {
  const node = byId.get(state.selection);
  if (!node || !node.outline || !onFloor(node)) return;
  ctx.globalAlpha = 0.09;
  ctx.fillStyle = colors.observed;
  line(ctx, px, node.outline.concat([node.outline[0]]), 'transparent', 1);
  ctx.fill();
  ctx.globalAlpha = 0.55;
  line(ctx, px, node.outline.concat([node.outline[0]]), colors.observed, 1.25, [5, 4]);
  ctx.globalAlpha = 1;
}

function paintPrediction(ctx, px, prediction) {
  const settled = prediction.state !== 'open';
  const color = byId.get(prediction.cause)?.class === 'human' ? colors.human : colors.predicted;
  for (const area of prediction.areas) {
    if (area.outline.length < 3) continue;
    line(ctx, px, area.outline.concat([area.outline[0]]), color, prediction.id === state.selection ? 2.5 : 1.25, [6, 4]);
    ctx.globalAlpha = settled ? 0.05 : 0.13;
    ctx.fillStyle = color;
    ctx.fill();
    ctx.globalAlpha = 1;
  }
}

function paintEdges(ctx, px) {
  for (const edge of data.edges) {
    const [from, to] = [byId.get(edge.from), byId.get(edge.to)];
    const shown = onFloor(from) || onFloor(to);
    if (!shown) continue;
    const predicted = from.kind === 'predicted' || to.kind === 'predicted';
    const dash = predicted ? [5, 5] : edge.kind === 'loop' ? [2, 4] : edge.kind === 'overlap' ? [1, 4] : [];
    const width = edge.kind === 'overlap' ? 1 : Math.max(1.25, nodeRadius * 0.28);
    const points = [from.pose, to.pose];
    if (edge.id === state.selection) {
      ctx.globalAlpha = 0.35;
      line(ctx, px, points, edgeColor(edge), width + 10);
      ctx.globalAlpha = 1;
    }
    line(ctx, px, points, colors.halo, width + 2);
    line(ctx, px, points, predicted && edge.kind === 'travelled' ? colors.predicted : edgeColor(edge),
         edge.id === state.selection ? width + 2.5 : width, dash);
  }
}

const entityShown = entity => state.on[kEntitySwitches[entity.class] || 'entities'];

function paintEntity(ctx, px, entity) {
  const color = entityColor(entity);
  const isDoor = entity.class === 'door';
  const width = isDoor ? 4 : 2;
  const dash = isDoor && !entity.attributes.has_leaf ? [2, 6] : [];
  if (entity.id === state.selection) {
    ctx.globalAlpha = 0.35;
    for (const points of entity.shape) line(ctx, px, points, color, width + 9);
    ctx.globalAlpha = 1;
  }
  entity.shape.forEach((points, part) => {
    const swing = isDoor && part > 0;  // the way of its leaf
    if (!swing) line(ctx, px, points, colors.halo, width + 2);
    line(ctx, px, points, color, swing ? 1.25 : width, dash);
  });
}

function paintNodes(ctx, px) {
  const nodes = data.nodes.filter(node => onFloor(node) || node.id === state.selection);
  const reachable = new Set();  // ends of stairs on another floor, shown as ghosts
  for (const edge of data.edges) {
    const [from, to] = [byId.get(edge.from), byId.get(edge.to)];
    if (onFloor(from) && !onFloor(to)) reachable.add(to);
    if (onFloor(to) && !onFloor(from)) reachable.add(from);
  }
  for (const node of reachable) paintNode(ctx, px(node.pose), node, true);
  for (const node of nodes) if (onFloor(node)) paintNode(ctx, px(node.pose), node, false);
  if (state.on.labels) paintLabels(ctx, px, nodes.filter(onFloor));
  const selected = byId.get(state.selection);
  if (selected && selected.pose && selected.kind && !selected.class && onFloor(selected)) {
    ctx.beginPath();
    ctx.arc(...px(selected.pose), nodeRadius + 6, 0, 2 * Math.PI);
    ctx.strokeStyle = colors.ink;
    ctx.lineWidth = 2.25;
    ctx.stroke();
  }
}

const nodeColor = node => colors[node.kind === 'predicted' ? 'predicted' : 'observed'];

// A disc with a beak where its x-axis points.
function paintNode(ctx, [x, y], node, ghost) {
  const r = nodeRadius;
  const color = nodeColor(node);
  const predicted = node.kind === 'predicted';
  ctx.globalAlpha = ghost ? 0.45 : 1;
  ctx.beginPath();
  if (r > 4.5 && !predicted && !ghost) {
    const yaw = -node.pose[3];
    ctx.arc(x, y, r, yaw + 0.5, yaw + 2 * Math.PI - 0.5);
    ctx.lineTo(x + r * 1.5 * Math.cos(yaw), y + r * 1.5 * Math.sin(yaw));
    ctx.closePath();
  } else {
    ctx.arc(x, y, predicted ? r + 0.5 : r, 0, 2 * Math.PI);
  }
  ctx.fillStyle = predicted || ghost ? colors.halo : color;
  ctx.strokeStyle = predicted || ghost ? color : colors.halo;
  ctx.lineWidth = predicted || ghost ? 2 : Math.max(1, r * 0.24);
  ctx.setLineDash(predicted ? [3.5, 3] : []);
  ctx.fill();
  ctx.stroke();
  ctx.setLineDash([]);
  ctx.globalAlpha = 1;
}

// As many as fit without touching one another; the selected one first.
function paintLabels(ctx, px, nodes) {
  ctx.font = '600 11.5px system-ui, -apple-system, "Segoe UI", Roboto, sans-serif';
  ctx.textBaseline = 'middle';
  const taken = new Set();
  const cells = ([x, y], width) => {
    const found = [];
    for (let i = Math.floor(x / 12); i <= Math.floor((x + width) / 12); ++i) found.push(i + ',' + Math.floor(y / 18), i + ',' + Math.floor((y + 9) / 18));
    return found;
  };
  for (const node of nodes) { const [x, y] = px(node.pose); taken.add(Math.floor(x / 12) + ',' + Math.floor(y / 18)); }
  const order = nodes.slice().sort((a, b) => (b.id === state.selection) - (a.id === state.selection));
  for (const node of order) {
    const [x, y] = px(node.pose);
    const place = [x + nodeRadius + 5, y - nodeRadius - 3];
    const needed = cells(place, ctx.measureText(node.id).width);
    if (node.id !== state.selection && needed.some(cell => taken.has(cell))) continue;
    needed.forEach(cell => taken.add(cell));
    ctx.lineWidth = 3.5;
    ctx.strokeStyle = colors.halo;
    ctx.strokeText(node.id, ...place);
    ctx.fillStyle = node.kind === 'predicted' ? colors.predicted : colors.ink;
    ctx.fillText(node.id, ...place);
  }
}

// ---- picking

function distanceToLine(p, a, b) {
  const [dx, dy] = [b.x - a.x, b.y - a.y];
  const t = Math.max(0, Math.min(1, ((p.x - a.x) * dx + (p.y - a.y) * dy) / (dx * dx + dy * dy || 1)));
  return Math.hypot(p.x - a.x - t * dx, p.y - a.y - t * dy);
}

function inside([x, y], outline) {
  let odd = false;
  outline.forEach(([xi, yi], i) => {
    const [xj, yj] = outline[(i || outline.length) - 1];
    if (yi > y !== yj > y && x < (xj - xi) * (y - yi) / (yj - yi) + xi) odd = !odd;
  });
  return odd;
}

// The nearest thing within reach of the pointer: nodes, then entities, edges, predictions.
function pick(latlng, reach) {
  const p = map.latLngToContainerPoint(latlng);
  const pixel = point => map.latLngToContainerPoint(at(point));
  const along = points => points.slice(1).reduce((best, point, i) => Math.min(best, distanceToLine(p, pixel(points[i]), pixel(point))), Infinity);
  const nearest = (things, distance, limit) => {
    let [best, least] = [null, limit];
    for (const thing of things) {
      const d = distance(thing);
      if (d < least) [best, least] = [thing, d];
    }
    return best;
  };
  const visible = data.nodes.filter(node => onFloor(node) || neighboursOf(node.id).some(({ node: other }) => onFloor(other)));
  return (state.on.graph && nearest(visible, node => p.distanceTo(pixel(node.pose)), nodeRadius + reach))
    || nearest(data.entities.filter(entity => onFloor(entity) && entityShown(entity)), entity => Math.min(...entity.shape.map(along)), reach)
    || (state.on.graph && nearest(data.edges.filter(edge => onFloor(byId.get(edge.from)) || onFloor(byId.get(edge.to))),
      edge => along([byId.get(edge.from).pose, byId.get(edge.to).pose]), reach * 0.8))
    || (state.on.predictions && data.predictions.find(prediction => onFloor(prediction)
      && prediction.areas.some(area => inside([latlng.lng, latlng.lat], area.outline))))
    || null;
}

// ---- view

function floorBounds() {
  const bounds = L.latLngBounds([]);
  for (const floor of data.floors) {
    if (state.floor !== null && floor.number !== state.floor) continue;
    for (const image of floor.plan ? [floor.plan] : floor.layers.map(layer => layer.image).filter(Boolean)) {
      bounds.extend(at(image.corner)).extend(at([image.corner[0] + image.size[0], image.corner[1] + image.size[1]]));
    }
  }
  data.nodes.filter(onFloor).forEach(node => bounds.extend(at(node.pose)));
  data.predictions.filter(onFloor).forEach(prediction => prediction.areas.forEach(area => area.outline.forEach(point => bounds.extend(at(point)))));
  return bounds.isValid() ? bounds : L.latLngBounds(at([-5, -5]), at([5, 5]));
}

// What cards leave free of the window.
function freeArea() {
  const box = id => document.getElementById(id).getBoundingClientRect();
  const phone = isPhone();
  const open = !document.getElementById('panel').hidden;
  const side = box('side');
  return phone ? { left: 16, top: Math.min(side.bottom, 150) + 12, right: 16, bottom: open ? innerHeight - box('panel').top + 12 : 40 }
               : { left: side.right + 24, top: 24, right: open ? innerWidth - box('panel').left + 24 : 72, bottom: 44 };
}

function fit(animate = true) {
  const free = freeArea();
  map.fitBounds(floorBounds(), { paddingTopLeft: [free.left, free.top], paddingBottomRight: [free.right, free.bottom], maxZoom: 6, animate });
}

function centreOn(point, { zoom = map.getZoom(), animate = true } = {}) {
  const free = freeArea();
  const shift = L.point(free.right - free.left, free.bottom - free.top).divideBy(2);
  map.setView(map.unproject(map.project(at(point), zoom).add(shift), zoom), zoom, { animate });
}
