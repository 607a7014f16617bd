"use strict";
const byId = id => document.getElementById(id);
const blob = id => JSON.parse(byId("json-" + id).textContent);
const results = blob("results"), costs = blob("costs"), octrees = blob("octrees");
const viridis = share => {
  const i = 6 * Math.max(0, Math.min(255, Math.round(255 * share)));
  return [0, 2, 4].map(k => parseInt(VIRIDIS.slice(i + k, i + k + 2), 16));
};
const bytesOf = text => Uint8Array.from(atob(text), c => c.charCodeAt(0));

// Data links and flags to copy.
for (const link of document.querySelectorAll("a[data-path]")) {
  link.addEventListener("click", () => {
    const path = link.dataset.path;
    const value = path === "" ? results : path.split(".").reduce((at, key) => at[key], results);
    link.href = "data:application/json," + encodeURIComponent(JSON.stringify(value, null, 1));
    link.download = (path || "results") + ".json";
  });
}
for (const point of document.querySelectorAll("circle[data-flags]")) {
  const show = () => {
    const line = point.closest("section").querySelector("[aria-live]");
    line.textContent = point.querySelector("title").textContent;
    if (navigator.clipboard) navigator.clipboard.writeText("nuvo " + point.dataset.flags).catch(() => {});
  };
  point.addEventListener("click", show);
  point.addEventListener("keydown", event => { if (event.key === "Enter") show(); });
}

// Cost pictures: planes come as the red, green and blue of a PNG.
const planes = [];
async function planeOf(png) {
  const image = new Image();
  image.src = "data:image/png;base64," + png;
  await image.decode();
  const canvas = document.createElement("canvas");
  canvas.width = image.width;
  canvas.height = image.height;
  const context = canvas.getContext("2d", { willReadFrequently: true });
  context.drawImage(image, 0, 0);
  const rgba = context.getImageData(0, 0, image.width, image.height).data;
  return Uint32Array.from({ length: rgba.length / 4 },
    (_, i) => 65536 * rgba[4 * i] + 256 * rgba[4 * i + 1] + rgba[4 * i + 2]);
}
async function showCost() {
  const index = Number(byId("cost-choice").value), cost = costs[index];
  planes[index] ??= { uniform: await planeOf(cost.png.uniform), nonuniform: await planeOf(cost.png.nonuniform) };
  const { uniform, nonuniform } = planes[index];
  const canvas = byId("cost"), context = canvas.getContext("2d");
  canvas.width = cost.width;
  canvas.height = cost.height;
  const picture = context.createImageData(cost.width, cost.height);
  const handle = cost.width * byId("cost-handle").value / 100, difference = byId("cost-difference").checked;
  for (let i = 0; i < uniform.length; ++i) {
    const x = i % cost.width;
    let color;
    if (difference) {  // blue: the non-uniform octree is the cheaper, red: the dearer
      const d = (nonuniform[i] - uniform[i]) / cost.max, fade = 255 * (1 - Math.sqrt(Math.abs(d)));
      color = d > 0 ? [255, fade, fade] : [fade, fade, 255];
    } else {
      color = Math.abs(x - handle) < 1 ? [255, 255, 255] : viridis((x < handle ? uniform : nonuniform)[i] / cost.max);
    }
    picture.data.set([...color, 255], 4 * i);
  }
  context.putImageData(picture, 0, 0);
  window.costReady = index;
}
if (costs.length > 0) {
  for (const id of ["cost-choice", "cost-handle", "cost-difference"]) byId(id).addEventListener("input", showCost);
  byId("cost").addEventListener("pointermove", event => {
    const cost = costs[Number(byId("cost-choice").value)], pair = planes[Number(byId("cost-choice").value)];
    const box = byId("cost").getBoundingClientRect();
    const x = Math.min(cost.width - 1, Math.max(0, Math.floor((event.clientX - box.left) / box.width * cost.width)));
    const y = Math.min(cost.height - 1, Math.max(0, Math.floor((event.clientY - box.top) / box.height * cost.height)));
    const i = y * cost.width + x;
    if (pair) byId("cost-value").textContent = `pixel ${x},${y}: uniform ${pair.uniform[i]}, non-uniform ${pair.nonuniform[i]}`;
  });
  showCost();
}

// Octrees: one draw call each, two views of one camera.
async function inflate(text) {
  const stream = new Blob([bytesOf(text)]).stream().pipeThrough(new DecompressionStream("deflate"));
  return new Response(stream).arrayBuffer();
}
const kEdges = [];  // 12 edges of the unit cube
for (let axis = 0; axis < 3; ++axis)
  for (let corner = 0; corner < 4; ++corner)
    for (let end = 0; end < 2; ++end) {
      const point = [0, 0, 0];
      point[axis] = end;
      point[(axis + 1) % 3] = corner & 1;
      point[(axis + 2) % 3] = corner >> 1;
      kEdges.push(...point);
    }
