// SPDX-License-Identifier: BSD-3-Clause
// Leaks as a list, the deepest first. A leak is a ball about its point: its radius is the depth,
// the distance from the point to the nearest sphere.
const leaks = [];
for (const item of items.filter((one) => one.kind === "leaks")) {
  for (const part of item.parts) {
    const balls = balls_of(part.levels[0]);
    for (let i = 0; i < balls.length; i += 4) {
      leaks.push({item, part, point: new THREE.Vector3().fromArray(balls, i), depth: balls[i + 3]});
    }
  }
}
leaks.sort((a, b) => b.depth - a.depth);

const leak_place = (leak) =>
    leak.point.clone().applyMatrix4(frame_of(leak.part.link).matrixWorld);
const leak_shown = (leak) =>
    leak.item.shown && (leak.part.link < 0 || link_shown[leak.part.link]);
const leak_link = (leak) => leak.part.link >= 0 ? robot_data.links[leak.part.link].name : "";

// The one with a label in the scene.
let labelled_leak = leaks[0] || null;

function deepest_of_link(link) {
  return leaks.find((leak) => leak.part.link === link) || null;
}
