// SPDX-License-Identifier: BSD-3-Clause
// The contacts of the configuration shown: a mark at each point, the two spheres that touch in red,
// and names and depth beside it.
const kContactPixels = 5;
const kMostContactLabels = 5;
const contact_marks = new THREE.Group();
world.add(contact_marks);
const contact_materials = make_sphere_materials(1100, {
  least_radius: {value: kContactPixels}, greatest_radius: {value: 0}, cut: not_cut,
}, {depthTest: false, depthWrite: false});
set_alpha(contact_materials, 0.95);
const touching_materials = make_sphere_materials(1050, {cut: not_cut}, {depthWrite: false});
set_alpha(touching_materials, 0.75);
theme_listeners.push(() => {
  for (const materials of [contact_materials, touching_materials]) {
    materials.colour.uniforms.base.value.set(theme().leak);
  }
});

let shown_contacts = [];
const touching_drawings = [];
const contact_labels = [];

// The sphere that a contact names, by link, tree among the link's, and index: x, y, z, radius.
const checked_item = items.find((item) => item.checked);
function checked_sphere([link, tree, sphere]) {
  if (!checked_item || link < 0 || sphere < 0) return null;
  const part = checked_item.parts.filter((one) => one.link === link)[tree];
  if (!part) return null;
  return spheres_of(part.levels[part.levels.length - 1]).slice(4 * sphere, 4 * sphere + 4);
}

function clear_contacts() {
  for (const drawing of touching_drawings.splice(0)) {
    drawing.parent.remove(drawing);
    drawing.geometry.dispose();
  }
  for (const mark of contact_marks.children.slice()) {
    contact_marks.remove(mark);
    mark.geometry.dispose();
  }
  for (const label of contact_labels.splice(0)) label.remove();
}

function show_contacts(contacts) {
  clear_contacts();
  shown_contacts = contacts;
  contacts.forEach((contact, index) => {
    contact_marks.add(sphere_drawing([...contact.place.toArray(), 0], contact_materials.colour, 2600));
    for (const named of contact.spheres) {
      const sphere = checked_sphere(named);
      if (!sphere) continue;
      sphere[3] *= 1.004;  // in front of its own
      const drawing = sphere_drawing(sphere, touching_materials.colour, 2500);
      link_frames[named[0]].add(drawing);
      touching_drawings.push(drawing);
    }
    if (index >= kMostContactLabels) return;
    const label = node("div", {className: "contact-label"},
                       `${contact.names.map(plain_name).join(" – ")} ${distance_text(contact.depth)}`);
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
    label.style.visibility = seen ? "visible" : "hidden";
    label.style.left = `${Math.max(4, x + 16 + width > innerWidth ? x - 16 - width : x + 16)}px`;
    label.style.top = `${top}px`;
    if (seen) lowest = top;
  }
}
