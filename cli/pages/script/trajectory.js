// SPDX-License-Identifier: BSD-3-Clause
// A trajectory and what the check of it found; nothing is checked anew here. A place on it is a
// number: k at the k-th configuration shown, between two of them on the motion between these.
const trajectory = scene_data.trajectory && {
  ...scene_data.trajectory,
  lines: integers_of(scene_data.trajectory.lines),
  positions: floats_of(scene_data.trajectory.positions),
  clearance: floats_of(scene_data.trajectory.clearance),
  nearest: integers_of(scene_data.trajectory.nearest),
  points: scene_data.trajectory.points.map(
      ([at, line, to_line, fraction, positions, contacts]) =>
          ({at, line, to_line, fraction, positions, contacts})),
  last: scene_data.trajectory.shown - 1,
};
let place_on_trajectory = 0;

// The best verdict first.
const kVerdicts = {f: "free", u: "not proved", l: "outside limits", c: "collision"};
const kVerdictRank = Object.keys(kVerdicts).join("");

// The numbers of the k-th configuration.
function shown_configuration(k) {
  const width = variable_joints.length;
  return trajectory.positions.subarray(k * width, (k + 1) * width);
}

// Straight in the numbers, continuous joints by the shorter way where that was checked.
function configuration_at(at) {
  const k = Math.min(Math.floor(at), Math.max(trajectory.last - 1, 0));
  const from = shown_configuration(k);
  const to = shown_configuration(Math.min(k + 1, trajectory.last));
  return variable_joints.map((joint, i) => {
    let step = to[i] - from[i];
    if (trajectory.shortest && joint.type === "continuous") {
      step -= 2 * Math.PI * Math.round(step / (2 * Math.PI));
    }
    return from[i] + (at - k) * step;
  });
}

// The worst verdict between two places: of the motions between them, or the configurations nearest.
function worst_verdict(from, to) {
  const cells = trajectory.verdicts;
  const shift = trajectory.motions ? 0 : 0.5;
  const first = Math.min(cells.length - 1, Math.max(0, Math.floor(from + shift)));
  const last = Math.max(first, Math.ceil(to + shift) - 1);
  const ranks = Array.from(cells.slice(first, last + 1), (letter) => kVerdictRank.indexOf(letter));
  return kVerdictRank[Math.max(...ranks)];
}

// Contacts are known where the check computed them: at configurations, and where motions first
// touch. Of these the one nearest to a place; none if that is a free configuration.
function point_near(at) {
  const distance = (point) => Math.abs(point.at - at);
  const best = trajectory.points.reduce(
      (a, b) => a && distance(a) <= distance(b) ? a : b, undefined);
  return best && distance(best) <= Math.abs(Math.round(at) - at) + 1e-6 ? best : undefined;
}

function next_point(at, direction) {
  const ahead = trajectory.points.filter((point) => direction * (point.at - at) > 1e-6);
  return direction > 0 ? ahead[0] : ahead[ahead.length - 1];
}

// Where on the file, for a person.
const motion_text = (line, to_line, percent) => `line ${line} → ${to_line}, ${percent} %`;
function line_text(at) {
  const k = Math.min(Math.floor(at), trajectory.last);
  const share = at - k;
  if (share < 1e-6 || k >= trajectory.last) return `line ${trajectory.lines[k]}`;
  return motion_text(trajectory.lines[k], trajectory.lines[k + 1], Math.round(100 * share));
}
const point_text = ({line, to_line, fraction}) =>
    to_line === 0 ? `line ${line}` : motion_text(line, to_line, length_text(100 * fraction));

// The contacts of a point, the deepest first.
const kContactWidth = 12;
function contacts_of(point) {
  const numbers = floats_of(point.contacts);
  return Array.from({length: numbers.length / kContactWidth}, (_, k) => {
    const [first, second, depth, ...rest] =
        numbers.subarray(k * kContactWidth, (k + 1) * kContactWidth);
    const name_of = (index) => plain_name(trajectory.bodies[index]);
    return {names: `${name_of(first)} – ${name_of(second)}`, depth,
            place: new THREE.Vector3().fromArray(rest),
            spheres: [rest.slice(3, 6), rest.slice(6, 9)]};
  });
}

// The contacts of the configuration shown: a mark at each point, the two spheres that touch in red,
// and names and depth beside it.
const kContactPixels = 5;
const kMostContactLabels = 5;
const contact_materials = make_sphere_materials(1100, {
  least_radius: {value: kContactPixels}, greatest_radius: {value: 0}, cut: not_cut,
}, {depthTest: false, depthWrite: false});
const touching_materials = make_sphere_materials(1050, {cut: not_cut}, {depthWrite: false});
set_alpha(contact_materials, 0.95);
set_alpha(touching_materials, 0.75);
theme_listeners.push(() => {
  for (const {colour: front} of [contact_materials, touching_materials]) {
    front.uniforms.base.value.copy(colour("leak-deep"));
  }
});

let shown_contacts = [];
const contact_drawings = [];
const contact_labels = [];

// The sphere that a contact names, by link, tree among the link's, and index: x, y, z, radius.
const checked_item = items.find((item) => item.checked);
function checked_sphere([link, tree, sphere]) {
  if (!checked_item || link < 0 || sphere < 0) return null;
  const part = checked_item.parts.filter((one) => one.link === link)[tree];
  return part ? last_level(part).spheres.slice(4 * sphere, 4 * sphere + 4) : null;
}

function show_contacts(contacts) {
  for (const drawing of contact_drawings.splice(0)) {
    drawing.parent.remove(drawing);
    drawing.geometry.dispose();
  }
  for (const label of contact_labels.splice(0)) label.remove();
  const add = (frame, numbers, materials, order) => {
    const drawing = sphere_drawing(numbers, materials.colour, order);
    frame.add(drawing);
    contact_drawings.push(drawing);
  };
  shown_contacts = contacts;
  contacts.forEach((contact, index) => {
    add(world, [...contact.place.toArray(), 0], contact_materials, 2600);
    for (const named of contact.spheres) {
      const sphere = checked_sphere(named);
      if (!sphere) continue;
      sphere[3] *= 1.004;  // in front of its own
      add(link_frames[named[0]], sphere, touching_materials, 2500);
    }
    if (index >= kMostContactLabels) return;
    const label = node("div", {className: "contact-label"},
                       `${contact.names} ${distance_text(contact.depth)}`);
    document.body.append(label);
    contact_labels.push(label);
  });
  redraw();
}

// Labels beside their points, one below the other where they would lie over each other.
function place_contact_labels() {
  fit_view();
  const shown = contact_labels.map((label, index) => {
    return {label, ...pixel_of(shown_contacts[index].place)};
  });
  shown.sort((a, b) => a.y - b.y);
  const kApart = 26;
  let lowest = -Infinity;
  for (const {label, x, y, seen} of shown) {
    const top = Math.max(y - 12, lowest + kApart);
    const width = label.offsetWidth;
    const left = Math.max(4, x + 16 + width > innerWidth ? x - 16 - width : x + 16);
    const visibility = seen ? "visible" : "hidden";
    Object.assign(label.style, {visibility, left: `${left}px`, top: `${top}px`});
    if (seen) lowest = top;
  }
}
