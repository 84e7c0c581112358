// Mouse, fingers, keys and buttons.
#include "apps/view/page.h"

namespace delray::apps::view::internal {

const char* const kControls = R"js(
const place = e => {
  const box = canvas.getBoundingClientRect();
  return [e.clientX - box.left, e.clientY - box.top];
};
const pointers = new Map();
let begin = null, isClick = false, pinch = null, clickTimer = 0;

const press = (id, on) => element(id).setAttribute('aria-pressed', on);
const toggle = id => { const on = !isPressed(id); press(id, on); return on; };

// Two fingers: their middle moves the picture, their distance zooms.
const pinchNow = () => {
  const [a, b] = [...pointers.values()];
  return {x: (a[0] + b[0]) / 2, y: (a[1] + b[1]) / 2, far: Math.hypot(a[0] - b[0], a[1] - b[1])};
};
canvas.addEventListener('pointerdown', e => {
  if (!camera) return;
  canvas.focus({preventScroll: true});
  canvas.setPointerCapture(e.pointerId);
  pointers.set(e.pointerId, place(e));
  isClick = pointers.size === 1 && e.button === 0 && !e.shiftKey;
  begin = place(e);
  pinch = pointers.size === 2 ? pinchNow() : null;
  canvas.classList.add('dragged');
  e.preventDefault();
});
canvas.addEventListener('pointermove', e => {
  const before = pointers.get(e.pointerId);
  if (!before || !camera) return;
  const now = place(e), dx = now[0] - before[0], dy = now[1] - before[1];
  if (isClick && Math.hypot(now[0] - begin[0], now[1] - begin[1]) < 4) return;
  isClick = false;
  pointers.set(e.pointerId, now);
  if (dx === 0 && dy === 0) return;
  moving();
  if (pointers.size >= 2) {
    const next = pinchNow();
    if (pinch) {
      pan(next.x - pinch.x, next.y - pinch.y);
      if (next.far > 0 && pinch.far > 0) zoom(pinch.far / next.far, next.x, next.y);
    }
    pinch = next;
  } else if (e.buttons & 6 || e.shiftKey) pan(dx, dy);
  else if (isPressed('fly')) look(-dx, -dy);
  else orbit(dx, dy);
  changed();
});
const lift = e => {
  if (!pointers.delete(e.pointerId)) return;
  pinch = null;
  if (pointers.size) return;
  canvas.classList.remove('dragged');
  if (isMoving) rested();
  if (e.type === 'pointerup' && isClick && canvas.clientWidth) {
    const [x, y] = place(e), ask = {type: 'pick', x: x / canvas.clientWidth, y: y / canvas.clientHeight};
    if (ask.x >= 0 && ask.x <= 1 && ask.y >= 0 && ask.y <= 1) say(ask);
  }
};
canvas.addEventListener('pointerup', lift);
canvas.addEventListener('pointercancel', lift);
canvas.addEventListener('contextmenu', e => e.preventDefault());
canvas.addEventListener('dblclick', e => {
  const [x, y] = place(e);
  turnsAbout = true;
  say({type: 'pick', x: Math.min(1, Math.max(0, x / canvas.clientWidth)), y: Math.min(1, Math.max(0, y / canvas.clientHeight))});
});
canvas.addEventListener('wheel', e => {
  e.preventDefault();
  if (!camera) return;
  const lines = e.deltaMode === 1 ? 16 : e.deltaMode === 2 ? 400 : 1;
  zoom(Math.exp(Math.max(-1, Math.min(1, e.deltaY * lines * 0.0016))), ...place(e));
  movedOnce();
}, {passive: false});

// Flying: as long as a key is down, at a pace that crosses the scene in some seconds.
const flying = new Set(), kFly = {w: [1, 0, 0], s: [-1, 0, 0], a: [0, -1, 0], d: [0, 1, 0], q: [0, 0, -1], e: [0, 0, 1]};
let flownAt = 0;
const flyOn = now => {
  if (!flying.size || !camera) { flownAt = 0; return rested(); }
  const seconds = flownAt ? Math.min(0.1, (now - flownAt) / 1000) : 0.016;
  flownAt = now;
  const pace = seconds * Math.max(distance() * 0.6, scene ? scene.size * 0.02 : 0);
  fly(...[...flying].reduce((sum, key) => add(sum, kFly[key]), [0, 0, 0]).map(x => x * pace));
  moving();
  changed();
  requestAnimationFrame(flyOn);
};

const fit = name => { awaitsView = true; say({type: 'view', name}); };
const showOptions = on => { press('options', on); element('panel').hidden = !on; };
const showRanks = on => {
  press('ranks', on);
  element('figures').hidden = !on;
  element('panel').classList.toggle('wide', on);
  if (on) showOptions(true); else figures = null;
  watch();
  drawOverlay();
};
const showKeys = on => { press('help', on); element('keys').hidden = !on; };
const setMeasure = on => { press('measure', on); canvas.classList.toggle('picks', on); picks = []; showFacts(); drawOverlay(); };

const toggleCut = () => { if (camera) cut(cutAt ? null : picks.length ? picks[picks.length - 1].position : camera.at); };

const kKeys = {
  ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1],
};
document.addEventListener('keydown', e => {
  if (/^(INPUT|SELECT|TEXTAREA)$/.test(e.target.tagName) || e.ctrlKey || e.metaKey || e.altKey || !camera) return;
  const key = e.key.length === 1 ? e.key.toLowerCase() : e.key;
  if (kKeys[key]) {
    const [x, y] = kKeys[key], step = canvas.clientHeight / 24;
    if (e.shiftKey) pan(-x * step, -y * step); else orbit(-x * step, -y * step);
    movedOnce();
  } else if (key === '+' || key === '=' || key === '-') {
    zoom(key === '-' ? 1.15 : 1 / 1.15, canvas.clientWidth / 2, canvas.clientHeight / 2);
    movedOnce();
  } else if (kFly[key]) {
    const flies = flying.size > 0;
    flying.add(key);
    if (!flies) flyOn(performance.now());
  } else if (key === 'Home') fit('default');
  else if (key === 'f') toggle('fly');
  else if (key === 'c') toggleCut();
  else if (cutAt && (key === '[' || key === ']')) cutBy((+element('cutat').value + (key === ']' ? 10 : -10)) / 1000);
  else if (key === 'm') setMeasure(!isPressed('measure'));
  else if (key === 'r') showRanks(!isPressed('ranks'));
  else if (key === 'o') showOptions(!isPressed('options'));
  else if (key === '?') showKeys(!isPressed('help'));
  else if (key === 'Escape') { picks = []; showFacts(); drawOverlay(); showKeys(false); }
  else return;
  e.preventDefault();
});
document.addEventListener('keyup', e => flying.delete(e.key.toLowerCase()));
window.addEventListener('blur', () => flying.clear());

