// SPDX-License-Identifier: BSD-3-Clause
// The things to look at. Each has parts, one for every link of a robot that has it, otherwise one.
// Marks of leaks: their least radius in pixels, and their greatest as a share of the scene.
const kLeakPixels = 2.5;
const kLeakShare = 0.003;

// Meshes are drawn first, then spheres, external spheres over them, and leaks at last.
const kKindRank = {mesh: 0, spheres: 1, tree: 1, external: 2, leaks: 3};
// Surfaces of leaks come right after the meshes, which they are parts of (make_body() doubles orders).
const kLeakSurfaceOrder =
    2 * scene_data.items.filter((item) => item.kind === "mesh").length - 0.5;
const link_shown = link_frames.map(() => true);
let colours_by_link = false;

function make_item(data, order) {
  const item = {
    name: short_name(data.name), full_name: data.name, kind: data.kind, facts: data.facts || "",
    shown: data.shown, checked: data.checked || false, of: data.of || "", order,
    colour_slot: 0, alpha: 1, level: 0, level_count: 1, parts: [],
  };
  for (const part_data of data.parts) {
    const part = {link: part_data.link, name: part_data.name || "",
                  background: part_data.background || false, levels: [], box: new THREE.Box3()};
    part.group = new THREE.Group();
    frame_of(part.link).add(part.group);
    if (item.kind === "mesh") {
      part.materials = make_surface_materials(order);
      part.edge_material = make_line_material(1.1, 1e-4, true);
      const surface = make_surface(part_data, part.materials, part.edge_material, order);
      Object.assign(part, {box: surface.box, triangles: surface.triangles});
      part.levels = [{count: surface.count, body: surface.body}];
      part.outline = make_lines(new Float32Array(0), item_outline_material, 1000);
      part.group.add(surface.body, part.outline);
    } else {
      part.materials = make_sphere_materials(order, sphere_uniforms(item.kind));
      part.levels = part_data.levels.map((text) => ({count: text_count(text), text, body: null}));
      part.surface = make_leak_surface(part_data, kLeakSurfaceOrder);
      if (part.surface) part.group.add(part.surface);
    }
    item.parts.push(part);
    item.level_count = Math.max(item.level_count, part.levels.length);
  }
  item.level = item.level_count - 1;
  return item;
}

// Circles of many thousands of external spheres would blacken. Marks may stand wherever the cut is.
const not_cut = {value: new THREE.Vector4(0, 0, 0, 1)};
const leak_radius = {value: 1e30};
function sphere_uniforms(kind) {
  if (kind === "external") return {ring_tint: {value: 0.74}};
  return kind === "leaks" ? {least_radius: {value: kLeakPixels}, greatest_radius: leak_radius} : {};
}

// Spheres in a base64 text, 16 bytes each.
function text_count(text) {
  const padding = text.endsWith("==") ? 2 : text.endsWith("=") ? 1 : 0;
  return (text.length / 4 * 3 - padding) / 16;
}

const item_outline_material = make_line_material(2.4, 1e-3, false);

const level_of = (item, part) => part.levels[Math.min(item.level, part.levels.length - 1)];
const count_of = (item) =>
    item.parts.reduce((sum, part) => sum + level_of(item, part).count, 0);
const kNouns = {mesh: "triangle", spheres: "sphere", tree: "sphere", external: "sphere",
                leaks: "leak"};

// Levels are decoded when they are first shown.
function spheres_of(level) {
  if (!level.spheres) {
    level.spheres = new Float32Array(decode(level.text));
    level.text = null;
  }
  return level.spheres;
}
function load_level(item, part) {
  const level = level_of(item, part);
  if (level.body || level.count === 0 || part.surface) return;
  level.body = make_body(make_sphere_geometry(spheres_of(level)), part.materials, item.order);
  part.group.add(level.body);
  if (item.kind === "leaks") add_ghost(item, level, part);
}

