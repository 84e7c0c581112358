// The camera of the page, in the scene's coordinates: what turning, moving, zooming and flying do
// to it. The server gets what comes out.
#include "apps/view/page.h"

namespace delray::apps::view::internal {

const char* const kCamera = R"js(
const element = id => document.getElementById(id);
const canvas = element('picture');
const add = (a, b) => a.map((x, i) => x + b[i]);
const sub = (a, b) => a.map((x, i) => x - b[i]);
const times = (a, s) => a.map(x => x * s);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
const length = a => Math.hypot(...a);
const unit = a => times(a, 1 / (length(a) || 1));

// scene: what the server says of it. camera: null until the server has placed one. cutAt: a place
// of the scene that the clipping plane goes through, parallel to the screen; null without one.
let scene = null, camera = null, cutAt = null;

const worldUp = () => scene && scene.z_up ? [0, 0, 1] : [0, 1, 0];
const horizon = () => scene && scene.z_up ? [[1, 0, 0], [0, 1, 0]] : [[0, 0, 1], [1, 0, 0]];

// Unit vectors at right angles, as scenes::make_view has them.
const axes = () => {
  const forward = unit(sub(camera.at, camera.eye));
  let right = cross(forward, camera.up);
  if (length(right) < 1e-9) right = cross(forward, Math.abs(forward[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0]);
  right = unit(right);
  return {forward, right, up: cross(right, forward)};
};
// The distance of the clipping plane along the view; 0: nothing is cut off.
const clipped = () => cutAt && camera ? Math.max(0, dot(sub(cutAt, camera.eye), axes().forward)) : 0;
// Distances along the view of the front of the scene and of its back.
const ends = () => {
  const middle = dot(sub(scene.centre, camera.eye), axes().forward), half = scene.size / 2;
  return [Math.max(0, middle - half), middle + half];
};
const distance = () => length(sub(camera.at, camera.eye));
// Units of the scene that a CSS pixel is wide, at the depth of what is looked at.
const unitsPerPixel = () => (camera.height > 0 ? camera.height :
  2 * distance() * Math.tan(camera.fov * Math.PI / 360)) / canvas.clientHeight;

// A place of the scene on the screen, in CSS pixels; null behind the eye.
const project = p => {
  const {forward, right, up} = axes(), from = sub(p, camera.eye), depth = dot(from, forward);
  if (camera.height <= 0 && depth <= 0) return null;
  const units = camera.height > 0 ? unitsPerPixel() : unitsPerPixel() * depth / distance();
  return [canvas.clientWidth / 2 + dot(from, right) / units, canvas.clientHeight / 2 - dot(from, up) / units];
};

// About what is looked at, the horizon stays level.
const orbit = (dx, dy) => {
  const up = worldUp(), [e1, e2] = horizon(), from = sub(camera.eye, camera.at), far = length(from);
  let polar = Math.acos(Math.max(-1, Math.min(1, dot(from, up) / far)));
  let around = [dot(from, e1), dot(from, e2)];
  if (Math.hypot(...around) < 1e-6 * far) {  // from straight above or below: the picture's up tells
    const heading = axes().up, sign = polar < 1 ? -1 : 1;
    around = [sign * dot(heading, e1), sign * dot(heading, e2)];
  }
  const turn = Math.PI / canvas.clientHeight;
  const azimuth = Math.atan2(around[1], around[0]) - dx * turn;
  polar = Math.max(0.01, Math.min(Math.PI - 0.01, polar - dy * turn));
  camera.eye = add(camera.at, add(times(up, far * Math.cos(polar)),
    times(add(times(e1, Math.cos(azimuth)), times(e2, Math.sin(azimuth))), far * Math.sin(polar))));
  camera.up = up;
};

const shift = by => {
  camera.eye = add(camera.eye, by);
  camera.at = add(camera.at, by);
};
const pan = (dx, dy) => {
  const {right, up} = axes(), units = unitsPerPixel();
  shift(add(times(right, -dx * units), times(up, dy * units)));
};

// What is under (x, y), in CSS pixels, at the depth of what is looked at, stays there.
const zoom = (factor, x, y) => {
  const {right, up} = axes(), units = unitsPerPixel();
  const offset = add(times(right, (x - canvas.clientWidth / 2) * units), times(up, (canvas.clientHeight / 2 - y) * units));
  const least = scene ? scene.size * 1e-5 : 1e-6, most = scene ? scene.size * 1e3 : 1e9;
  const far = distance() * factor;
  if (far < least || far > most) return;
  shift(times(offset, 1 - factor));
  if (camera.height > 0) camera.height *= factor;
  else camera.eye = add(camera.at, times(sub(camera.eye, camera.at), factor));
};

// Looks around from where the eye is.
const look = (dx, dy) => {
  const up = worldUp(), [e1, e2] = horizon(), ahead = sub(camera.at, camera.eye), far = length(ahead);
  let polar = Math.acos(Math.max(-1, Math.min(1, dot(ahead, up) / far)));
  let azimuth = Math.atan2(dot(ahead, e2), dot(ahead, e1));
  const turn = camera.fov * Math.PI / 180 / canvas.clientHeight;
  azimuth += dx * turn;
  polar = Math.max(0.01, Math.min(Math.PI - 0.01, polar - dy * turn));
  camera.at = add(camera.eye, add(times(up, far * Math.cos(polar)),
    times(add(times(e1, Math.cos(azimuth)), times(e2, Math.sin(azimuth))), far * Math.sin(polar))));
  camera.up = up;
};
const fly = (ahead, aside, above) => {
  const {forward, right} = axes();
  shift(add(times(forward, ahead), add(times(right, aside), times(worldUp(), above))));
};
)js";

}  // namespace delray::apps::view::internal
