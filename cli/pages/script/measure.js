// SPDX-License-Identifier: BSD-3-Clause
// The distance between two points that are clicked on. Points stay on the part they are on.
const measure = {on: false, points: [], line: null, label: null};
const measure_materials = make_sphere_materials(1200, {
  least_radius: {value: 4}, greatest_radius: {value: 0}, cut: not_cut,
}, {depthTest: false, depthWrite: false});
set_alpha(measure_materials, 1);
const measure_line_material = make_line_material(2, 1e-3, false);
measure_line_material.depthTest = false;
theme_listeners.push(() => {
  measure_materials.colour.uniforms.base.value.set(theme().outline);
  measure_line_material.uniforms.base.value.set(theme().outline);
});

function clear_measure() {
  for (const one of measure.points.splice(0)) one.mark.parent.remove(one.mark);
  if (measure.line) measure.line.visible = false;
  if (measure.label) measure.label.hidden = true;
}

function add_measured_point({part, point, pane}) {
  if (measure.points.length === 2) clear_measure();
  const mark = sphere_drawing([...point.toArray(), 0], measure_materials.colour, 2700);
  frame_of(part.link).add(mark);
  measure.points.push({part, point, pane, mark});
  redraw();
}

const measured_distance = () =>
    world_place(measure.points[0]).distanceTo(world_place(measure.points[1]));

// Before every frame: the line between the two, wherever they have moved.
function place_measure() {
  if (measure.points.length < 2) return;
  const ends = measure.points.map(world_place);
  if (!measure.line) {
    measure.line = make_lines(new Float32Array(6), measure_line_material, 2650);
    measure.label = node("div", {className: "measure-label"});
    world.add(measure.line);
    document.body.append(measure.label);
  }
  replace_lines(measure.line, new Float32Array([...ends[0].toArray(), ...ends[1].toArray()]));
  measure.line.visible = true;
  fit_view(measure.points[1].pane);
  const middle = pixel_of(ends[0].clone().add(ends[1]).multiplyScalar(0.5));
  measure.label.hidden = !middle.seen;
  measure.label.textContent = distance_text(measured_distance());
  measure.label.style.left = `${middle.x + 10}px`;
  measure.label.style.top = `${middle.y - 26}px`;
}

function switch_measure() {
  measure.on = !measure.on;
  if (!measure.on) clear_measure();
  panel_part("measure").setAttribute("aria-pressed", String(measure.on));
  panel_part("measure-note").hidden = !measure.on;
  redraw();
}
