// SPDX-License-Identifier: BSD-3-Clause
// The part of a mesh that is outside of all spheres, coloured by its depth as if painted on the mesh:
// what stands before it hides it, and it is cut with the rest.
const kLeakVertex = `
  attribute float leak_depth;
  varying vec3 eye_position;
  varying float depth_here;
  void main() {
    vec4 eye = modelViewMatrix * vec4(position, 1.0);
    eye_position = eye.xyz;
    depth_here = leak_depth;
    gl_Position = projectionMatrix * eye;
  }`;

const kLeakFragment = `
  uniform vec3 shallow, deep;
  uniform float deepest;
  varying vec3 eye_position;
  varying float depth_here;
  ${kShading}
  void main() {
    if (is_cut_away(eye_position)) discard;
    vec3 normal = normalize(cross(dFdx(eye_position), dFdy(eye_position)));
    vec3 base = mix(shallow, deep, clamp(depth_here / deepest, 0.0, 1.0));
    gl_FragColor = vec4(mix(base, shade(base, normal), 0.5), 1.0);
  }`;

// One scale for all leaks of the page, so that sets can be compared.
const deepest_leak = {value: 1e-30};
const leak_surface_material = new THREE.ShaderMaterial({
  vertexShader: kLeakVertex,
  fragmentShader: kLeakFragment,
  uniforms: {...shared_uniforms, shallow: {value: new THREE.Color()},
             deep: {value: new THREE.Color()}, deepest: deepest_leak},
  side: THREE.DoubleSide,
  extensions: {derivatives: true},
  // Among what is blended, which is drawn in its order: after the meshes and before spheres.
  transparent: true,
});
theme_listeners.push(() => {
  leak_surface_material.uniforms.shallow.value.set(theme().leak_shallow);
  leak_surface_material.uniforms.deep.value.set(theme().leak);
});

// Null for leaks of which only points are known.
function make_leak_surface(part_data, order) {
  if (!part_data.depths) return null;
  const depths = new Float32Array(decode(part_data.depths));
  const geometry = new THREE.BufferGeometry();
  geometry.setAttribute("position",
                        new THREE.BufferAttribute(new Float32Array(decode(part_data.positions)), 3));
  geometry.setAttribute("leak_depth", new THREE.BufferAttribute(depths, 1));
  geometry.setIndex(new THREE.BufferAttribute(new Uint32Array(decode(part_data.corners)), 1));
  deepest_leak.value = depths.reduce((most, depth) => Math.max(most, depth), deepest_leak.value);
  const surface = new THREE.Mesh(geometry, leak_surface_material);
  surface.frustumCulled = false;
  surface.renderOrder = order;
  return surface;
}

// What the colours stand for.
function add_leak_scale() {
  if (!items.some((item) => item.parts.some((part) => part.surface))) return;
  panel_part("leak-list").before(node("div", {id: "leak-scale"}, "0", node("span"),
                                      distance_text(deepest_leak.value)));
}
