// SPDX-License-Identifier: BSD-3-Clause
// Sets of spheres side by side: the scene is drawn once for each set, with what is of that set alone
// (its spheres and its leaks) and all the rest, by one camera.
const kMostPanes = 4;
const pane_sets = items.filter((item) => ["spheres", "tree"].includes(item.kind) && item.shown);
const panes = {on: false};

// Two sets that are about the same thing are meant to be compared.
function start_side_by_side() {
  const wanted = address_options.get("side");
  if (wanted) return wanted === "on";
  const meshes = scene_data.items.filter((item) => item.kind === "mesh" && item.shown).length;
  return pane_sets.length === 2 && pane_sets[0].kind === pane_sets[1].kind &&
      (robot_data ? !scene_data.trajectory : meshes <= 1);
}
const can_stand_side_by_side = pane_sets.length >= 2 && pane_sets.length <= kMostPanes;
panes.on = can_stand_side_by_side && start_side_by_side();

// In which pane an item is; -1 for all of them.
function pane_of(item) {
  if (!panes.on) return -1;
  return pane_sets.findIndex((set) => set === item || (item.of && set.full_name === item.of));
}

// The free area in equal parts, one beside the other, or one below the other where it is narrow.
function pane_areas() {
  const {x, y, width, height} = free_area();
  const count = panes.on ? pane_sets.length : 1;
  const stacked = width < 0.8 * height;
  return Array.from({length: count}, (_, k) => stacked
      ? {x, y: y + height * k / count, width, height: height / count}
      : {x: x + width * k / count, y, width: width / count, height});
}

const pane_at = (x, y) => pane_areas().findIndex(
    (area) => x < area.x + area.width && y < area.y + area.height);

function draw_panes() {
  const areas = pane_areas();
  const is_split = areas.length > 1;
  areas.forEach((area, k) => {
    fit_view(k);
    for (const item of items) {
      const own = pane_of(item);
      for (const part of item.parts) part.group.visible = part.visible && (own < 0 || own === k);
    }
    renderer.setScissorTest(is_split);
    // The first one goes on below the panel.
    const left = k === 0 ? 0 : area.x;
    renderer.setScissor(left, innerHeight - area.y - area.height, area.x + area.width - left, area.height);
    renderer.render(world, camera);
  });
  renderer.setScissorTest(false);
  for (const item of items) for (const part of item.parts) part.group.visible = part.visible;
}

// What is told of a set above it.
function pane_title(set) {
  const words = [set.name, count_text(count_of(set), "sphere")];
  const own = leaks.filter((leak) => leak.item.of === set.full_name);
  if (own.length > 0) words.push(`deepest leak ${distance_text(own[0].depth)}`);
  else if (items.some((item) => item.of === set.full_name)) words.push("no leak found");
  return words;
}

const pane_titles = [];
function place_pane_titles() {
  pane_areas().forEach((area, k) => {
    const title = pane_titles[k];
    if (!title) return;
    Object.assign(title.style, {left: `${area.x}px`, top: `${area.y}px`, width: `${area.width}px`});
  });
}
function tell_panes() {
  for (const title of pane_titles.splice(0)) title.remove();
  if (panes.on) {
    for (const set of pane_sets) {
      const [name, ...rest] = pane_title(set);
      const title = node("div", {className: "pane-title", title: set.full_name},
                         node("div", {}, node("b", {}, name), ...rest.map((text) => node("span", {}, text))));
      document.body.append(title);
      pane_titles.push(title);
    }
  }
  panel_part("side").setAttribute("aria-pressed", String(panes.on));
}
function switch_panes() {
  if (!can_stand_side_by_side) return;
  panes.on = !panes.on;
  tell_panes();
  fit_again();
  refresh();
}
function add_panes() {
  panel_part("side-row").hidden = !can_stand_side_by_side;
  panel_part("side").addEventListener("click", switch_panes);
  tell_panes();
}
