// SPDX-License-Identifier: BSD-3-Clause
// The camera, and what moves it: mouse and touch by OrbitControls of three.js, keys by ourselves.
// Sets of spheres side by side, in panes. What lies over the picture: axes, a scale, a label.
const kFieldOfView = 32;  // degrees, vertical
const camera = new THREE.PerspectiveCamera(kFieldOfView, 1, 1, 2);
camera.up.set(0, 0, 1);
const canvas = panel_part("canvas");
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

// What the panel and the player leave: they cover a strip at the left, or on narrow screens at the
// bottom.
function free_area() {
  const bar = panel_part("player");
  const panel = panel_part("panel").getBoundingClientRect();
  const is_narrow = innerWidth <= kNarrowWidth;
  const is_bare = document.body.classList.contains("bare");
  const x = is_bare || is_narrow ? 0 : panel.right;
  const bottom = is_narrow && !is_bare ? panel.top
      : bar.hidden ? innerHeight : bar.getBoundingClientRect().top;
  return {x, y: 0, width: Math.max(innerWidth - x, 1), height: Math.max(bottom, 1)};
}

// Sets of spheres side by side: the scene is drawn once for each set, with what is of that set
// alone (its spheres and its leaks) and all the rest, by one camera.
const kMostPanes = 4;
const pane_sets = sets.filter((item) => item.shown);
const can_stand_side_by_side = pane_sets.length >= 2 && pane_sets.length <= kMostPanes;
let side_by_side = can_stand_side_by_side && start_side_by_side();

// Two sets that are about the same thing are meant to be compared.
function start_side_by_side() {
  const wanted = address_options.get("side");
  if (wanted) return wanted === "on";
  const meshes = items.filter((item) => item.kind === "mesh" && item.shown).length;
  return pane_sets.length === 2 && pane_sets[0].kind === pane_sets[1].kind &&
      (robot_data ? !scene_data.trajectory : meshes <= 1);
}

// In which pane an item is; -1 for all of them.
const pane_of = (item) => side_by_side
    ? pane_sets.findIndex((set) => set === item || (item.of && set.full_name === item.of)) : -1;

// The free area in equal parts, one beside the other, or one below the other where it is narrow.
function pane_areas() {
  const {x, y, width, height} = free_area();
  const count = side_by_side ? pane_sets.length : 1;
  const stacked = width < 0.8 * height;
  return Array.from({length: count}, (_, k) => stacked
      ? {x, y: y + height * k / count, width, height: height / count}
      : {x: x + width * k / count, y, width: width / count, height});
}

const pane_at = (x, y) => pane_areas().findIndex(
    (area) => x < area.x + area.width && y < area.y + area.height);

function draw_panes() {
  const areas = pane_areas();
  renderer.setScissorTest(areas.length > 1);
  areas.forEach((area, k) => {
    fit_view(k);
    for (const item of items) {
      const own = pane_of(item);
      for (const part of item.parts) part.group.visible = part.visible && (own < 0 || own === k);
    }
    // The first one goes on below the panel.
    const left = k === 0 ? 0 : area.x;
    renderer.setScissor(left, innerHeight - area.y - area.height, area.x + area.width - left,
                        area.height);
    renderer.render(world, camera);
  });
  for (const item of items) for (const part of item.parts) part.group.visible = part.visible;
}

// What is told of a set above it.
const pane_titles = [];
function tell_panes() {
  for (const title of pane_titles.splice(0)) title.remove();
  for (const set of side_by_side ? pane_sets : []) {
    const words = [count_text(count_of(set), "sphere")];
    const own = leaks.find((leak) => leak.item.of === set.full_name);
    if (own) words.push(`deepest leak ${distance_text(own.depth)}`);
    else if (items.some((item) => item.of === set.full_name)) words.push("no leak found");
    const title = node("div", {className: "pane-title", title: set.full_name},
                       node("div", {}, node("b", {}, set.name),
                            ...words.map((text) => node("span", {}, text))));
    document.body.append(title);
    pane_titles.push(title);
  }
  show_pressed(panel_part("side"), side_by_side);
}
function place_pane_titles() {
  const areas = pane_areas();
  pane_titles.forEach((title, k) => {
    const {x, y, width} = areas[k];
    Object.assign(title.style, {left: `${x}px`, top: `${y}px`, width: `${width}px`});
  });
}
function switch_panes() {
  if (!can_stand_side_by_side) return;
  side_by_side = !side_by_side;
  tell_panes();
  fit_again();
  refresh();
}

// What is looked at stands in the middle of what the panel leaves free, or of a pane of that.
function fit_view(pane = 0) {
  const area = pane_areas()[Math.max(pane, 0)];
  camera.aspect = innerWidth / innerHeight;
  camera.setViewOffset(innerWidth, innerHeight, innerWidth / 2 - area.x - area.width / 2,
                       innerHeight / 2 - area.y - area.height / 2, innerWidth, innerHeight);
}

const slope_of_pixel = () => 2 * Math.tan(kFieldOfView * Math.PI / 360) / innerHeight;

