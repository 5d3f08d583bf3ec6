// SPDX-License-Identifier: BSD-3-Clause
// The panel's part for a robot: its joints, its links, and the links whose spheres overlap.
const joint_rows = [];

const position_text = (joint) => (value) => joint.type === "prismatic"
    ? distance_text(value) : `${length_text(Math.abs(value) < 1e-5 ? 0 : value * 180 / Math.PI)}°`;

// Without the name of the robot, with which names often begin.
function plain_name(name) {
  const start = `${robot_data.name}_`;
  return name.startsWith(start) && name.length > start.length ? name.slice(start.length) : name;
}
const link_name = (link) => plain_name(robot_data.links[link].name);

function set_configuration(positions) {
  positions.forEach((position, index) => {
    configuration[index] = position;
    joint_rows[index].set_value(position);
  });
  place_links();
  refresh();
}

function add_joints() {
  variable_joints.forEach((joint, index) => {
    const {name, lower, upper} = joint;
    const line = told_slider(
        plain_name(name), `joint ${name}`, lower, upper, (upper - lower) / 720 || 1,
        configuration[index], position_text(joint), (value) => {
          configuration[index] = value;
          place_links();
          refresh();
        });
    line.title = name;
    joint_rows.push(line);
  });
  panel_part("joint-list").append(...joint_rows);
  const random = () => variable_joints.map(
      ({lower, upper}) => lower + Math.random() * (upper - lower));
  panel_part("joint-actions").append(
      button("rest", () => set_configuration(robot_data.rest)),
      button("zero", () => set_configuration(robot_data.zero)),
      button("random", () => set_configuration(random())));
}

// The postures of a file, one of which is shown; a joint may be moved from there.
function add_postures() {
  const postures = robot_data.postures;
  if (!postures) return;
  const positions = floats_of(postures.positions);
  const width = variable_joints.length;
  const last = postures.lines.length - 1;
  const go = (k) => set_configuration(Array.from(positions.subarray(k * width, (k + 1) * width)));
  // As in #posture=2 for the second.
  const first = Math.min(last, Math.max(0, Number(address_options.get("posture") || 1) - 1));
  const line = told_slider("posture", `posture of ${short_name(postures.file)}`, 0, last, 1, first,
                           (k) => `line ${postures.lines[k]}`, go);
  line.title = postures.file;
  panel_part("joint-list").prepend(line);
  go(first);
}

// Shows the links that are chosen; set up with the list of links.
let show_links = () => {};

function add_links() {
  const boxes = robot_data.links.map((_, link) => node("input", {
    type: "checkbox", checked: true, onchange: () => {
      link_shown[link] = boxes[link].checked;
      refresh();
    }}));
  show_links = (choose) => {
    boxes.forEach((box, link) => { link_shown[link] = box.checked = choose(link); });
    refresh();
  };
  robot_data.links.forEach(({name}, link) => {
    const parts_of = (item) => item.parts.filter((part) => part.link === link);
    if (items.every((item) => parts_of(item).length === 0)) return;
    const only = button("only", () => show_links((other) => other === link),
                        {className: "only", title: `Only ${name}`});
    const leak = leaks.find((one) => one.part.link === link);
    panel_part("link-list").append(node("div", {className: "link"},
        node("label", {title: name}, boxes[link], span("title", plain_name(name))), only,
        // How many spheres it has in each set.
        span("count", sets.map((item) => count_of(item, parts_of(item))).join(" / ")),
        span("depth", leak ? distance_text(leak.depth) : "")));
  });
  const by_link = button("colour by link", () => {
    colours_by_link = !colours_by_link;
    show_pressed(by_link, colours_by_link);
    refresh();
  }, {"aria-pressed": "false"});
  panel_part("link-actions").append(button("all", () => show_links(() => true)), by_link);
}

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
      const [x, y, z, radius] = spheres.subarray(i, i + 4);
      const gap = Math.hypot(x - center.x, y - center.y, z - center.z);
      deepest = Math.max(deepest, radius + others[k + 3] - gap);
    }
  }
  return deepest;
}

// What the kind of a pair comes to where the robot stands, and whether a test would tell of it.
function standing_of(pair) {
  if (pair.boxes && in_free_box(pair.boxes, configuration)) {
    return {text: "proved free here", tested: false};
  }
  const touching = pair.verdict === "touching" ? "can touch" : "unknown";
  const text = pair.boxes ? touching : pair.kind;
  return {text, tested: ["can touch", "unknown", "tested"].includes(text)};
}

// The pairs are those of the first set of spheres. Links that are joined overlap at their joint.
function overlapping_pairs(item) {
  const found = [];
  for (const pair of robot_data.pairs) {
    if (pair.kind === "rigid" || pair.kind === "adjacent") continue;
    const [first, second] = pair.links.map((link) => item.parts.find((part) => part.link === link));
    if (!first || !second) continue;
    const matrix = new THREE.Matrix4().getInverse(link_frames[first.link].matrixWorld)
                       .multiply(link_frames[second.link].matrixWorld);
    const depth_at = (level_in) =>
        overlap_depth(level_in(first).spheres, level_in(second).spheres, matrix);
    if (depth_at((part) => part.levels[0]) < 0) continue;
    const depth = depth_at(last_level);
    if (depth >= 0) found.push({pair, depth, ...standing_of(pair)});
  }
  return found.sort((a, b) => b.tested - a.tested || b.depth - a.depth);
}

function add_pairs() {
  const of_pairs = sets.find((item) => robot_data.pairs && item.full_name === robot_data.pairs_of);
  panel_part("pairs").hidden = !of_pairs;
  if (!of_pairs) return;
  panel_part("pairs").title = of_pairs.full_name;
  const show = () => {
    const found = overlapping_pairs(of_pairs);
    const tested = found.filter((entry) => entry.tested).length;
    panel_part("pair-note").textContent = found.length === 0
        ? "No two links overlap by their spheres."
        : `${count_text(found.length, "pair")} overlap by their spheres, ${tested} of them tested.`;
    panel_part("pair-list").replaceChildren(...found.map((one) => node(
        "div", {className: one.tested ? "pair tested" : "pair"},
        span("title", one.pair.links.map(link_name).join(", ")), span("count", one.text),
        span("depth", distance_text(one.depth)))));
  };
  pose_listeners.push(show);
  show();
}

function add_robot() {
  for (const id of ["joints", "links"]) panel_part(id).hidden = !robot_data;
  if (!robot_data) return;
  add_joints();
  add_postures();
  add_pairs();
  add_links();
}
