// SPDX-License-Identifier: BSD-3-Clause
// The plane that cuts the scene open, across one of the axes of the world.
const kAxes = ["x", "y", "z"];
const cut = {axis: -1, share: 0.5, flipped: false};
{
  // As in #cut=y:0.5 or #cut=-y:0.5.
  const wanted = /^(-?)([xyz])(?::([\d.]+))?$/.exec(address_options.get("cut") || "");
  if (wanted) {
    Object.assign(cut, {flipped: wanted[1] === "-", axis: kAxes.indexOf(wanted[2]),
                        share: wanted[3] === undefined ? 0.5 : Number(wanted[3])});
  }
}

function cut_position() {
  const axis = Math.max(cut.axis, 0);
  const [low, high] = [start_box.min.getComponent(axis), start_box.max.getComponent(axis)];
  return low + cut.share * (high - low);
}

// What is on the side of its normal is cut away.
function cut_plane() {
  const normal = new THREE.Vector3().setComponent(cut.axis, cut.flipped ? -1 : 1);
  return new THREE.Plane(normal, cut.flipped ? cut_position() : -cut_position());
}

// Draws anew where the plane meets the meshes.
function apply_cut() {
  const plane = cut.axis >= 0 ? cut_plane() : null;
  for (const item of items.filter((one) => one.kind === "mesh")) {
    for (const part of item.parts) {
      let ends = new Float32Array(0);
      if (plane && part.group.visible) {
        const to_link = new THREE.Matrix4().getInverse(frame_of(part.link).matrixWorld);
        ends = section_of(part.triangles, plane.clone().applyMatrix4(to_link));
      }
      replace_lines(part.outline, ends);
    }
  }
}

// Before every frame: the plane as the camera sees it.
function place_cut(camera) {
  const value = shared_uniforms.cut.value;
  if (cut.axis < 0) {
    value.set(0, 0, 0, 1);
    return;
  }
  const plane = cut_plane().applyMatrix4(camera.matrixWorldInverse);
  value.set(plane.normal.x, plane.normal.y, plane.normal.z, -plane.constant);
}
