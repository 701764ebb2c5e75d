// SPDX-FileCopyrightText: 2026 the prodomos authors
// SPDX-License-Identifier: BSD-3-Clause

// Colours. They stand in page.css, light and dark; canvas and plan take them from there.

const kPlaceHues = 11;

const colors = {};

function readColors() {
  const style = getComputedStyle(document.documentElement);
  const names = ['ground', 'free', 'free-faint', 'wall', 'wall-faint', 'ink', 'ink-soft', 'accent', 'observed', 'predicted',
    'door', 'stairs', 'loop', 'overlap', 'human', 'thing', 'travelled', 'refined', 'halo', 'place-tint'];
  for (const name of names) colors[name] = style.getPropertyValue('--' + name).trim();
}

// Neighbouring numbers get hues far apart: steps of the golden angle, all alike in lightness.
const placeTint = place => `oklch(${colors['place-tint']} ${(255 + (place % kPlaceHues) * 137.508) % 360})`;

const kEntityColors = { door: 'door', staircase: 'stairs', human: 'human' };
const entityColor = entity => colors[kEntityColors[entity.class] || 'thing'];
const kEdgeColors = { travelled: 'observed', loop: 'loop', overlap: 'overlap', door: 'door', stairs: 'stairs', lift: 'stairs' };
const edgeColor = edge => colors[kEdgeColors[edge.kind] || 'observed'];

const scratch = document.createElement('canvas').getContext('2d', { willReadFrequently: true });
function rgb(color) {
  scratch.fillStyle = color;
  scratch.fillRect(0, 0, 1, 1);
  return [...scratch.getImageData(0, 0, 1, 1).data].slice(0, 3);
}

// The 16 colours of plan images, in the order of html_images.hpp: unknown, wall, faint wall, faint free, free floor of no
// place, then free floor by place.
function planPalette(byPlace) {
  const palette = [colors.ground, colors.wall, colors['wall-faint'], colors['free-faint'], colors.free].map(rgb);
  for (let hue = 0; hue < kPlaceHues; ++hue) palette.push(rgb(byPlace ? placeTint(hue) : colors.free));
  return palette;
}

const kCrcTable = Uint32Array.from({ length: 256 }, (_, n) => {
  for (let bit = 0; bit < 8; ++bit) n = n & 1 ? 0xedb88320 ^ (n >>> 1) : n >>> 1;
  return n;
});
function crc32(bytes) {
  let crc = 0xffffffff;
  for (const byte of bytes) crc = kCrcTable[(crc ^ byte) & 255] ^ (crc >>> 8);
  return (crc ^ 0xffffffff) >>> 0;
}

const decodeBase64 = text => Uint8Array.from(atob(text), letter => letter.charCodeAt(0));

// A plan image is a PNG whose palette is replaced in place, so that one image serves light, dark and places.
function withPalette(png, palette) {
  const bytes = decodeBase64(png);
  const view = new DataView(bytes.buffer);
  for (let at = 8; at < bytes.length;) {
    const length = view.getUint32(at);
    if (String.fromCharCode(...bytes.subarray(at + 4, at + 8)) === 'PLTE') {
      bytes.set(palette.flat().slice(0, length), at + 8);
      view.setUint32(at + 8 + length, crc32(bytes.subarray(at + 4, at + 8 + length)));
      break;
    }
    at += length + 12;
  }
  return bytes;
}

const imageUrl = bytes => URL.createObjectURL(new Blob([bytes], { type: 'image/png' }));
