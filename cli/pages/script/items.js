// SPDX-License-Identifier: BSD-3-Clause
// The things to look at. Each has parts, one for every link of a robot that has it, otherwise one.
// Marks of leaks: their least radius in pixels, and their greatest as a share of the scene.
const kLeakPixels = 2.5;
const kLeakShare = 0.003;

// Meshes are drawn first, then spheres, external spheres over them, and leaks at last.
const kKindRank = {mesh: 0, spheres: 1, tree: 1, external: 2, leaks: 3};
// Surfaces of leaks come right after the meshes that they are of (make_body() doubles orders).
const kLeakSurfaceOrder =
    2 * scene_data.items.filter((item) => item.kind === "mesh").length - 0.5;
const kNouns = {mesh: "triangle", spheres: "sphere", tree: "sphere", external: "sphere",
                leaks: "leak"};
const is_set = (item) => item.kind === "spheres" || item.kind === "tree";
const link_shown = link_frames.map(() => true);
let colours_by_link = false;

// Circles of many thousands of external spheres would blacken. Marks may stand wherever the cut is.
const not_cut = {value: new THREE.Vector4(0, 0, 0, 1)};
const leak_radius = {value: 1e30};
function sphere_uniforms(kind) {
  if (kind === "external") return {ring_tint: {value: 0.74}};
  return kind === "leaks" ? {least_radius: {value: kLeakPixels}, greatest_radius: leak_radius} : {};
}

const item_outline_material = make_line_material(2.4, 1e-3, false);

function add_mesh(data, part, order) {
  part.materials = make_surface_materials(order);
  part.edge_material = make_line_material(1.1, 1e-4, true);
  const surface = make_surface(data, part.materials, part.edge_material, order);
  Object.assign(part, {box: surface.box, triangles: surface.triangles, levels: [surface]});
  part.group.add(surface.body);
}

function add_spheres(data, part, kind, order) {
  part.materials = make_sphere_materials(order, sphere_uniforms(kind));
  part.levels = data.levels.map((text) => {
    const spheres = floats_of(text);
    const body = make_body(make_sphere_geometry(spheres), part.materials, order);
    return {spheres, count: spheres.length / 4, body};
  });
  part.box = box_of(last_level(part).spheres, 4);
  const surface = make_leak_surface(data, kLeakSurfaceOrder);
  if (surface) {
    part.group.add(surface);
    return;
  }
  part.group.add(...part.levels.map((level) => level.body));
  if (kind !== "leaks") return;
  // Leaks of which only points are known shine through what is before them.
  part.ghost = make_sphere_materials(order, sphere_uniforms(kind),
                                     {depthTest: false, depthWrite: false}).colour;
  part.ghost.uniforms.alpha.value = 0.25;
  part.levels[0].body.add(
      make_drawing(make_sphere_geometry(part.levels[0].spheres), part.ghost, 2000));
}

function make_item(data, order) {
  const item = {...data, name: short_name(data.name), full_name: data.name, order, alpha: 1};
  item.parts = data.parts.map((part_data) => {
    const part = {link: part_data.link, name: part_data.name || "",
                  background: part_data.background, group: new THREE.Group()};
    frame_of(part.link).add(part.group);
    if (item.kind === "mesh") add_mesh(part_data, part, order);
    else add_spheres(part_data, part, item.kind, order);
    return part;
  });
  item.level_count = Math.max(...item.parts.map((part) => part.levels.length));
  item.level = item.level_count - 1;
  return item;
}

const last_level = (part) => part.levels[part.levels.length - 1];
const level_of = (item, part) => part.levels[item.level] || last_level(part);
const count_of = (item, parts = item.parts) =>
    parts.reduce((sum, part) => sum + level_of(item, part).count, 0);

const items = scene_data.items
    .map((data, index) => ({data, index}))
    .sort((a, b) => kKindRank[a.data.kind] - kKindRank[b.data.kind] || a.index - b.index)
    .map(({data}, order) => make_item(data, order));
const has_mesh = items.some((item) => item.kind === "mesh");
const sets = items.filter(is_set);
for (const item of items) {
  if (is_set(item) && has_mesh) item.alpha = 0.55;
  if (item.kind === "external") item.alpha = 0.3;
}

const kSetColours = 6;
function item_colour(item) {
  if (item.kind === "mesh" && item.parts.some((part) => part.name)) return "obstacle";
  if (item.kind === "leaks") return "leak-deep";
  return is_set(item) ? `spheres-${sets.indexOf(item) % kSetColours}` : item.kind;
}

// Neighbouring links differ clearly: each hue is a golden section of the circle from the last.
function part_colour(item, part) {
  if (!colours_by_link || part.link < 0 || !is_set(item)) return colour(item_colour(item));
  return new THREE.Color().setHSL((0.58 + part.link * 0.381966) % 1, 0.55,
                                  theme_name() === "dark" ? 0.6 : 0.52);
}

// Carries the state of all items over to what is drawn.
function apply_items() {
  for (const item of items) {
    for (const part of item.parts) {
      part.visible = part.group.visible = item.shown && (part.link < 0 || link_shown[part.link]);
      if (!part.visible) continue;
      for (const level of part.levels) {
        level.body.visible = level.count > 0 && level === level_of(item, part);
      }
      const tint = part_colour(item, part);
      part.materials.colour.uniforms.base.value.copy(tint);
      set_alpha(part.materials, item.alpha);
      if (part.ghost) part.ghost.uniforms.base.value.copy(tint);
      if (part.edge_material) {
        part.edge_material.uniforms.base.value.copy(colour("edge"));
        part.edge_material.uniforms.alpha.value = 0.75 * item.alpha;
      }
    }
  }
  item_outline_material.uniforms.base.value.copy(colour("outline"));
}

// Where a point of a part is in the world.
const world_place = ({part, point}) => point.clone().applyMatrix4(frame_of(part.link).matrixWorld);

// Where the items of a choice are, with the robot as it stands.
function box_of_items(choice) {
  const box = new THREE.Box3();
  for (const part of items.filter(choice).flatMap((item) => item.parts)) {
    if (part.box.isEmpty() || part.background) continue;
    box.union(part.box.clone().applyMatrix4(frame_of(part.link).matrixWorld));
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

// Leaks as a list, the deepest first. Each is a mark at its point, the one with the label also a
// sphere about it, as large as it is deep: the depth is the distance to the nearest sphere.
const leaks = [];
for (const item of items.filter((one) => one.kind === "leaks")) {
  for (const part of item.parts) {
    const {spheres} = part.levels[0];
    for (let i = 0; i < spheres.length; i += 4) {
      const point = new THREE.Vector3().fromArray(spheres, i);
      leaks.push({item, part, point, depth: spheres[i + 3]});
    }
  }
}
leaks.sort((a, b) => b.depth - a.depth);

const leak_shown = (leak) =>
    leak.item.shown && (leak.part.link < 0 || link_shown[leak.part.link]);

// The one with a label in the scene.
let labelled_leak = null;

const depth_materials = make_sphere_materials(1000, {cut: not_cut}, {depthWrite: false});
let depth_sphere = null;
function label_leak(leak) {
  if (depth_sphere) depth_sphere.parent.remove(depth_sphere);
  labelled_leak = leak;
  if (!leak) return;
  const sphere = [...leak.point.toArray(), leak.depth];
  depth_sphere = sphere_drawing(sphere, depth_materials.colour, 1500);
  leak.part.group.add(depth_sphere);
}
set_alpha(depth_materials, 0.3);
theme_listeners.push(() => depth_materials.colour.uniforms.base.value.copy(colour("leak-deep")));
label_leak(leaks[0] || null);
