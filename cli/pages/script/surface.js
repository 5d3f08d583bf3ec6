// SPDX-License-Identifier: BSD-3-Clause
// Meshes: smooth where their triangles meet flatly, with a line along every sharp edge.
const kSharpCosine = Math.cos(30 * Math.PI / 180);

const kSurfaceVertex = `
  attribute float leak_depth;
  varying float depth_here;
  varying vec3 eye_position;
  varying vec3 eye_normal;
  void main() {
    vec4 eye = modelViewMatrix * vec4(position, 1.0);
    depth_here = leak_depth;
    eye_position = eye.xyz;
    eye_normal = mat3(modelViewMatrix) * normal;
    gl_Position = projectionMatrix * eye;
  }`;

// What is behind the cut shows its inner side, darker. Of leaks the depth is the colour.
const kSurfaceFragment = `
  uniform vec3 base, deep;
  uniform float alpha, deepest;
  uniform bool is_leak;
  varying float depth_here;
  varying vec3 eye_position;
  varying vec3 eye_normal;
  ${kShading}
  void main() {
    if (is_cut_away(eye_position)) discard;
    vec3 face = normalize(cross(dFdx(eye_position), dFdy(eye_position)));
    vec3 normal = is_leak ? face : normalize(eye_normal);
    if (dot(normal, face) < 0.0) normal = -normal;
    bool inner = dot(cut.xyz, cut.xyz) > 0.0 && !gl_FrontFacing;
    vec3 painted = mix(base, deep, clamp(depth_here / deepest, 0.0, 1.0));
    vec3 shaded = shade(inner ? 0.6 * base : base, normal);
    gl_FragColor = vec4(is_leak ? mix(painted, shade(painted, normal), 0.5) : shaded, alpha);
  }`;

function face_normals(positions, corners) {
  const normals = new Float32Array(corners.length);
  const [a, b, c] = [new THREE.Vector3(), new THREE.Vector3(), new THREE.Vector3()];
  for (let i = 0; i < corners.length; i += 3) {
    a.fromArray(positions, 3 * corners[i]);
    b.fromArray(positions, 3 * corners[i + 1]).sub(a);
    c.fromArray(positions, 3 * corners[i + 2]).sub(a);
    b.cross(c).toArray(normals, i);  // its length is twice the area: the weight in a mean
  }
  return normals;
}

const unit_dot = (list, i, j) => {
  const [a, b] = [3 * i, 3 * j];
  const dot = list[a] * list[b] + list[a + 1] * list[b + 1] + list[a + 2] * list[b + 2];
  const sizes = Math.hypot(list[a], list[a + 1], list[a + 2]) *
                Math.hypot(list[b], list[b + 1], list[b + 2]);
  return sizes > 0 ? dot / sizes : 1;
};

// For every corner the mean normal of the faces around it that lie flat to its own.
function corner_normals(corners, faces, vertex_count) {
  const start = new Uint32Array(vertex_count + 1);
  for (const vertex of corners) ++start[vertex + 1];
  for (let i = 0; i < vertex_count; ++i) start[i + 1] += start[i];
  const around = new Uint32Array(corners.length);
  const fill = start.slice();
  corners.forEach((vertex, i) => { around[fill[vertex]++] = Math.floor(i / 3); });
  const normals = new Float32Array(3 * corners.length);
  corners.forEach((vertex, i) => {
    const own = Math.floor(i / 3);
    for (let k = start[vertex]; k < start[vertex + 1]; ++k) {
      const face = around[k];
      if (face !== own && unit_dot(faces, own, face) < kSharpCosine) continue;
      for (let axis = 0; axis < 3; ++axis) normals[3 * i + axis] += faces[3 * face + axis];
    }
  });
  return normals;
}

// Both ends of every edge whose two faces meet sharply, or that has one face only.
function sharp_edges(positions, corners, faces) {
  const open = new Map();
  const ends = [];
  const add = (a, b) => ends.push(...positions.subarray(3 * a, 3 * a + 3),
                                  ...positions.subarray(3 * b, 3 * b + 3));
  const vertex_count = positions.length / 3;
  for (let i = 0; i < corners.length; ++i) {
    const face = Math.floor(i / 3);
    const [a, b] = [corners[i], corners[i % 3 === 2 ? i - 2 : i + 1]];
    const key = Math.min(a, b) * vertex_count + Math.max(a, b);
    const other = open.get(key);
    if (other === undefined) {
      open.set(key, face);
    } else {
      if (unit_dot(faces, face, other) < kSharpCosine) add(a, b);
      open.delete(key);
    }
  }
  for (const key of open.keys()) add(Math.floor(key / vertex_count), key % vertex_count);
  return new Float32Array(ends);
}

// Triangles with corners of their own; of a mesh with normals, and with lines along sharp edges.
function make_surface(part, materials, edge_material, order) {
  const positions = floats_of(part.positions);
  const corners = integers_of(part.corners);
  const faces = face_normals(positions, corners);
  const triangles = new Float32Array(3 * corners.length);
  corners.forEach((vertex, i) => {
    triangles.set(positions.subarray(3 * vertex, 3 * vertex + 3), 3 * i);
  });
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(triangles, 3));
  geometry.setAttribute("normal", new THREE.BufferAttribute(
      corner_normals(corners, faces, positions.length / 3), 3));
  const body = make_body(geometry, materials, order);
  body.add(make_lines(sharp_edges(positions, corners, faces), edge_material, 2 * order + 1));
  return {body, triangles, count: corners.length / 3, box: box_of(positions, 3)};
}

function make_surface_materials(order, uniforms = {}, options = {}) {
  return make_materials(kSurfaceVertex, kSurfaceFragment, order, {
    base: {value: new THREE.Color()}, deep: {value: new THREE.Color()}, deepest: {value: 1},
    is_leak: {value: false}, alpha: {value: 1}, ...uniforms,
  }, {polygonOffset: true, polygonOffsetFactor: 1, polygonOffsetUnits: 1, ...options});
}

// The part of a mesh that is outside of all spheres, coloured by its depth as if painted on the
// mesh: what stands before it hides it, and it is cut with the rest. One scale for all leaks of the
// page, so that sets can be compared.
const deepest_leak = {value: 1e-30};
let has_leak_surface = false;
const leak_material = make_surface_materials(
    0, {is_leak: {value: true}, deepest: deepest_leak}, {polygonOffset: false}).colour;
theme_listeners.push(() => {
  leak_material.uniforms.base.value.copy(colour("leak-shallow"));
  leak_material.uniforms.deep.value.copy(colour("leak-deep"));
});

// Null where only points are known.
function make_leak_surface(part, order) {
  if (!part.depths) return null;
  has_leak_surface = true;
  const depths = floats_of(part.depths);
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(floats_of(part.positions), 3));
  geometry.setAttribute("leak_depth", new THREE.BufferAttribute(depths, 1));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(bytes_of(part.corners)), 1));
  deepest_leak.value = depths.reduce((most, depth) => Math.max(most, depth), deepest_leak.value);
  return make_drawing(geometry, leak_material, order);
}