// Leaks of which only points are known shine through what is before them.
function add_ghost(item, level, part) {
  part.ghost = make_sphere_materials(item.order, sphere_uniforms(item.kind),
                                   {depthTest: false, depthWrite: false}).colour;
  part.ghost.uniforms.alpha.value = 0.25;
  const ghost = new THREE.Mesh(level.body.children[0].geometry, part.ghost);
  ghost.frustumCulled = false;
  ghost.renderOrder = 2000;
  level.body.add(ghost);
}

const items = scene_data.items
    .map((data, index) => ({data, index}))
    .sort((a, b) => kKindRank[a.data.kind] - kKindRank[b.data.kind] || a.index - b.index)
    .map(({data}, order) => make_item(data, order));
const has_mesh = items.some((item) => item.kind === "mesh");
{
  let sets = 0;
  for (const item of items) {
    if (item.kind === "spheres" || item.kind === "tree") {
      item.colour_slot = sets++;
      if (has_mesh) item.alpha = 0.55;
    }
    if (item.kind === "external") item.alpha = 0.3;
    for (const part of item.parts) {
      for (const level of item.kind === "mesh" ? [] : [part.levels[part.levels.length - 1]]) {
        part.box = box_of(spheres_of(level), 4);
      }
    }
  }
}

function item_colour(item) {
  if (item.kind === "mesh" && item.parts.some((part) => part.name)) return theme().obstacle;
  if (item.kind === "mesh" || item.kind === "external") return theme()[item.kind];
  if (item.kind === "leaks") return theme().leak;
  return theme().spheres[item.colour_slot % theme().spheres.length];
}

// Neighbouring links differ clearly: each hue is a golden section of the circle from the last.
function part_colour(item, part) {
  if (!colours_by_link || part.link < 0 || !["spheres", "tree"].includes(item.kind)) {
    return colour(item_colour(item));
  }
  return new THREE.Color().setHSL((0.58 + part.link * 0.381966) % 1, 0.55,
                                  theme_name() === "dark" ? 0.6 : 0.52);
}

// Carries the state of all items over to what is drawn.
function apply_items() {
  for (const item of items) {
    for (const part of item.parts) {
      const visible = item.shown && (part.link < 0 || link_shown[part.link]);
      part.visible = part.group.visible = visible;
      if (!visible) continue;
      if (item.kind !== "mesh") load_level(item, part);
      for (const level of part.levels) {
        if (level.body) level.body.visible = level === level_of(item, part);
      }
      const tint = part_colour(item, part);
      part.materials.colour.uniforms.base.value.copy(tint);
      set_alpha(part.materials, item.alpha);
      if (part.ghost) part.ghost.uniforms.base.value.copy(tint);
      if (part.edge_material) {
        part.edge_material.uniforms.base.value.copy(colour(theme().edge));
        part.edge_material.uniforms.alpha.value = 0.75 * item.alpha;
      }
    }
  }
  item_outline_material.uniforms.base.value.copy(colour(theme().outline));
}

// Where a point of a part is in the world.
const world_place = ({part, point}) => point.clone().applyMatrix4(frame_of(part.link).matrixWorld);

// Where the items of a choice are, with the robot as it stands.
function box_of_items(choice) {
  const box = new THREE.Box3();
  for (const item of items.filter(choice)) {
    for (const part of item.parts) {
      if (part.box.isEmpty() || part.background) continue;
      box.union(part.box.clone().applyMatrix4(frame_of(part.link).matrixWorld));
    }
  }
  return box;
}
// External spheres reach far out; what they are about is looked at, unless they are all there is.
function scene_box() {
  const choices = [(item) => item.shown && item.kind !== "external", (item) => item.shown,
                   (item) => item.kind !== "external", () => true];
  return choices.map(box_of_items).find((box) => !box.isEmpty());
}
const start_box = scene_box();
const scene_size = start_box.getSize(new THREE.Vector3()).length();
leak_radius.value = kLeakShare * scene_size;
