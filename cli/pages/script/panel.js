// SPDX-License-Identifier: BSD-3-Clause
// The panel: what is in the scene, with a switch for each, how it is cut, and where it leaks.
function slider(label, min, max, step, value, on_input) {
  const input = node("input", {type: "range", min, max, step, "aria-label": label, value});
  const show = () => input.style.setProperty(
      "--share", `${100 * (input.value - min) / Math.max(max - min, 1e-12)}%`);
  input.addEventListener("input", () => {
    show();
    on_input(Number(input.value));
  });
  input.set_value = (next) => {
    input.value = next;
    show();
  };
  show();
  return input;
}

const row = (label, ...controls) =>
    node("div", {className: "row"}, span("name", label), ...controls);

// A slider whose value is told beside it.
function told_slider(label, full_label, min, max, step, value, to_text, on_input) {
  const readout = node("output", {}, to_text(value));
  const input = slider(full_label, min, max, step, value, (next) => {
    readout.textContent = to_text(next);
    on_input(next);
  });
  const line = row(label, input, readout);
  line.set_value = (next) => {
    input.set_value(next);
    readout.textContent = to_text(next);
  };
  return line;
}

function add_item(item) {
  const box = node("input", {type: "checkbox", checked: item.shown});
  const swatch = span(`swatch ${item.kind}`);
  const count = span("count");
  const body = node("div", {className: "more"});
  const card = node("div", {className: "item"},
                    node("label", {title: item.full_name}, box, swatch,
                         span("title", item.name), count),
                    body);
  const describe = () => {
    count.textContent = count_text(count_of(item), kNouns[item.kind]);
    swatch.style.background = `var(--${item_colour(item)})`;
    card.classList.toggle("off", !item.shown);
  };
  const add_slider = (label, name, min, max, step, to_text) => body.append(told_slider(
      label, `${label} of ${item.name}`, min, max, step, item[name], to_text, (value) => {
        item[name] = value;
        describe();
        refresh();
      }));
  box.addEventListener("change", () => {
    item.shown = box.checked;
    describe();
    refresh();
  });
  if (item.facts) body.append(node("p", {className: "note"}, item.facts));
  const last = item.level_count - 1;
  if (last > 0) add_slider("level", "level", 0, last, 1, (level) => `${level} of ${last}`);
  if (item.kind !== "leaks") {
    add_slider("opacity", "alpha", 0.05, 1, 0.05, (alpha) => `${Math.round(100 * alpha)} %`);
  }
  describe();
  panel_part("items").append(card);
}

function add_cut() {
  const change = (action) => () => {
    action();
    tell();
    refresh();
  };
  const buttons = ["off", ...kAxes].map((name, k) => button(name, change(() => choose_cut(k - 1))));
  const flip = button("flip", change(() => { cut.flipped = !cut.flipped; }),
                      {title: "Show the other side", className: "flip"});
  const line = told_slider(
      "at", "place of the cut", 0, 1, 0.002, cut.share,
      () => distance_text(cut_position() + scene_data.middle[Math.max(cut.axis, 0)]),
      (share) => change(() => { cut.share = share; })());
  function tell() {
    buttons.forEach((one, k) => show_pressed(one, k - 1 === cut.axis));
    show_pressed(flip, cut.flipped);
    flip.disabled = line.hidden = cut.axis < 0;
    line.set_value(cut.share);
  }
  tell();
  panel_part("cut").append(
      node("div", {className: "row"}, span("group", ...buttons), flip), line);
}

// A button with a depth in red and what it is of, which goes there.
const depth_button = (depth, what, go) =>
    button([span("depth", distance_text(depth)), span("where", what)], go, {className: "leak"});

function add_leaks() {
  panel_part("leaks").hidden = leaks.length === 0;
  // What the colours stand for.
  panel_part("leak-scale").hidden = !has_leak_surface;
  panel_part("deepest").textContent = distance_text(deepest_leak.value);
  // Of a robot, the deepest of each link.
  const deepest_of = (part) => leaks.find((one) => one.part === part);
  const listed = leaks.filter(
      (leak) => leak.part.link < 0 || leak === deepest_of(leak.part)).slice(0, 8);
  panel_part("leak-list").append(...listed.map(
      (leak) => depth_button(leak.depth, leak_where(leak), () => look_at_leak(leak))));
  const rest = leaks.length - listed.length;
  if (rest > 0) {
    panel_part("leak-list").append(node("p", {className: "note"}, `and ${number_text(rest)} more`));
  }
}
// Its link, or else its place; of several sets also of which one it is.
function leak_where(leak) {
  const place = leak.part.link >= 0 ? robot_data.links[leak.part.link].name
      : leak.point.toArray().map((value, axis) => value + scene_data.middle[axis])
            .map((value) => length_text(Math.abs(value) < 1e-6 * scene_size ? 0 : value))
            .join(", ");
  return items.filter((item) => item.kind === "leaks").length > 1
      ? `${place} · ${leak.item.name.replace(/^leaks: /, "")}` : place;
}

function add_heading() {
  const name = robot_data ? robot_data.name : short_name(document.title);
  // A long name may be broken after a stroke.
  document.querySelector("h1").append(...name.split(/(?<=[_\-.])/).flatMap(
      (piece) => [node("wbr", {}), piece]));
  const box = has_mesh ? box_of_items((item) => item.kind === "mesh") : start_box;
  panel_part("size").textContent = robot_data
      ? `${count_text(robot_data.links.length, "link")}, ` +
        `${count_text(variable_joints.length, "joint")}`
      : box.getSize(new THREE.Vector3()).toArray().map(length_text).join(" × ");
  const actions = {theme: switch_theme, home: () => look_from("home"), fold, unfold: fold,
                   side: switch_panes};
  for (const [id, action] of Object.entries(actions)) {
    panel_part(id).addEventListener("click", action);
  }
}
function fold() {
  document.body.classList.toggle("bare");
  fit_again();
}
