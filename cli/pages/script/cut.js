// SPDX-License-Identifier: BSD-3-Clause
// The plane that cuts the scene open, across one of the axes of the world.
const kAxes = ["x", "y", "z"];
const cut = {axis: -1, share: 0.5, flipped: false, started: [false, false, false]};
{
  // As in #cut=y:0.5 or #cut=-y:0.5.
  const wanted = /^(-?)([xyz])(?::([\d.]+))?$/.exec(address_options.get("cut") || "");
  if (wanted) {
    Object.assign(cut, {flipped: wanted[1] === "-", axis: kAxes.indexOf(wanted[2]),
                        share: wanted[3] === undefined ? 0.5 : Number(wanted[3])});
    cut.started[cut.axis] = true;
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

// How much the plane at each of `count` places along an axis cuts open: the discs of the spheres shown,
// or the extent of triangles where there are none.
function cut_amounts(axis, count) {
  const [low, high] = [start_box.min.getComponent(axis), start_box.max.getComponent(axis)];
  const amounts = new Float64Array(count);
  const place_of = (k) => low + (k + 0.5) / count * (high - low);
  const add = (from, to, amount_at) => {
    const first = Math.max(0, Math.ceil((from - low) / (high - low) * count - 0.5));
    for (let k = first; k < count && place_of(k) < to; ++k) amounts[k] += amount_at(place_of(k));
  };
  const shown = items.filter((item) => item.shown);
  const sets = shown.filter((item) => item.kind === "spheres" || item.kind === "tree");
  const point = new THREE.Vector3();
  for (const item of sets.length ? sets : shown.filter((one) => one.kind === "mesh")) {
    for (const part of item.parts.filter((one) => !one.background)) {
      const matrix = frame_of(part.link).matrixWorld;
      const height = (numbers, i) => point.fromArray(numbers, i).applyMatrix4(matrix).getComponent(axis);
      const numbers = part.triangles || spheres_of(part.levels[part.levels.length - 1]);
      for (let i = 0; i < numbers.length; i += part.triangles ? 9 : 4) {
        if (part.triangles) {
          const heights = [0, 3, 6].map((k) => height(numbers, i + k));
          add(Math.min(...heights), Math.max(...heights), () => 1);
        } else {
          const [at, radius] = [height(numbers, i), numbers[i + 3]];
          add(at - radius, at + radius, (place) => radius ** 2 - (place - at) ** 2);
        }
      }
    }
  }
  return amounts;
}

// Where a cut across an axis starts, as a share of the extent: through the deepest leak, otherwise
// where most is cut open, with a liking for the middle.
function first_share(axis) {
  const leak = leaks.find(leak_shown);
  if (leak) {
    const [low, high] = [start_box.min.getComponent(axis), start_box.max.getComponent(axis)];
    return Math.min(0.98, Math.max(0.02, (world_place(leak).getComponent(axis) - low) / (high - low)));
  }
  let best = {share: 0.5, amount: 0};
  cut_amounts(axis, 101).forEach((amount, k) => {
    const share = (k + 0.5) / 101;
    const weighed = amount * (1 - Math.abs(share - 0.5));
    if (weighed > best.amount) best = {share, amount: weighed};
  });
  return best.share;
}

// The first time an axis is chosen, the cut starts where something is to be seen and faces the camera.
function choose_cut(axis) {
  cut.axis = axis;
  if (axis < 0 || cut.started[axis]) return;
  cut.started[axis] = true;
  cut.share = first_share(axis);
  cut.flipped = camera.position.getComponent(axis) < controls.target.getComponent(axis);
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
