// SPDX-License-Identifier: BSD-3-Clause
// Leaks as a list, the deepest first. Each is a mark at its point, and the one with the label also a
// sphere about it, as large as it is deep: the depth is the distance to the nearest sphere.
const leaks = [];
for (const item of items.filter((one) => one.kind === "leaks")) {
  for (const part of item.parts) {
    const spheres = spheres_of(part.levels[0]);
    for (let i = 0; i < spheres.length; i += 4) {
      leaks.push({item, part, point: new THREE.Vector3().fromArray(spheres, i), depth: spheres[i + 3]});
    }
  }
}
leaks.sort((a, b) => b.depth - a.depth);

const leak_shown = (leak) =>
    leak.item.shown && (leak.part.link < 0 || link_shown[leak.part.link]);
const leak_link = (leak) => leak.part.link >= 0 ? robot_data.links[leak.part.link].name : "";

// The one with a label in the scene.
let labelled_leak = null;

const depth_materials = make_sphere_materials(1000, {cut: not_cut}, {depthWrite: false});
let depth_sphere = null;
function label_leak(leak) {
  if (depth_sphere) depth_sphere.parent.remove(depth_sphere);
  labelled_leak = leak;
  if (!leak) return;
  depth_sphere = sphere_drawing([...leak.point.toArray(), leak.depth], depth_materials.colour, 1500);
  leak.part.group.add(depth_sphere);
}
set_alpha(depth_materials, 0.3);
theme_listeners.push(() => depth_materials.colour.uniforms.base.value.set(theme().leak));
label_leak(leaks[0] || null);

function deepest_of_link(link) {
  return leaks.find((leak) => leak.part.link === link) || null;
}