// Looks at a box from a direction, from as near as all of it is seen.
function look_from(name) {
  const direction = new THREE.Vector3().fromArray(kDirections[name]).normalize();
  const across = new THREE.Vector3().crossVectors(camera.up, direction).normalize();
  const upward = new THREE.Vector3().crossVectors(direction, across);
  const area = pane_areas()[0];
  const [slope_x, slope_y] = [area.width, area.height].map((size) => 0.5 * slope_of_pixel() * size);
  const box = scene_box();
  const middle = box.getCenter(new THREE.Vector3());
  let distance = 0;
  for (let corner = 0; corner < 8; ++corner) {
    const end = kAxes.map((axis, k) => (corner >> k & 1 ? box.max : box.min)[axis]);
    const p = new THREE.Vector3(...end).sub(middle);
    const aside = Math.max(Math.abs(p.dot(across)) / slope_x, Math.abs(p.dot(upward)) / slope_y);
    distance = Math.max(distance, p.dot(direction) + 1.12 * aside);
  }
  look_at(middle, direction.multiplyScalar(distance));
  view_name = name;
}
// When there is more or less room for the picture.
function fit_again() {
  if (view_name) look_from(view_name);
  redraw();
}

function look_at(target, offset) {
  view_name = null;
  controls.target.copy(target);
  camera.position.copy(target).add(offset);
  controls.update();
  redraw();
}
const view_offset = () => camera.position.clone().sub(controls.target);

// From where it is seen now, from no further away than that.
function approach(place, distance) {
  const offset = view_offset();
  look_at(place, offset.setLength(Math.min(distance, offset.length())));
}

function look_at_leak(leak) {
  label_leak(leak);
  approach(world_place(leak), Math.max(14 * leak.depth, 0.12 * scene_size));
}

function turn(yaw, pitch) {
  const offset = view_offset().applyAxisAngle(camera.up, yaw);
  const polar = offset.angleTo(camera.up);
  const next = Math.min(Math.PI - 0.01, Math.max(0.01, polar + pitch));
  const across = new THREE.Vector3().crossVectors(camera.up, offset).normalize();
  look_at(controls.target.clone(), offset.applyAxisAngle(across, next - polar));
}
const zoom = (factor) => look_at(controls.target.clone(), view_offset().multiplyScalar(factor));

// The pixel that shows a point of the world, and whether it can be seen: it stands before the eye
// and not too far.
function pixel_of(place) {
  const p = place.clone().project(camera);
  return {x: (0.5 + 0.5 * p.x) * innerWidth, y: (0.5 - 0.5 * p.y) * innerHeight,
          seen: Math.abs(p.z) < 1};
}

function place_clipping_planes() {
  const far = camera.position.distanceTo(start_box.getCenter(new THREE.Vector3())) + 2 * scene_size;
  camera.far = far;
  camera.near = Math.max(0.002 * camera.position.distanceTo(controls.target), far * 1e-4);
  camera.updateProjectionMatrix();
}

const kArm = 26;  // pixels
function place_axes() {
  const to_eye = camera.quaternion.clone().inverse();
  const set_all = (made, attributes) =>
      Object.entries(attributes).forEach(([name, value]) => made.setAttribute(name, value));
  [...panel_part("axes").children].forEach((axis, k) => {
    const {x, y} = new THREE.Vector3().setComponent(k, 1).applyQuaternion(to_eye);
    set_all(axis.firstElementChild, {x2: x * kArm, y2: -y * kArm});
    set_all(axis.lastElementChild, {x: x * (kArm + 9), y: -y * (kArm + 9)});
  });
}

// A length to compare with, of the world at the point looked at.
function place_scale() {
  const pixel = camera.position.distanceTo(controls.target) * slope_of_pixel();
  const length = round_length(140 * pixel);
  panel_part("bar").style.width = `${length / pixel}px`;
  panel_part("length").textContent = distance_text(length);
}

function place_label() {
  const label = panel_part("label");
  label.hidden = !(labelled_leak && leak_shown(labelled_leak));
  if (label.hidden) return;
  fit_view(pane_of(labelled_leak.item));
  const {x, y, seen} = pixel_of(world_place(labelled_leak));
  label.hidden = !seen;
  Object.assign(label.style, {left: `${x}px`, top: `${y}px`});
  const deepest = labelled_leak === leaks[0] ? "deepest leak" : "leak";
  label.firstElementChild.textContent = `${deepest} ${distance_text(labelled_leak.depth)}`;
}

// A floor below robots.
function add_floor() {
  const cells = 16;
  const step = round_length(scene_size / 8);
  const floor = new THREE.GridHelper(cells * step, cells);
  Object.assign(floor.material, {vertexColors: THREE.NoColors, transparent: true, opacity: 0.9});
  floor.rotation.x = Math.PI / 2;
  start_box.getCenter(floor.position);
  floor.position.divideScalar(step).round().multiplyScalar(step);
  floor.position.z = start_box.min.z - 1e-3 * scene_size;
  world.add(floor);
  theme_listeners.push(() => floor.material.color.copy(colour("grid")));
}
if (robot_data) add_floor();
