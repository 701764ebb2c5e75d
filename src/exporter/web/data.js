// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

// The map that this page shows (written by html_data.cpp) and what the reader has chosen to see of it.

const data = JSON.parse(document.getElementById('prodomos-data').textContent);
window.prodomosData = data;

const things = [...data.nodes, ...data.edges, ...data.entities, ...data.predictions];
const byId = new Map(things.map(thing => [thing.id, thing]));

function once(make) {
  let made;
  return () => made ??= make();
}

const edgesByNode = once(() => {
  const index = new Map();
  for (const edge of data.edges) {
    for (const end of [edge.from, edge.to]) index.set(end, [...(index.get(end) || []), edge]);
  }
  return index;
});

const neighboursOf = id => (edgesByNode().get(id) || []).map(edge => ({ edge, node: byId.get(edge.from === id ? edge.to : edge.from) }));

const kEntitySwitches = { door: 'doors', staircase: 'stairs' };  // all others: 'entities'

const layerTypes = [...new Set(data.floors.flatMap(floor => floor.layers.map(layer => layer.type)))];

const state = {
  floor: data.floors.length > 0 ? data.floors[0].number : null,  // null: the map knows of no floors
  selection: null,
  on: {
    plan: true, places: data.totals.places > 1, graph: true, labels: true, travelled: false, refined: true, doors: true, stairs: true,
    entities: true, predictions: true, ...Object.fromEntries(layerTypes.map(type => ['layer:' + type, false])),
  },
};

const isPhone = () => matchMedia('(max-width: 720px)').matches;
