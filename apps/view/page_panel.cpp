// What the page shows beside the picture and over it: options, picks, figures about ranks.
#include "apps/view/page.h"

namespace delray::apps::view::internal {

const char* const kPanel = R"js(
const svg = (name, attributes, text) => {
  const e = document.createElementNS('http://www.w3.org/2000/svg', name);
  for (const [key, value] of Object.entries(attributes)) e.setAttribute(key, value);
  if (text) e.textContent = text;
  return e;
};
const html = (name, properties, ...children) => {
  const e = Object.assign(document.createElement(name), properties);
  e.append(...children);
  return e;
};

// Options, as the program's tables describe them.
const closed = new Set(['Input', 'Camera and animation']);
const setOption = (option, value) => {
  if (option.scope === 'page') { if (value) own.set(option.name, value); else own.delete(option.name); }
  say({type: 'option', name: option.name, value});
};
const inputOf = option => {
  const id = 'option' + option.name, now = option.value || option.default || '';
  if (option.flag) {
    return html('input', {type: 'checkbox', id, checked: now === 'true',
      onchange: e => setOption(option, e.target.checked ? 'true' : '')});
  }
  if (option.values.length) {
    const values = option.values.includes(now) ? [] : [new Option(now || 'default', now)];
    const select = html('select', {id}, ...values, ...option.values.map(v => new Option(v, v)));
    select.value = now;
    select.onchange = () => setOption(option, select.value);
    return select;
  }
  const known = option.default && option.default !== 'null' && option.default !== '""' ? option.default : 'default';
  return html('input', {type: 'text', id, value: option.value, placeholder: known, autocomplete: 'off', spellcheck: false,
    onchange: e => setOption(option, e.target.value.trim())});
};
const showPanel = m => {
  const focused = document.activeElement && document.activeElement.id, groups = [];
  for (const group of m.groups) {
    const rows = [];
    for (const option of group.options) {
      if (option.idle && option.idle.startsWith('--engine')) continue;
      if (m.ranks_are_fixed && option.scope === 'ranks') continue;
      const input = inputOf(option);
      input.disabled = !!option.idle;
      rows.push(html('label', {title: option.help + (option.idle ? '\n\nNo effect with ' + option.idle : ''),
        className: option.idle ? 'idle' : '', htmlFor: input.id},
        option.name.replace(/^--/, '').replace(/-/g, ' '), input));
    }
    if (!rows.length) continue;
    const box = html('details', {open: !closed.has(group.name)}, html('summary', {}, group.name.replace(/ \(.*/, '')), ...rows);
    box.ontoggle = () => { if (box.open) closed.delete(group.name); else closed.add(group.name); };
    groups.push(box);
  }
  element('groups').replaceChildren(...groups);
  if (focused && element(focused)) element(focused).focus();
};

// Picks: the last one, or the last two while distances are measured.
let picks = [], turnsAbout = false;
const isPressed = id => element(id).getAttribute('aria-pressed') === 'true';
const showPick = m => {
  if (turnsAbout) {
    turnsAbout = false;
    if (m.hit && camera) { camera.at = m.position; movedOnce(); }
    return;
  }
  if (!m.hit) {
    if (isPressed('measure')) return note('Nothing is there.', true);
    picks = [];
  } else picks = isPressed('measure') ? [...picks.slice(-1), m] : [m];
  showFacts();
  drawOverlay();
};
const between = () => length(sub(picks[0].measured, picks[1].measured));
const showFacts = () => {
  element('picked').hidden = !picks.length;
  document.body.dataset.picks = picks.length;
  const parts = [];
  picks.forEach((pick, i) => {
    if (picks.length > 1) parts.push(html('h3', {}, 'Place ' + 'AB'[i]));
    parts.push(html('dl', {}, ...pick.facts.slice(0, picks.length > 1 ? 3 : 99).flatMap(([name, value]) => [html('dt', {}, name), html('dd', {}, value)])));
  });
  if (picks.length === 2) {
    parts.push(html('p', {className: 'distance'}, 'Distance ' + between().toPrecision(7) + ' units'));
  } else if (isPressed('measure')) parts.push(html('p', {}, 'Click another place.'));
  else if (picks.length) parts.push(html('button', {type: 'button', id: 'cuthere', onclick: () => cut(picks[0].position)}, 'Clip here'));
  element('facts').replaceChildren(...parts);
};

// The clipping plane: through a place, or none.
const cut = place => { cutAt = place; movedOnce(); };
const showCut = () => {
  press('clip', !!cutAt);
  element('cut').hidden = !cutAt;
  if (!cutAt || !camera || !scene) return;
  const [front, back] = ends();
  element('cutat').value = 1000 * (clipped() - front) / (back - front);
};
const cutBy = share => {
  if (!camera || !scene) return;
  const [front, back] = ends(), far = front + share * (back - front);
  cut(far > 0 ? add(camera.eye, times(axes().forward, far)) : null);
};

// Over the picture: regions with their ranks' loads, marks at picks.
let figures = null;
const drawOverlay = () => {
  const parts = [], w = canvas.clientWidth, h = canvas.clientHeight;
  if (isPressed('ranks') && figures) {
    for (const r of figures.regions) {
      const load = figures.loads[r.rank] || 1, x = r.x / figures.width * w, y = r.y / figures.height * h;
      const width = r.width / figures.width * w, height = r.height / figures.height * h;
      parts.push(svg('rect', {x, y, width, height, class: load > 1 ? 'above' : 'below',
        'fill-opacity': 0.75 * Math.sqrt(Math.min(1, Math.abs(load - 1)))}));
      if (width > 60 && height > 36) {
        parts.push(svg('text', {x: x + width / 2, y: y + height / 2, 'text-anchor': 'middle'}, 'rank ' + r.rank));
        if (width > 140) parts.push(svg('text', {x: x + width / 2, y: y + height / 2 + 17, 'text-anchor': 'middle'}, load.toFixed(2) + ' of mean'));
      }
    }
  }
  if (camera) {
    const places = picks.map(p => project(p.position));
    if (places.length === 2 && places[0] && places[1]) {
      const [[x1, y1], [x2, y2]] = places;
      parts.push(svg('line', {x1, y1, x2, y2, class: 'ruler'}), svg('line', {x1, y1, x2, y2, class: 'ruler light'}),
        svg('text', {x: (x1 + x2) / 2, y: (y1 + y2) / 2 - 8, 'text-anchor': 'middle'}, between().toPrecision(5)));
    }
    places.forEach(p => {
      if (!p) return;
      for (const dark of [' dark', ''])
        parts.push(svg('path', {d: `M${p[0] - 9} ${p[1]}h18M${p[0]} ${p[1] - 9}v18`, class: 'marker' + dark}));
    });
  }
  element('overlay').replaceChildren(...parts);
};

const readable = n => n < 10000 ? String(n) : n < 1e6 ? (n / 1e3).toFixed(1) + ' k' : n < 1e9 ? (n / 1e6).toFixed(2) + ' M' : (n / 1e9).toFixed(2) + ' G';
const showFigures = m => {
  figures = m;
  const box = element('figures'), regions = m.regions.length ? '' : ' This picture is not cut into regions of ranks.';
  box.innerHTML = m.html;
  box.prepend(html('h2', {}, 'Ranks'), html('p', {}, `Busiest rank ${m.imbalance.toFixed(2)} times the mean (measured). ` +
    `${readable(m.messages)} messages, ${readable(m.bytes)} bytes (counted).${regions}`));
  box.querySelectorAll('svg [tabindex]').forEach(e => e.removeAttribute('tabindex'));
  drawOverlay();
};
)js";

}  // namespace delray::apps::view::internal