element('fit').onclick = () => fit('default');
element('views').onchange = e => { if (e.target.value) fit(e.target.value); e.target.value = ''; canvas.focus(); };
element('fly').onclick = () => toggle('fly');
element('measure').onclick = () => setMeasure(!isPressed('measure'));
element('clip').onclick = () => toggleCut();
element('cutat').oninput = e => cutBy(Math.max(1e-3, e.target.value / 1000));
element('ranks').onclick = () => showRanks(!isPressed('ranks'));
element('options').onclick = () => showOptions(!isPressed('options'));
element('help').onclick = () => showKeys(!isPressed('help'));
element('unpick').onclick = () => { picks = []; showFacts(); drawOverlay(); };
element('groups').onsubmit = e => e.preventDefault();
element('copy').onclick = () => say({type: 'command'});
const copied = async text => {
  document.body.dataset.command = text;
  try {
    await navigator.clipboard.writeText(text);
    note('Copied: ' + text, true);
  } catch (error) {  // the browser does not let pages copy here
    note(text, true);
  }
};
element('save').onclick = async () => {
  const file = lastFile || await new Promise(done => canvas.toBlob(done, 'image/png'));
  const link = html('a', {href: URL.createObjectURL(file),
    download: (scene ? scene.name.replace(/^.*\//, '').replace(/[^\w.-]+/g, '-') : 'picture') + '.png'});
  link.click();
  setTimeout(() => URL.revokeObjectURL(link.href), 5000);
};

let resizeTimer = 0;
new ResizeObserver(() => {
  clearTimeout(resizeTimer);
  resizeTimer = setTimeout(() => { say({type: 'size', ...size()}); drawOverlay(); }, 80);
}).observe(element('stage'));
document.addEventListener('visibilitychange', watch);
if (matchMedia('(max-width:46rem)').matches) showOptions(false);
// For tests and the curious: what the page has, to be read.
window.delray = () => ({camera, clip: clipped(), scene, header: lastHeader, moved, picks, figures});
connect();
)js";

}  // namespace delray::apps::view::internal
