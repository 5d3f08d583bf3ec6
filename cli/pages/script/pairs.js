// SPDX-License-Identifier: BSD-3-Clause
// Pairs of links whose spheres overlap where the robot stands, and what is known of each.
const pair_data = robot_data && robot_data.pairs || [];

// Where the second half of each halved box stands among the nodes; the first one follows it.
function second_halves(nodes) {
  const second = new Int32Array(nodes.length);
  const open = [];
  for (let i = 0; i < nodes.length; ++i) {
    if (nodes[i] > "B") {
      open.push(i);
      continue;
    }
    while (open.length > 0 && second[open[open.length - 1]] > 0) open.pop();
    if (open.length > 0) second[open[open.length - 1]] = i + 1;
  }
  return second;
}

// Whether positions lie in a box that is proved free.
function in_free_box(boxes, positions) {
  if (!boxes.second) boxes.second = second_halves(boxes.nodes);
  const ranges = boxes.variables.map(({lower, upper}) => [lower, upper]);
  const values = boxes.variables.map(({index, wraps}) => {
    const turns = wraps ? Math.round(positions[index] / (2 * Math.PI)) : 0;
    return positions[index] - turns * 2 * Math.PI;
  });
  if (values.some((value, v) => value < ranges[v][0] || value > ranges[v][1])) return false;
  let at = 0;
  while (boxes.nodes[at] > "B") {
    const variable = boxes.nodes.charCodeAt(at) - "C".charCodeAt(0);
    const middle = 0.5 * (ranges[variable][0] + ranges[variable][1]);
    const is_first = values[variable] <= middle;
    ranges[variable][is_first ? 1 : 0] = middle;
    at = is_first ? at + 1 : boxes.second[at];
  }
  return boxes.nodes[at] === "B";
}

// How deep the deepest two of two lists of spheres overlap, in lengths of the scene; `matrix` takes
// the second ones into the frame of the first.
function overlap_depth(spheres, others, matrix) {
  const center = new THREE.Vector3();
  let deepest = -Infinity;
  for (let k = 0; k < others.length; k += 4) {
    center.fromArray(others, k).applyMatrix4(matrix);
    for (let i = 0; i < spheres.length; i += 4) {
      const gap = Math.hypot(spheres[i] - center.x, spheres[i + 1] - center.y, spheres[i + 2] - center.z);
      deepest = Math.max(deepest, spheres[i + 3] + others[k + 3] - gap);
    }
  }
  return deepest;
}

// What the kind of a pair comes to where the robot stands, and whether a test would tell of it.
function standing_of(pair) {
  if (pair.boxes && in_free_box(pair.boxes, configuration)) {
    return {text: "proved free here", tested: false};
  }
  if (pair.boxes) return {text: pair.verdict === "touching" ? "can touch" : "unknown", tested: true};
  return {text: pair.kind, tested: ["can touch", "unknown", "tested"].includes(pair.kind)};
}

// The pairs are those of the first set of spheres. Links that are joined overlap at their joint.
const pair_item = pair_data.length > 0 &&
    items.find((item) => item.kind === "tree" && item.full_name === robot_data.pairs_of);
function overlapping_pairs() {
  const part_of = (link) => pair_item.parts.find((part) => part.link === link);
  const found = [];
  for (const pair of pair_data) {
    if (pair.kind === "rigid" || pair.kind === "adjacent") continue;
    const [first, second] = pair.links.map(part_of);
    if (!first || !second) continue;
    const matrix = new THREE.Matrix4().getInverse(link_frames[first.link].matrixWorld)
                       .multiply(link_frames[second.link].matrixWorld);
    const depth_at = (level_in) =>
        overlap_depth(spheres_of(level_in(first)), spheres_of(level_in(second)), matrix);
    if (depth_at((part) => part.levels[0]) < 0) continue;
    const depth = depth_at((part) => part.levels[part.levels.length - 1]);
    if (depth >= 0) found.push({pair, depth, ...standing_of(pair)});
  }
  return found.sort((a, b) => b.tested - a.tested || b.depth - a.depth);
}

function show_pairs() {
  const found = overlapping_pairs();
  const tested = found.filter((entry) => entry.tested).length;
  panel_part("pair-note").textContent = found.length === 0 ? "No two links overlap by their spheres."
      : `${count_text(found.length, "pair")} overlap by their spheres, ${tested} of them tested.`;
  panel_part("pair-list").replaceChildren(...found.map(({pair, depth, text, tested}) => {
    const names = pair.links.map((link) => plain_name(robot_data.links[link].name)).join(", ");
    return node("div", {className: tested ? "pair tested" : "pair"},
                node("span", {className: "title"}, names), node("span", {className: "count"}, text),
                node("span", {className: "depth"}, distance_text(depth)));
  }));
}

function add_pairs() {
  panel_part("pairs").hidden = !pair_item;
  if (!pair_item) return;
  panel_part("pairs").title = pair_item.full_name;
  pose_listeners.push(show_pairs);
  show_pairs();
}
