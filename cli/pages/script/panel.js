// SPDX-License-Identifier: BSD-3-Clause
// The panel: what is in the scene, with a switch for each, and how it is cut.
const panel_part = (id) => document.getElementById(id);

function slider(label, min, max, step, value, on_input) {
  const input = node("input", {type: "range", min, max, step, "aria-label": label});
  input.value = value;
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

function row(label, control, readout) {
  return node("div", {className: "row"}, node("span", {className: "name"}, label), control,
              readout || "");
}

function add_item(item) {
  const box = node("input", {type: "checkbox", checked: item.shown});
  const swatch = node("span", {className: `swatch ${item.kind}`});
  const count = node("span", {className: "count"});
  const body = node("div", {className: "more"});
  const card = node("div", {className: "item"},
                    node("label", {title: item.full_name}, box, swatch,
                         node("span", {className: "title"}, item.name), count),
                    body);
  const describe = () => {
    count.textContent = count_text(count_of(item), kNouns[item.kind]);
    swatch.style.background = item_colour(item);
    card.classList.toggle("off", !item.shown);
  };
  box.addEventListener("change", () => {
    item.shown = box.checked;
    describe();
    refresh();
  });
  if (item.facts) body.append(node("p", {className: "note"}, item.facts));
  if (item.level_count > 1) {
    const readout = node("output", {}, "");
    const tell = () => {
      readout.textContent = `${item.level} of ${item.level_count - 1}`;
      describe();
    };
    body.append(row("level", slider(`level of ${item.name}`, 0, item.level_count - 1, 1, item.level,
                                    (value) => {
                                      item.level = value;
                                      tell();
                                      refresh();
                                    }), readout));
    tell();
  }
  if (item.kind !== "leaks") {
    const readout = node("output", {}, "");
    const tell = () => { readout.textContent = `${Math.round(100 * item.alpha)} %`; };
    body.append(row("opacity", slider(`opacity of ${item.name}`, 0.05, 1, 0.05, item.alpha,
                                      (value) => {
                                        item.alpha = value;
                                        tell();
                                        refresh();
                                      }), readout));
    tell();
  }
  describe();
  theme_listeners.push(describe);
  panel_part("items").append(card);
}

function add_cut() {
  const names = ["off", ...kAxes];
  const buttons = names.map((name, index) => {
    const button = node("button", {type: "button"}, name);
    button.addEventListener("click", () => {
      choose_cut(index - 1);
      place.set_value(cut.share);
      tell();
      refresh();
    });
    return button;
  });
  const flip = node("button", {type: "button", title: "Show the other side", className: "flip"},
                    "flip");
  flip.addEventListener("click", () => {
    cut.flipped = !cut.flipped;
    tell();
    refresh();
  });
  const readout = node("output", {}, "");
  const place = slider("place of the cut", 0, 1, 0.002, cut.share, (value) => {
    cut.share = value;
    tell();
    refresh();
  });
  const line = row("at", place, readout);
  function tell() {
    buttons.forEach((button, index) =>
        button.setAttribute("aria-pressed", String(index - 1 === cut.axis)));
    flip.setAttribute("aria-pressed", String(cut.flipped));
    flip.disabled = cut.axis < 0;
    line.hidden = cut.axis < 0;
    const offset = scene_data.middle[Math.max(cut.axis, 0)];
    readout.textContent = distance_text(cut_position() + offset);
  }
  tell();
  panel_part("cut").append(
      node("div", {className: "row"}, node("span", {className: "group"}, ...buttons), flip), line);
}

function add_leaks() {
  panel_part("leaks").hidden = leaks.length === 0;
  add_leak_scale();
  const list = panel_part("leak-list");
  // Of a robot, the deepest of each link.
  const listed = leaks.filter(
      (leak) => leak.part.link < 0 || leak === leaks.find((one) => one.part === leak.part)).slice(0, 8);
  for (const leak of listed) {
    const button = node("button", {type: "button", className: "leak"},
                        node("span", {className: "depth"}, distance_text(leak.depth)),
                        node("span", {className: "where"}, leak_where(leak)));
    button.addEventListener("click", () => look_at_leak(leak));
    list.append(button);
  }
  const rest = leaks.length - listed.length;
  if (rest > 0) {
    list.append(node("p", {className: "note"}, `and ${rest.toLocaleString("en-US")} more`));
  }
}
// Its link, or else its place; of several sets also of which one it is.
function leak_where(leak) {
  const sets = items.filter((item) => item.kind === "leaks").length;
  const place = leak_link(leak) || place_text(leak);
  return sets > 1 ? `${place} · ${leak.item.name.replace(/^leaks: /, "")}` : place;
}
function place_text(leak) {
  const place = leak.point.toArray().map((value, axis) => value + scene_data.middle[axis]);
  return place.map((value) => length_text(Math.abs(value) < 1e-6 * scene_size ? 0 : value))
      .join(", ");
}

function add_heading() {
  const name = robot_data ? robot_data.name : short_name(document.title);
  // A long name may be broken after a stroke.
  document.querySelector("h1").append(...name.split(/(?<=[_\-.])/).flatMap(
      (piece, index) => index > 0 ? [node("wbr"), piece] : [piece]));
  const meshes = box_of_items((item) => item.kind === "mesh");
  const size = (has_mesh ? meshes : start_box).getSize(new THREE.Vector3()).toArray();
  panel_part("size").textContent = robot_data
      ? `${count_text(robot_data.links.length, "link")}, ` +
        `${count_text(variable_joints.length, "joint")}`
      : `${size.map(length_text).join(" × ")}`;
  panel_part("theme").addEventListener("click", switch_theme);
  panel_part("home").addEventListener("click", () => look_from("home"));
  panel_part("fold").addEventListener("click", fold);
  panel_part("unfold").addEventListener("click", fold);
}
function fold() {
  document.body.classList.toggle("bare");
  fit_again();
}
