// SPDX-License-Identifier: BSD-3-Clause
// The plane that cuts the scene open, across one of the axes of the world.
const kAxes = ["x", "y", "z"];
const cut = {axis: -1, share: 0.5, flipped: false, started: [false, false, false]};
{
  // As in #cut=y:0.5 or #cut=-y:0.5.
  const wanted = /^(-?)([xyz])(?::([\d.]+))?$/.exec(address_options.get("cut") || "");
  if (wanted) {
    Object.assign(cut, {flipped: wanted[1] === "-", axis: kAxes.indexOf(wanted[2]),
                        share: Number(wanted[3] || 0.5)});
    cut.started[cut.axis] = true;
  }
}

const extent_of_cut = () =>
    [start_box.min, start_box.max].map((end) => end.getComponent(Math.max(cut.axis, 0)));
function cut_position() {
  const [low, high] = extent_of_cut();
  return low + cut.share * (high - low);
}

// What is on the side of its normal is cut away.
function cut_plane() {
  const normal = new THREE.Vector3().setComponent(cut.axis, cut.flipped ? -1 : 1);
  return new THREE.Plane(normal, cut.flipped ? cut_position() : -cut_position());
}

// The first time an axis is chosen, the cut goes through the deepest leak, or else the middle, and
// faces the camera.
function choose_cut(axis) {
  cut.axis = axis;
  if (axis < 0 || cut.started[axis]) return;
  cut.started[axis] = true;
  const leak = leaks.find(leak_shown);
  const [low, high] = extent_of_cut();
  cut.share = leak ? (world_place(leak).getComponent(axis) - low) / (high - low) : 0.5;
  cut.share = Math.min(0.98, Math.max(0.02, cut.share));
  cut.flipped = camera.position.getComponent(axis) < controls.target.getComponent(axis);
}

// The plane in the frame of a link; null without a cut.
function cut_in(link) {
  if (cut.axis < 0) return null;
  return cut_plane().applyMatrix4(new THREE.Matrix4().getInverse(frame_of(link).matrixWorld));
}

// Draws anew where the plane meets the meshes.
function apply_cut() {
  for (const item of items.filter((one) => one.kind === "mesh")) {
    for (const part of item.parts) {
      if (part.outline) {
        part.group.remove(part.outline);
        part.outline.geometry.dispose();
      }
      const plane = part.visible ? cut_in(part.link) : null;
      part.outline = plane &&
          make_lines(section_of(part.triangles, plane), item_outline_material, 1000);
      if (plane) part.group.add(part.outline);
    }
  }
}

// Before every frame: the plane as the camera sees it.
function place_cut() {
  const value = shared_uniforms.cut.value.set(0, 0, 0, 1);
  if (cut.axis < 0) return;
  const {normal, constant} = cut_plane().applyMatrix4(camera.matrixWorldInverse);
  value.set(normal.x, normal.y, normal.z, -constant);
}
