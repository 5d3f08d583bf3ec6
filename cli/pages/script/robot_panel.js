// SPDX-License-Identifier: BSD-3-Clause
// The panel's part for a robot: its joints and its links.
const joint_rows = [];

const position_text = (joint, value) => joint.type === "prismatic"
    ? distance_text(value) : `${length_text(Math.abs(value) < 1e-5 ? 0 : value * 180 / Math.PI)}°`;

// Without the name of the robot, with which names often begin.
function plain_name(name) {
  const start = `${robot_data.name}_`;
  return name.startsWith(start) && name.length > start.length ? name.slice(start.length) : name;
}

function set_configuration(positions) {
  positions.forEach((position, index) => {
    configuration[index] = position;
    joint_rows[index](position);
  });
  place_links();
  refresh();
}

function add_joints() {
  variable_joints.forEach((joint, index) => {
    const readout = node("output", {}, position_text(joint, configuration[index]));
    const step = (joint.upper - joint.lower) / 720 || 1;
    const input = slider(`joint ${joint.name}`, joint.lower, joint.upper, step,
                         configuration[index], (value) => {
                           configuration[index] = value;
                           readout.textContent = position_text(joint, value);
                           place_links();
                           refresh();
                         });
    joint_rows.push((value) => {
      input.set_value(value);
      readout.textContent = position_text(joint, value);
    });
    const line = row(plain_name(joint.name), input, readout);
    line.title = joint.name;
    panel_part("joint-list").append(line);
  });
  const action = (label, positions) => {
    const button = node("button", {type: "button"}, label);
    button.addEventListener("click", () => set_configuration(positions()));
    return button;
  };
  panel_part("joint-actions").append(
      action("rest", () => robot_data.rest),
      action("zero", () => robot_data.zero),
      action("random", () => variable_joints.map(
          (joint) => joint.lower + Math.random() * (joint.upper - joint.lower))));
}

// The postures of a file, one of which is shown; a joint may be moved from there.
function add_postures() {
  const postures = robot_data.postures;
  if (!postures) return;
  const positions = new Float32Array(decode(postures.positions));
  const width = variable_joints.length;
  const last = postures.lines.length - 1;
  const readout = node("output", {});
  const go = (index) => {
    readout.textContent = `line ${postures.lines[index]}`;
    set_configuration(Array.from(positions.subarray(index * width, (index + 1) * width)));
  };
  // As in #posture=2 for the second.
  const first = Math.min(last, Math.max(0, Number(address_options.get("posture") || 1) - 1));
  const line = row("posture", slider(`posture of ${short_name(postures.file)}`, 0, last, 1, first, go),
                   readout);
  line.title = postures.file;
  panel_part("joint-list").prepend(line);
  go(first);
}

// How many spheres a link has, over all sets that are there.
function link_note(link) {
  const sets = items.filter((item) => item.kind === "spheres" || item.kind === "tree");
  const count_in = (item) => item.parts.filter((part) => part.link === link)
                                 .reduce((sum, part) => sum + level_of(item, part).count, 0);
  return sets.map(count_in).join(" / ");
}

// Shows the links that are chosen; set up with the list of links.
let show_links = () => {};

function add_links() {
  const boxes = [];
  const apply = (link, shown) => {
    link_shown[link] = shown;
    boxes[link].checked = shown;
  };
  show_links = (choose) => {
    robot_data.links.forEach((_, index) => apply(index, choose(index)));
    refresh();
  };
  const used = robot_data.links.map((_, link) =>
      items.some((item) => item.parts.some((part) => part.link === link)));
  robot_data.links.forEach((link, index) => {
    const box = node("input", {type: "checkbox", checked: true});
    boxes.push(box);
    if (!used[index]) return;
    box.addEventListener("change", () => {
      link_shown[index] = box.checked;
      refresh();
    });
    const only = node("button", {type: "button", className: "only", title: `Only ${link.name}`},
                      "only");
    only.addEventListener("click", () => show_links((other) => other === index));
    const leak = deepest_of_link(index);
    panel_part("link-list").append(node("div", {className: "link"},
        node("label", {title: link.name}, box,
             node("span", {className: "title"}, plain_name(link.name))), only,
        node("span", {className: "count"}, link_note(index)),
        node("span", {className: "depth"}, leak ? distance_text(leak.depth) : "")));
  });
  const all = node("button", {type: "button"}, "all");
  all.addEventListener("click", () => show_links(() => true));
  const by_link = node("button", {type: "button", "aria-pressed": "false"}, "colour by link");
  by_link.addEventListener("click", () => {
    colours_by_link = !colours_by_link;
    by_link.setAttribute("aria-pressed", String(colours_by_link));
    refresh();
  });
  panel_part("link-actions").append(all, by_link);
}

function add_robot() {
  for (const id of ["joints", "links"]) panel_part(id).hidden = !robot_data;
  if (!robot_data) return;
  add_joints();
  add_postures();
  add_pairs();
  add_links();
}
