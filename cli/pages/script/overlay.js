// SPDX-License-Identifier: BSD-3-Clause
// What lies over the picture: the axes of the world, a length to compare with, a leak's label, and
// in the scene a floor below robots.
const kArm = 26;  // pixels
const kSvg = "http://www.w3.org/2000/svg";
function svg(tag, attributes) {
  const made = document.createElementNS(kSvg, tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, value);
  return made;
}

const axis_marks = kAxes.map((name) => {
  const line = svg("line", {"stroke-width": 2.5, "stroke-linecap": "round"});
  const text = svg("text", {"text-anchor": "middle", "dominant-baseline": "central"});
  text.textContent = name;
  document.getElementById("axes").append(line, text);
  return {line, text};
});

function place_axes() {
  const to_eye = camera.quaternion.clone().inverse();
  axis_marks.forEach(({line, text}, axis) => {
    const tip = new THREE.Vector3().setComponent(axis, 1).applyQuaternion(to_eye);
    const colour_text = theme().lines[axis];
    for (const [name, value] of Object.entries(
        {x2: tip.x * kArm, y2: -tip.y * kArm, stroke: colour_text})) line.setAttribute(name, value);
    for (const [name, value] of Object.entries(
        {x: tip.x * (kArm + 9), y: -tip.y * (kArm + 9), fill: colour_text})) {
      text.setAttribute(name, value);
    }
  });
}

function place_scale() {
  const pixel = length_of_pixel();
  const length = round_length(140 * pixel);
  document.getElementById("bar").style.width = `${length / pixel}px`;
  document.getElementById("length").textContent = distance_text(length);
}

function place_label() {
  const label = document.getElementById("label");
  label.hidden = !(labelled_leak && leak_shown(labelled_leak));
  if (label.hidden) return;
  fit_view(pane_of(labelled_leak.item));
  const place = pixel_of(world_place(labelled_leak));
  label.hidden = !place.seen;
  label.style.left = `${place.x}px`;
  label.style.top = `${place.y}px`;
  const deepest = labelled_leak === leaks[0] ? "deepest leak" : "leak";
  label.firstElementChild.textContent = `${deepest} ${distance_text(labelled_leak.depth)}`;
}

const floor_material = new THREE.LineBasicMaterial({transparent: true, opacity: 0.9});
function make_floor() {
  const step = round_length(scene_size / 8);
  const middle = start_box.getCenter(new THREE.Vector3());
  const reach = 8;
  const ends = [];
  const [x, y] = [Math.round(middle.x / step), Math.round(middle.y / step)];
  for (let i = -reach; i <= reach; ++i) {
    ends.push((x + i) * step, (y - reach) * step, 0, (x + i) * step, (y + reach) * step, 0);
    ends.push((x - reach) * step, (y + i) * step, 0, (x + reach) * step, (y + i) * step, 0);
  }
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(ends), 3));
  const floor = new THREE.LineSegments(geometry, floor_material);
  floor.position.z = start_box.min.z - 1e-3 * scene_size;
  return floor;
}
if (robot_data) world.add(make_floor());
theme_listeners.push(() => floor_material.color.set(theme().grid));
