// SPDX-License-Identifier: BSD-3-Clause
// The camera, and what moves it: mouse and touch by OrbitControls of three.js, keys by ourselves.
const kFieldOfView = 32;  // degrees, vertical
const camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 1, 2);
camera.up.set(0, 0, 1);
const canvas = document.getElementById("canvas");
const controls = new THREE.OrbitControls(camera, canvas);
Object.assign(controls, {enableKeys: false, enableDamping: true, dampingFactor: 0.18,
                         screenSpacePanning: true, rotateSpeed: 0.9,
                         minDistance: 0.005 * scene_size, maxDistance: 20 * scene_size});
controls.addEventListener("change", () => redraw());
controls.addEventListener("start", () => { view_name = null; });

// The direction last looked from, until the camera is moved otherwise.
let view_name = "home";
const kDirections = {
  home: [0.62, -0.9, 0.55], front: [0, -1, 0], right: [1, 0, 0], top: [0, -1e-4, 1],
};

// Below this width of the window the panel folds, and stands at the bottom (view.css).
const kNarrowWidth = 600;

// What the panel and the player cover: a strip at the left, or on narrow screens at the bottom.
function covered_area() {
  const bar = document.getElementById("player");
  const played = bar.hidden ? 0 : innerHeight - bar.getBoundingClientRect().top;
  if (document.body.classList.contains("bare")) return {left: 0, bottom: played};
  const panel = document.getElementById("panel").getBoundingClientRect();
  return innerWidth > kNarrowWidth ? {left: panel.right, bottom: played}
                                   : {left: 0, bottom: innerHeight - panel.top};
}

function free_area() {
  const {left, bottom} = covered_area();
  return {x: left, y: 0, width: Math.max(innerWidth - left, 1), height: Math.max(innerHeight - bottom, 1)};
}

// What is looked at stands in the middle of what the panel leaves free, or of a pane of that.
function fit_view(pane = 0) {
  const area = pane_areas()[Math.max(pane, 0)];
  camera.aspect = innerWidth / innerHeight;
  camera.setViewOffset(innerWidth, innerHeight, innerWidth / 2 - area.x - area.width / 2,
                       innerHeight / 2 - area.y - area.height / 2, innerWidth, innerHeight);
}

// Looks at a box from a direction, from as near as all of it is seen.
function look_from(name) {
  view_name = name;
  const direction = new THREE.Vector3().fromArray(kDirections[name]).normalize();
  const across = new THREE.Vector3().crossVectors(camera.up, direction).normalize();
  const upward = new THREE.Vector3().crossVectors(direction, across);
  const area = pane_areas()[0];
  const slope = 2 * Math.tan(kFieldOfView * Math.PI / 360) / innerHeight;  // of a pixel
  const [slope_x, slope_y] = [0.5 * slope * area.width, 0.5 * slope * area.height];
  const box = scene_box();
  const middle = box.getCenter(new THREE.Vector3());
  let distance = 0;
  for (let corner = 0; corner < 8; ++corner) {
    const p = new THREE.Vector3(corner & 1 ? box.max.x : box.min.x,
                                corner & 2 ? box.max.y : box.min.y,
                                corner & 4 ? box.max.z : box.min.z).sub(middle);
    const aside = Math.max(Math.abs(p.dot(across)) / slope_x, Math.abs(p.dot(upward)) / slope_y);
    distance = Math.max(distance, p.dot(direction) + 1.12 * aside);
  }
  place_camera(middle, direction.multiplyScalar(distance));
}
// When there is more or less room for the picture.
function fit_again() {
  if (view_name) look_from(view_name);
  redraw();
}

function place_camera(target, offset) {
  controls.target.copy(target);
  camera.position.copy(target).add(offset);
  controls.update();
  redraw();
}
function look_at(target, offset) {
  view_name = null;
  place_camera(target, offset);
}

// From where it is seen now, from no further away than that.
function approach(place, distance) {
  const offset = camera.position.clone().sub(controls.target);
  look_at(place, offset.setLength(Math.min(distance, offset.length())));
}

function look_at_leak(leak) {
  label_leak(leak);
  approach(world_place(leak), Math.max(14 * leak.depth, 0.12 * scene_size));
}

function turn(yaw, pitch) {
  const offset = camera.position.clone().sub(controls.target);
  offset.applyAxisAngle(camera.up, yaw);
  const polar = offset.angleTo(camera.up);
  const next = Math.min(Math.PI - 0.01, Math.max(0.01, polar + pitch));
  const across = new THREE.Vector3().crossVectors(camera.up, offset).normalize();
  look_at(controls.target.clone(), offset.applyAxisAngle(across, next - polar));
}
function zoom(factor) {
  const offset = camera.position.clone().sub(controls.target);
  look_at(controls.target.clone(), offset.multiplyScalar(factor));
}
function pan(x, y) {
  const step = 0.05 * camera.position.distanceTo(controls.target);
  const shift = new THREE.Vector3(x, y, 0).multiplyScalar(step).applyQuaternion(camera.quaternion);
  look_at(controls.target.clone().add(shift), camera.position.clone().sub(controls.target));
}

// The pixel that shows a point of the world, and whether it can be seen: it stands before the eye
// and not too far.
function pixel_of(place) {
  const p = place.clone().project(camera);
  return {x: (0.5 + 0.5 * p.x) * innerWidth, y: (0.5 - 0.5 * p.y) * innerHeight,
          seen: Math.abs(p.z) < 1};
}

// How much of the world a pixel shows at the point looked at.
function length_of_pixel() {
  const distance = camera.position.distanceTo(controls.target);
  return 2 * distance * Math.tan(kFieldOfView * Math.PI / 360) / innerHeight;
}

function place_clipping_planes() {
  const far = camera.position.distanceTo(start_box.getCenter(new THREE.Vector3())) + 2 * scene_size;
  camera.far = far;
  camera.near = Math.max(0.002 * camera.position.distanceTo(controls.target), far * 1e-4);
  camera.updateProjectionMatrix();
}
