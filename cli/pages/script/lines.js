// SPDX-License-Identifier: BSD-3-Clause
// Lines some pixels wide (WebGL draws its own one pixel wide only), and those in which the cut
// plane meets the meshes.
const kLineVertex = `
  attribute vec3 begin, end;
  uniform float width, lift;
  uniform vec2 viewport;
  varying vec3 eye_position;
  const float kNearest = -1e-6;
  void main() {
    vec3 a = (modelViewMatrix * vec4(begin, 1.0)).xyz;
    vec3 b = (modelViewMatrix * vec4(end, 1.0)).xyz;
    // Where a line runs through the plane of the eye, the part behind is left out.
    if (a.z > kNearest && b.z < kNearest) a = mix(a, b, (kNearest - a.z) / (b.z - a.z));
    if (b.z > kNearest && a.z < kNearest) b = mix(b, a, (kNearest - b.z) / (a.z - b.z));
    vec4 clip_a = projectionMatrix * vec4(a * (1.0 - lift), 1.0);
    vec4 clip_b = projectionMatrix * vec4(b * (1.0 - lift), 1.0);
    vec2 run = (clip_b.xy / clip_b.w - clip_a.xy / clip_a.w) * viewport;
    vec2 along = run / max(length(run), 1e-6);
    vec4 clip = position.x < 0.0 ? clip_a : clip_b;
    vec2 step = 0.5 * width * (position.x * along + position.y * vec2(-along.y, along.x));
    clip.xy += 2.0 * step / viewport * clip.w;
    eye_position = position.x < 0.0 ? a : b;
    gl_Position = clip;
  }`;

const kLineFragment = `
  uniform vec3 base;
  uniform float alpha;
  uniform bool obeys_cut;
  varying vec3 eye_position;
  ${kShading}
  void main() {
    if (obeys_cut && is_cut_away(eye_position)) discard;
    gl_FragColor = vec4(base, alpha);
  }`;

function make_line_material(width, lift, obeys_cut) {
  return new THREE.ShaderMaterial({
    vertexShader: kLineVertex,
    fragmentShader: kLineFragment,
    uniforms: {...shared_uniforms, base: {value: new THREE.Color()}, alpha: {value: 1},
               width: {value: width * Math.min(devicePixelRatio || 1, 2)}, lift: {value: lift},
               obeys_cut: {value: obeys_cut}},
    transparent: true,
    depthWrite: false,
    side: THREE.DoubleSide,
  });
}

// Of x, y, z of both ends a line.
function make_lines(ends, material, order) {
  const lines = make_drawing(make_squares(ends, {begin: 3, end: 3}), material, order);
  lines.visible = ends.length > 0;
  return lines;
}

// Where a plane of three.js meets triangles: x, y, z of both ends for each that it crosses.
function section_of(triangles, plane) {
  const ends = [];
  const heights = [0, 0, 0];
  const {x, y, z} = plane.normal;
  for (let i = 0; i < triangles.length; i += 9) {
    for (let k = 0; k < 3; ++k) {
      const p = i + 3 * k;
      heights[k] = x * triangles[p] + y * triangles[p + 1] + z * triangles[p + 2] + plane.constant;
    }
    const above = (heights[0] > 0) + (heights[1] > 0) + (heights[2] > 0);
    if (above === 0 || above === 3) continue;
    for (let k = 0; k < 3; ++k) {
      const next = (k + 1) % 3;
      if ((heights[k] > 0) === (heights[next] > 0)) continue;
      const t = heights[k] / (heights[k] - heights[next]);
      for (let axis = 0; axis < 3; ++axis) {
        const [a, b] = [triangles[i + 3 * k + axis], triangles[i + 3 * next + axis]];
        ends.push(a + t * (b - a));
      }
    }
  }
  return new Float32Array(ends);
}