function boxes(low, size, color, depth) {
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(kEdges), 3));
  const attribute = (name, data, width) => geometry.setAttribute(name, new THREE.InstancedBufferAttribute(data, width));
  attribute("low", low, 3);
  attribute("size", size, 3);
  attribute("tint", color, 3);
  attribute("level", depth, 1);
  geometry.instanceCount = depth.length;
  const material = new THREE.ShaderMaterial({
    uniforms: { most: { value: 24 } },
    vertexShader: `attribute vec3 low; attribute vec3 size; attribute vec3 tint; attribute float level;
      uniform float most; varying vec3 color;
      void main() { color = tint;
        gl_Position = level > most + 0.5 ? vec4(2, 2, 2, 1) : projectionMatrix * modelViewMatrix * vec4(low + size * position, 1); }`,
    fragmentShader: "varying vec3 color; void main() { gl_FragColor = vec4(color, 1); }",
  });
  const lines = new THREE.LineSegments(geometry, material);
  lines.frustumCulled = false;
  return lines;
}
/// Lines from point to point, two points each.
function segments(points, tint) {
  const geometry = new THREE.InstancedBufferGeometry();
  geometry.setAttribute("position", new THREE.BufferAttribute(new Float32Array(points), 3));
  geometry.instanceCount = 1;
  const material = new THREE.ShaderMaterial({
    uniforms: { tint: { value: tint } },
    vertexShader: "void main() { gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1); }",
    fragmentShader: "uniform float tint[3]; void main() { gl_FragColor = vec4(tint[0], tint[1], tint[2], 1); }",
  });
  const lines = new THREE.LineSegments(geometry, material);
  lines.frustumCulled = false;
  return lines;
}
/// The rays of a view's octree, all or the chosen one with its voxels.
function showRays(view) {
  for (const lines of view.rays) {
    view.world.remove(lines);
    lines.geometry.dispose();
    lines.material.dispose();
  }
  view.rays = [];
  const rays = (results.rays ?? {})[view.octree.name] ?? [], chosen = Number(byId("ray-choice")?.value ?? -1);
  const points = [], edges = [], places = new Map(view.names.map((name, i) => [name, i]));
  const shown = chosen < 0 ? rays : rays.slice(chosen, chosen + 1);
  for (const ray of shown) {
    if (ray.end === null) continue;
    points.push(...ray.origin, ...ray.origin.map((o, k) => o + ray.end * ray.direction[k]));
  }
  for (const name of chosen < 0 ? [] : shown.flatMap(ray => ray.voxels)) {
    const at = 8 * places.get(name);
    if (Number.isNaN(at)) continue;  // an empty voxel
    for (let i = 0; i < kEdges.length; ++i) {
      const k = i % 3;
      edges.push(view.leaves[at + k] + kEdges[i] * (view.leaves[at + 3 + k] - view.leaves[at + k]));
    }
  }
  if (points.length > 0) view.rays.push(segments(points, [1, 1, 1]));
  if (edges.length > 0) view.rays.push(segments(edges, [1, 0.6, 0.2]));
  for (const lines of view.rays) view.world.add(lines);
  window.raysShown = points.length / 6;
}
function offerRays() {
  const choice = byId("ray-choice"), rays = (results.rays ?? {})[views[0].octree.name] ?? [];
  if (!choice) return;
  choice.replaceChildren(new Option("all", -1),
    ...rays.map((ray, i) => new Option(`pixel ${ray.pixel}: ${ray.tests} tests, ${ray.voxels.length} voxels`, i)));
}
const views = [];
let renderer, camera, controls;
async function loadOctrees() {
  const scene = byId("octree-choice").value;
  views.length = 0;
  for (const octree of octrees.filter(o => o.scene === scene)) {
    const leaves = new Float32Array(await inflate(octree.data)), count = leaves.length / 8;
    const names = new TextDecoder().decode(await inflate(octree.names)).split(" ");
    const column = Number(byId("octree-color").value);
    let most = 1;
    for (let i = 0; i < count; ++i) most = Math.max(most, leaves[8 * i + column]);
    const bounds = octree.bounds, world = new THREE.Scene();
    const low = new Float32Array(3 * count + 3), size = low.slice(), color = low.slice(), depth = new Float32Array(count + 1);
    for (let i = 0; i < count; ++i) {
      for (let k = 0; k < 3; ++k) {
        low[3 * i + k] = leaves[8 * i + k];
        size[3 * i + k] = leaves[8 * i + 3 + k] - leaves[8 * i + k];
      }
      color.set(viridis(0.15 + 0.85 * leaves[8 * i + column] / most).map(c => c / 255), 3 * i);
      depth[i] = leaves[8 * i + 6];
    }
    for (let k = 0; k < 3; ++k) {  // the root's box, always
      low[3 * count + k] = bounds[k];
      size[3 * count + k] = bounds[3 + k] - bounds[k];
      color[3 * count + k] = 1;
    }
    const lines = boxes(low, size, color, depth);
    world.add(lines);
    views.push({ octree, leaves, names, world, lines, rays: [] });
  }
  offerRays();
  views.forEach(showRays);
  const b = views[0].octree.bounds, middle = [0, 1, 2].map(k => (b[k] + b[k + 3]) / 2);
  const reach = Math.hypot(b[3] - b[0], b[4] - b[1], b[5] - b[2]);
  camera.near = reach / 1000;
  camera.far = reach * 10;
  camera.position.set(middle[0] + 0.5 * reach, middle[1] + 0.4 * reach, middle[2] + 0.9 * reach);
  controls.target.set(...middle);
  controls.update();
  window.voxels = Object.fromEntries(views.map(v => [v.octree.name, v.octree.voxels]));
  draw();
}
function draw() {
  const canvas = byId("space"), width = canvas.clientWidth, height = canvas.clientHeight;
  renderer.setSize(width, height, false);
  renderer.setScissorTest(true);
  views.forEach((view, i) => {
    view.lines.material.uniforms.most.value = Number(byId("octree-depth").value);
    camera.aspect = width / 2 / height;
    camera.updateProjectionMatrix();
    renderer.setViewport(i * width / 2, 0, width / 2, height);
    renderer.setScissor(i * width / 2, 0, width / 2, height);
    renderer.render(view.world, camera);
  });
  window.octreeReady = true;
}
/// The nearest voxel under a point of the canvas, in [0, 1).
function pick(x, y) {
  const view = views[x < 0.5 ? 0 : 1];
  if (!view) return null;
  const ray = new THREE.Raycaster();
  ray.setFromCamera(new THREE.Vector2(4 * (x % 0.5) - 1, 1 - 2 * y), camera);
  const from = ray.ray.origin.toArray(), along = ray.ray.direction.toArray();
  let best = Infinity, found = -1;
  for (let i = 0; i < view.names.length; ++i) {
    if (view.leaves[8 * i + 6] > Number(byId("octree-depth").value)) continue;
    let near = 0, far = Infinity;
    for (let k = 0; k < 3; ++k) {
      const a = (view.leaves[8 * i + k] - from[k]) / along[k], b = (view.leaves[8 * i + 3 + k] - from[k]) / along[k];
      near = Math.max(near, Math.min(a, b));
      far = Math.min(far, Math.max(a, b));
    }
    if (near <= far && near < best) [best, found] = [near, i];
  }
  return found < 0 ? null : { view, leaf: found };
}
function describe({ view, leaf }) {
  const v = view.leaves.subarray(8 * leaf, 8 * leaf + 8), b = view.octree.bounds;
  const area = (x, y, z) => x * y + y * z + z * x;
  const share = v[7] * area(v[3] - v[0], v[4] - v[1], v[5] - v[2]) / area(b[3] - b[0], b[4] - b[1], b[5] - b[2]);
  return `${view.octree.name}: voxel ${view.names[leaf]}, depth ${v[6]}, ${v[7]} items, box [${[...v.subarray(0, 3)].join(" ")}] to ` +
    `[${[...v.subarray(3, 6)].join(" ")}], ${share.toPrecision(3)} of the root's surface heuristic`;
}
if (octrees.length > 0) {
  try {
    const canvas = byId("space");
    renderer = new THREE.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio));
    camera = new THREE.PerspectiveCamera(45, 1, 1, 1000);
    controls = new THREE.OrbitControls(camera, canvas);
    controls.addEventListener("change", draw);
    controls.listenToKeyEvents(canvas);
    byId("octree-choice").addEventListener("input", loadOctrees);
    byId("octree-color").addEventListener("input", loadOctrees);
    byId("octree-depth").addEventListener("input", draw);
    byId("ray-choice")?.addEventListener("input", () => { views.forEach(showRays); draw(); });
    window.addEventListener("resize", draw);
    canvas.addEventListener("click", event => {
      const box = canvas.getBoundingClientRect();
      const found = pick((event.clientX - box.left) / box.width, (event.clientY - box.top) / box.height);
      byId("voxel").textContent = found ? describe(found) : "no voxel there";
    });
    loadOctrees();
  } catch (error) {
    byId("voxel").textContent = "No WebGL here: the octrees are not drawn.";
  }
}
