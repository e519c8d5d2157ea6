/*
 * The page that nsd-web writes: it plays the frames that stand beside it.
 *
 * A chunk is a script element of base64: zlib around little-endian numbers, as draw/page.c packs
 * them. `meta` has what the numbers are relative to. Balls are drawn exactly: a square each, in which the
 * fragment shader finds where the ray of sight meets the ball; grains of other shapes by their triangles.
 */
'use strict';

const by_id = id => document.getElementById(id);
const meta = JSON.parse(by_id('meta').textContent);
const flat = meta.dim === 2;

function trouble(text) {
  by_id('trouble').textContent = text;
  by_id('trouble').hidden = false;
}

/* ---- chunks ---- */

const kept = new Map(); // the chunks unpacked last
const KEPT = 64;        // chunks; a frame of 100 000 grains takes 2 MB

async function inflate(id) {
  const text = by_id(id).textContent;
  const bytes = Uint8Array.from(atob(text), c => c.charCodeAt(0));
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('deflate'));
  return new Response(stream).arrayBuffer();
}

function chunk(id) {
  let found = kept.get(id);
  if (found) kept.delete(id); // to the end: used last
  else found = inflate(id);
  kept.set(id, found);
  if (kept.size > KEPT) kept.delete(kept.keys().next().value);
  return found;
}

async function load(k) {
  const m = meta.frames[k], n = m.n, c = m.c;
  const [frame, grains] = await Promise.all([chunk('f' + k), chunk('g' + m.g)]);
  let at = 0;
  const take = (buffer, Type, count) => {
    const a = new Type(buffer, at, count);
    at += a.byteLength;
    return a;
  };
  const f = { k, m, n, c };
  f.x = take(frame, Uint16Array, 4 * n);
  f.v = take(frame, Int16Array, 4 * n);
  f.q = take(frame, Int8Array, 4 * n);
  f.a = take(frame, Int32Array, c);
  f.b = take(frame, Int32Array, c);
  f.fn = take(frame, Uint16Array, c);
  f.ft = take(frame, Uint16Array, c);
  f.normal = take(frame, Int8Array, 4 * c); // and the status
  at = 0;
  f.radius = take(grains, Float32Array, n);
  f.mass = take(grains, Float32Array, n);
  f.id = take(grains, Int32Array, n);
  f.material = take(grains, Int32Array, n);
  f.shape = m.h === undefined ? null : take(grains, Int32Array, n); // null: all are balls
  f.solids = m.h === undefined ? [] : solids(await chunk('s' + m.h), 's' + m.h);
  f.shown = images(f);
  return f;
}

/*
 * The shapes of a chunk, of which the first is the ball and has none: corners and normals of their triangles,
 * of a grain of radius 1 in its own axes; across: 3 numbers a corner, of which number k falls from 1 to 0
 * towards side k where that is an edge, and is 1 where it is not.
 */
let solid = { id: null, list: [] };
function solids(buffer, id) {
  if (solid.id === id) return solid.list;
  const count = new Uint32Array(buffer, 0, 1)[0], each = new Uint32Array(buffer, 4, count);
  const all = each.reduce((a, b) => a + b, 0);
  const corner = new Float32Array(buffer, 4 + 4 * count, 9 * all);
  const edge = new Uint8Array(buffer, 4 + 4 * count + 36 * all, all);
  let first = 0;
  const list = Array.from(each, n => {
    const at = corner.slice(9 * first, 9 * (first + n)), normal = new Float32Array(9 * n), across = new Float32Array(9 * n);
    for (let t = 0; t < n; t++) {
      const [a, b, c] = [0, 3, 6].map(k => at.subarray(9 * t + k, 9 * t + k + 3));
      const u = b.map((x, j) => x - a[j]), v = c.map((x, j) => x - a[j]);
      const w = [u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]], length = norm(w) || 1;
      for (let k = 0; k < 3; k++) {
        normal.set(w.map(x => x / length), 9 * t + 3 * k);
        for (let side = 0; side < 3; side++) // corner k is across from side k + 1
          across[9 * t + 3 * k + side] = !(edge[first + t] >> side & 1) || (k + 1) % 3 === side ? 1 : 0;
      }
    }
    first += n;
    return { n, corner: at, normal, across };
  });
  solid = { id, list };
  return list;
}

const place = (f, i) => [0, 1, 2].map(j => f.m.lo[j] + f.m.step[j] * f.x[4 * i + j]);

/*
 * What is drawn: grains, and where a cell repeats each inside it and once more on every other side of the
 * border that it cuts. `row` is whose, `by` (m) how far from where the document has it.
 */
function images(f) {
  const cell = f.m.cell, row = [], by = [];
  if (!cell) return { n: f.n, row: Int32Array.from({ length: f.n }, (_, i) => i), by: new Float32Array(3 * f.n) };
  const inverse = new T.Matrix3().set(...[0, 1, 2].flatMap(j => cell.edge.map(e => e[j]))).invert().elements;
  const across = [0, 1, 2].map(k => [0, 1, 2].map(j => inverse[3 * j + k])); // u_k = across_k . (x - origin)
  const ways = cell.repeats.map(repeats => repeats ? [-1, 0, 1] : [0]);
  const put = (i, s) => {
    row.push(i);
    by.push(...[0, 1, 2].map(j => s[0] * cell.edge[0][j] + s[1] * cell.edge[1][j] + s[2] * cell.edge[2][j]));
  };
  for (let i = 0; i < f.n; i++) {
    const d = place(f, i).map((x, j) => x - cell.origin[j]);
    const u = across.map(a => a[0] * d[0] + a[1] * d[1] + a[2] * d[2]);
    const home = u.map((v, k) => cell.repeats[k] ? -Math.floor(v) : 0), wide = across.map(a => f.radius[i] * norm(a));
    const cut = (k, s) => !s || (u[k] + home[k] + s + wide[k] >= 0 && u[k] + home[k] + s - wide[k] <= 1);
    for (const a of ways[0]) for (const b of ways[1]) for (const c of ways[2])
      if (cut(0, a) && cut(1, b) && cut(2, c)) put(i, [home[0] + a, home[1] + b, home[2] + c]);
  }
  return { n: row.length, row: Int32Array.from(row), by: Float32Array.from(by) };
}
/* Where image k is drawn, m */
const drawn = (f, k) => place(f, f.shown.row[k]).map((x, j) => x + f.shown.by[3 * k + j]);
/* The images that have this shape; null: all, and they are the grains */
function shaped(f, shape) {
  if (!f.m.cell && !f.shape) return null;
  const every = Int32Array.from(f.shown.row.keys());
  return f.shape ? every.filter(k => f.shape[f.shown.row[k]] === shape) : every;
}
/* An array with `width` numbers a row as one with those of these rows; null: all */
function gather(array, width, rows) {
  if (!rows) return array;
  const out = new array.constructor(width * rows.length);
  rows.forEach((i, k) => { for (let j = 0; j < width; j++) out[width * k + j] = array[width * i + j]; });
  return out;
}
const velocity = (f, i) => [0, 1, 2].map(j => f.m.vmax * f.v[4 * i + j] / 32767);
const spin = (f, i) => f.m.wmax * f.x[4 * i + 3] / 65535;
const norm = v => Math.hypot(...v);
function digits(x) {
  if (!isFinite(x)) return '-';
  const size = Math.abs(x);
  return size !== 0 && (size < 1e-3 || size >= 1e6) ? x.toExponential(2).replace('e+', 'e')
                                                    : Number(x.toPrecision(4)).toString();
}
/* As many digits as the page has of it: positions are rounded to 1e-5 of the extent, and less */
const complete = x => isFinite(x) ? Number(x.toPrecision(7)).toString() : '-';

/* ---- what colours show ---- */

function counts(f) {
  const z = new Float32Array(f.n);
  for (let i = 0; i < f.c; i++) {
    if (!f.fn[i]) continue;
    z[f.b[i]]++;
    if (f.a[i] >= 0) z[f.a[i]]++;
  }
  return z;
}
function forces(f) {
  const s = new Float32Array(f.n);
  for (let i = 0; i < f.c; i++) {
    const x = f.m.fmax * f.fn[i] / 65535;
    s[f.b[i]] += x;
    if (f.a[i] >= 0) s[f.a[i]] += x;
  }
  return s;
}
const each = value => f => Float32Array.from({ length: f.n }, (_, i) => value(f, i));
const up = flat ? 1 : 2;
const R = meta.range;
const colours = {
  speed: { unit: 'm/s', range: [0, R.speed], of: each((f, i) => norm(velocity(f, i))) },
  radius: { unit: 'm', range: R.radius, of: each((f, i) => f.radius[i]) },
  height: { unit: 'm', range: [R.lo[up], R.hi[up]], of: each((f, i) => place(f, i)[up]) },
  spin: { unit: 'rad/s', range: [0, R.spin], of: each(spin) },
  material: { classes: meta.materials, of: each((f, i) => f.material[i]) },
  id: { classes: [], of: each((f, i) => f.id[i]) },
};
if (meta.solved) {
  colours['contacts that push'] = { unit: '', range: [0, R.z], of: counts };
  colours['sum of normal forces'] = { unit: 'N', range: value => [0, value.reduce((a, b) => Math.max(a, b), 0)], of: forces };
}
for (const name in colours) by_id('colour').add(new Option(name));

/* Viridis as a polynomial in t, within 0.01 of its table; ten classes [Tableau 10] */
const viridis = [[.2777, .0054, .3341], [.1051, 1.4046, 1.3846], [-.3309, .2148, .0951],
  [-4.6342, -5.7991, -19.3324], [6.2283, 14.1799, 56.6906], [4.7764, -13.7451, -65.353],
  [-5.4355, 4.6459, 26.3124]];
const ten = [0x4e79a7, 0xf28e2b, 0xe15759, 0x76b7b2, 0x59a14f, 0xedc948, 0xb07aa1, 0xff9da7, 0x9c755f,
  0xbab0ac];
const palette = t => [0, 1, 2].map(j => {
  let c = 0;
  for (let p = 6; p >= 0; p--) c = c * t + viridis[p][j];
  return Math.round(255 * Math.min(Math.max(c, 0), 1));
});

/* Of the whole trajectory; of forces, where one impact would make all others dark, of the frame */
const range_of = (show, value) => typeof show.range === 'function' ? show.range(value) : show.range;

function draw_bar(show, range) {
  const bar = by_id('bar').getContext('2d');
  const classes = show.classes && show.classes.length;
  for (let i = 0; i < 256; i++) {
    const k = Math.floor(i * (classes || 10) / 256) % 10;
    bar.fillStyle = show.classes ? '#' + ten[k].toString(16).padStart(6, '0')
                                 : 'rgb(' + palette(i / 255) + ')';
    bar.fillRect(i, 0, 1, 14);
  }
  by_id('low').textContent = range ? digits(range[0]) : '';
  by_id('high').textContent = range ? digits(range[1]) : '';
  by_id('unit').textContent = range ? show.unit : show.classes.join(', ');
}

/* ---- shaders ---- */

const ball_vertex = `
precision highp float;
uniform mat4 viewMatrix, projectionMatrix;
uniform vec3 origin, quantum;
uniform float scale, cutoff;
uniform bool ortho, classes;
uniform sampler2D palette;
in vec3 position;
in vec4 x, q;
in vec3 by;
in float radius, value, chosen;
out vec3 at, centre, colour;
out vec4 turn;
flat out float r;
void main() {
  vec3 world = (origin + quantum * x.xyz + by) * scale;
  centre = (viewMatrix * vec4(world, 1.)).xyz;
  r = radius * scale;
  float d = length(centre), wide = r;
  vec3 u = vec3(1, 0, 0), v = vec3(0, 1, 0);
  if (!ortho) {
    vec3 w = centre / d;
    u = normalize(cross(w, abs(w.y) < .9 ? v : u));
    v = cross(u, w);
    wide = r * d / sqrt(max(d * d - r * r, 1e-3 * r * r));
  }
  at = centre + wide * (position.x * u + position.y * v);
  turn = q;
  colour = texture(palette, vec2(classes ? (mod(value, 10.) + .5) / 10. : (value * 255. + .5) / 256.,
                                 classes ? .75 : .25)).rgb;
  if (chosen > .5) colour = vec3(1., .25, .8);
  gl_Position = projectionMatrix * vec4(at, 1.);
  if (-centre.z < cutoff) gl_Position = vec4(2., 2., 2., 1.);
}`;
const ball_fragment = `
precision highp float;
uniform mat4 viewMatrix, projectionMatrix;
uniform bool ortho, marks, plane;
in vec3 at, centre, colour;
in vec4 turn;
flat in float r;
out vec4 pixel;
void main() {
  vec3 from = ortho ? vec3(at.xy, 0.) : vec3(0.), along = ortho ? vec3(0., 0., -1.) : normalize(at);
  vec3 n, hit;
  if (plane) {
    hit = from + along * (centre.z - from.z) / along.z;
    n = (hit - centre) / r;
    if (dot(n, n) > 1.) discard;
  } else {
    vec3 c = centre - from;
    float b = dot(c, along), h = r * r - dot(c, c) + b * b;
    if (h < 0.) discard;
    hit = from + along * (b - sqrt(h));
    n = (hit - centre) / r;
  }
  vec4 clip = projectionMatrix * vec4(hit, 1.);
  gl_FragDepth = .5 * clip.z / clip.w + .5;
  vec3 w = transpose(mat3(viewMatrix)) * n, own = colour;
  vec3 t = 2. * cross(-turn.yzw, w), body = w + turn.x * t + cross(-turn.yzw, t);
  if (marks && plane && body.y > 0.) own = mix(own, vec3(1.), .42);
  if (marks && !plane) {
    if (abs(body.z) > .94) own *= .4;
    else if (body.x * body.y > 0.) own = mix(own, vec3(1.), .42);
  }
  float light = plane ? 1. - .35 * smoothstep(.9, 1., length(n))
                      : .3 + .55 * max(dot(n, normalize(vec3(-.4, .7, .6))), 0.) + .15 * n.z;
  pixel = vec4(own * light, 1.);
}`;
const solid_vertex = `
precision highp float;
uniform mat4 viewMatrix, projectionMatrix;
uniform vec3 origin, quantum;
uniform float scale, cutoff;
uniform bool classes;
uniform sampler2D palette;
in vec3 position, normal, across;
in vec4 x, q;
in vec3 by;
in float radius, value, chosen;
out vec3 n, far, colour;
vec3 turned(vec4 q, vec3 v) {
  vec3 t = 2. * cross(q.yzw, v);
  return v + q.x * t + cross(q.yzw, t);
}
void main() {
  vec4 turn = normalize(q);
  vec3 world = origin + quantum * x.xyz + by;
  vec4 at = viewMatrix * vec4((world + radius * turned(turn, position)) * scale, 1.);
  n = mat3(viewMatrix) * turned(turn, normal);
  far = across;
  colour = texture(palette, vec2(classes ? (mod(value, 10.) + .5) / 10. : (value * 255. + .5) / 256.,
                                 classes ? .75 : .25)).rgb;
  if (chosen > .5) colour = vec3(1., .25, .8);
  gl_Position = projectionMatrix * at;
  if (-(viewMatrix * vec4(world * scale, 1.)).z < cutoff) gl_Position = vec4(2., 2., 2., 1.);
}`;
const solid_fragment = `
precision highp float;
uniform bool plane;
in vec3 n, far, colour;
out vec4 pixel;
void main() {
  vec3 m = normalize(n), pixels = far / fwidth(far); // from the edges
  if (m.z < 0.) m = -m;
  float light = plane ? 1. : .3 + .55 * max(dot(m, normalize(vec3(-.4, .7, .6))), 0.) + .15 * m.z;
  float edge = 1.;
  for (int k = 0; k < 3; k++) if (far[k] < 1.) edge = min(edge, smoothstep(.5, 1.5, pixels[k]));
  pixel = vec4(colour * light * (.55 + .45 * edge), 1.);
}`;
const line_vertex = `
precision highp float;
uniform mat4 viewMatrix, projectionMatrix;
uniform vec2 pixels;
in vec3 position, from, to, colour;
in float wide;
out vec3 own;
void main() {
  vec4 a = projectionMatrix * viewMatrix * vec4(from, 1.), b = projectionMatrix * viewMatrix * vec4(to, 1.);
  vec2 d = (b.xy / b.w - a.xy / a.w) * pixels;
  d = length(d) > 0. ? normalize(d) : vec2(1, 0);
  vec4 end = position.x > 0. ? b : a;
  end.xy += end.w * vec2(-d.y, d.x) * position.y * max(wide, 1.) / pixels;
  own = colour;
  gl_Position = end;
}`;
const line_fragment = `
precision highp float;
in vec3 own;
out vec4 pixel;
void main() { pixel = vec4(own, 1.); }`;

/* ---- the scene ---- */

const T = await import(URL.createObjectURL(
  new Blob([by_id('three').textContent], { type: 'text/javascript' })));
const canvas = by_id('view');
const gl = new T.WebGLRenderer({ canvas, antialias: true, preserveDrawingBuffer: true });
gl.setClearColor(0xffffff);
const scene = new T.Scene(), overlay = new T.Scene();
const size = Math.max(...[0, 1, 2].map(j => R.hi[j] - R.lo[j])) || 1;
const scale = 2 / size; // of metres: the scene is about 2 wide, whatever its grains
const middle = new T.Vector3(...[0, 1, 2].map(j => scale * (R.lo[j] + R.hi[j]) / 2));
const perspective = new T.PerspectiveCamera(35, 1, 0.01, 100);
const straight = new T.OrthographicCamera(-1, 1, 1, -1, -100, 100);
const eye = { azimuth: flat ? 0 : 30, elevation: flat ? 0 : 20, away: 4.2, to: middle.clone() };

function colour_table() {
  const bytes = new Uint8Array(256 * 2 * 4);
  for (let i = 0; i < 256; i++) {
    bytes.set([...palette(i / 255), 255], 4 * i);
    const c = ten[Math.min(Math.floor(i * 10 / 256), 9)];
    bytes.set([c >> 16, c >> 8 & 255, c & 255, 255], 4 * (256 + i));
  }
  const t = new T.DataTexture(bytes, 256, 2);
  t.needsUpdate = true;
  return t;
}

const uniforms = {
  origin: { value: new T.Vector3() }, quantum: { value: new T.Vector3() }, scale: { value: scale },
  cutoff: { value: 0 }, ortho: { value: false }, classes: { value: false }, marks: { value: true },
  plane: { value: flat }, palette: { value: colour_table() },
};
const shader = (vertex, fragment, uniforms) => new T.RawShaderMaterial({
  glslVersion: T.GLSL3, vertexShader: vertex, fragmentShader: fragment, uniforms, side: T.DoubleSide });
function square() {
  const g = new T.InstancedBufferGeometry();
  g.setAttribute('position', new T.BufferAttribute(
    new Float32Array([-1, -1, 0, 1, -1, 0, 1, 1, 0, -1, 1, 0]), 3));
  g.setIndex([0, 1, 2, 0, 2, 3]);
  return g;
}
const balls = new T.Mesh(square(), shader(ball_vertex, ball_fragment, uniforms));
balls.frustumCulled = false;
scene.add(balls);
const bodies = new T.Group(); // a mesh for each shape
scene.add(bodies);
const solid_material = shader(solid_vertex, solid_fragment, uniforms);
let bodies_shown = null;
function make_bodies(list) {
  if (bodies_shown === list) return;
  bodies_shown = list;
  for (const b of bodies.children) b.geometry.dispose();
  bodies.clear();
  list.forEach((solid, shape) => {
    if (!solid.n) return;
    const g = new T.InstancedBufferGeometry();
    g.setAttribute('position', new T.BufferAttribute(solid.corner, 3));
    g.setAttribute('normal', new T.BufferAttribute(solid.normal, 3));
    g.setAttribute('across', new T.BufferAttribute(solid.across, 3));
    const mesh = new T.Mesh(g, solid_material);
    mesh.frustumCulled = false;
    mesh.userData.shape = shape;
    bodies.add(mesh);
  });
}
const line_uniforms = { pixels: { value: new T.Vector2() } };
const network = new T.Mesh(square(), shader(line_vertex, line_fragment, line_uniforms));
network.frustumCulled = false;
overlay.add(network); // seen through the grains
const panels = new T.Mesh(new T.BufferGeometry(), new T.MeshBasicMaterial({
  color: 0x6f7f95, transparent: true, opacity: 0.16, side: T.DoubleSide, depthWrite: false }));
const edges = new T.LineSegments(new T.BufferGeometry(), new T.LineBasicMaterial({ color: 0x55606f }));
panels.frustumCulled = edges.frustumCulled = false;
scene.add(panels, edges);

function instanced(g, name, array, width, normalised) {
  const old = g.getAttribute(name);
  if (old && old.array.length === array.length) {
    old.array = array;
    old.needsUpdate = true;
    return;
  }
  g.setAttribute(name, new T.InstancedBufferAttribute(array, width, normalised));
}

/* ---- a frame into the scene ---- */

let now = null, chosen = null; // the frame shown; the id of the grain picked

/* Those of one shape, in the colours of value[] */
function show_shape(mesh, f, shape, value) {
  const g = mesh.geometry, images = shaped(f, shape), rows = images && images.map(k => f.shown.row[k]);
  const n = images ? images.length : f.n;
  if (n !== g.instanceCount) for (const a of ['x', 'q', 'by', 'radius', 'value', 'chosen']) g.deleteAttribute(a);
  instanced(g, 'x', gather(f.x, 4, rows), 4, false);
  instanced(g, 'q', gather(f.q, 4, rows), 4, true);
  instanced(g, 'by', gather(f.shown.by, 3, images), 3, false);
  instanced(g, 'radius', gather(f.radius, 1, rows), 1, false);
  instanced(g, 'value', gather(value, 1, rows), 1, false);
  instanced(g, 'chosen', gather(Float32Array.from(f.id, id => id === chosen ? 1 : 0), 1, rows), 1, false);
  g.instanceCount = n;
  mesh.visible = n > 0;
}

function show_grains(f) {
  const show = colours[by_id('colour').value];
  const value = show.of(f), range = range_of(show, value);
  draw_bar(show, range);
  if (range) {
    const [lo, hi] = range;
    for (let i = 0; i < f.n; i++)
      value[i] = hi > lo ? Math.min(Math.max((value[i] - lo) / (hi - lo), 0), 1) : 0.5;
  }
  make_bodies(f.solids);
  show_shape(balls, f, 0, value);
  for (const mesh of bodies.children) show_shape(mesh, f, mesh.userData.shape, value);
  uniforms.origin.value.set(...f.m.lo);
  uniforms.quantum.value.set(...f.m.step);
  uniforms.classes.value = !!show.classes;
}

function show_network(f) {
  network.visible = by_id('network').checked && f.c > 0;
  if (!network.visible) return;
  const push = [], home = new Map(); // where each grain is drawn first
  f.shown.row.forEach((i, k) => { if (!home.has(i)) home.set(i, k); });
  const at = i => drawn(f, home.get(i));
  for (let i = 0; i < f.c; i++) if (f.fn[i]) push.push(i);
  const n = push.length, from = new Float32Array(3 * n), to = new Float32Array(3 * n),
    colour = new Float32Array(3 * n), wide = new Float32Array(n);
  push.forEach((i, k) => {
    const b = at(f.b[i]), normal = [0, 1, 2].map(j => f.normal[4 * i + j] / 127);
    const away = f.radius[f.b[i]] + (f.a[i] >= 0 ? f.radius[f.a[i]] : 0);
    // to the image that it touches, or to the boundary
    const a = f.a[i] >= 0 && !f.m.cell ? at(f.a[i]) : b.map((x, j) => x - away * normal[j]);
    for (let j = 0; j < 3; j++) from[3 * k + j] = scale * a[j], to[3 * k + j] = scale * b[j];
    colour.set(f.normal[4 * i + 3] === 2 ? [.82, .24, .17] : [.12, .31, .61], 3 * k);
    wide[k] = 8 * devicePixelRatio * f.fn[i] / 65535; // pixels, half of it; the frame's largest has 16
  });
  const g = network.geometry;
  for (const a of ['from', 'to', 'colour', 'wide']) g.deleteAttribute(a);
  instanced(g, 'from', from, 3);
  instanced(g, 'to', to, 3);
  instanced(g, 'colour', colour, 3);
  instanced(g, 'wide', wide, 1);
  g.instanceCount = n;
}

let walls_shown = -1;
async function show_walls(f) {
  panels.visible = edges.visible = by_id('walls').checked;
  if (f.m.b === walls_shown || f.m.b === undefined) return;
  walls_shown = f.m.b;
  const buffer = await chunk('b' + f.m.b), [triangles, lines] = new Uint32Array(buffer, 0, 2);
  const corners = new Float32Array(buffer, 8, 9 * triangles).map(x => x * scale);
  const ends = new Float32Array(buffer, 8 + 36 * triangles, 6 * lines).map(x => x * scale);
  panels.geometry.dispose();
  edges.geometry.dispose();
  panels.geometry = new T.BufferGeometry().setAttribute('position', new T.BufferAttribute(corners, 3));
  edges.geometry = new T.BufferGeometry().setAttribute('position', new T.BufferAttribute(ends, 3));
}

function row(table, name, text) {
  const r = table.insertRow();
  r.insertCell().textContent = name;
  r.insertCell().textContent = text;
}
function show_picked(f) {
  const box = by_id('picked'), i = chosen === null ? -1 : f.id.indexOf(chosen);
  box.replaceChildren(Object.assign(document.createElement('h2'), { textContent: 'Grain' }));
  if (i < 0) {
    const hint = chosen === null ? 'Click a grain to read its numbers.'
                                 : 'Grain ' + chosen + ' is not in this frame.';
    box.append(Object.assign(document.createElement('p'), { className: 'hint', textContent: hint }));
    return;
  }
  const table = document.createElement('table'), v = velocity(f, i);
  row(table, 'id', f.id[i]);
  row(table, 'material', meta.materials[f.material[i]]);
  row(table, 'radius', complete(f.radius[i]) + ' m');
  row(table, 'mass', complete(f.mass[i]) + ' kg');
  row(table, 'position', place(f, i).slice(0, meta.dim).map(complete).join(', ') + ' m');
  row(table, 'velocity', v.slice(0, meta.dim).map(complete).join(', ') + ' m/s');
  row(table, 'speed', complete(norm(v)) + ' m/s');
  row(table, 'spin', complete(spin(f, i)) + ' rad/s');
  if (meta.solved) {
    row(table, 'contacts that push', counts(f)[i]);
    row(table, 'sum of normal forces', complete(forces(f)[i]) + ' N');
  }
  box.append(table);
}

function show(f) {
  now = f;
  by_id('frame').value = f.k;
  by_id('now').textContent = 't = ' + digits(f.m.t) + ' s, step ' + f.m.s;
  show_grains(f);
  show_network(f);
  show_picked(f);
  plot();
  show_walls(f).then(draw);
}

/* ---- curves ---- */

const curves = meta.curves;
let plot_left = 84; // pixels: where the curve begins
for (const name in curves) by_id('curve').add(new Option(name + (curves[name].unit ? ', ' + curves[name].unit : ''), name));
by_id('curves').hidden = meta.frames.length < 2;

function plot() {
  const curve = curves[by_id('curve').value], c = by_id('plot').getContext('2d');
  if (!curve || !now) return;
  const { width, height } = by_id('plot'), bottom = 34, top = 10, right = 10;
  const t = meta.frames.map(f => f.t), y = curve.value, real = y.filter(x => x !== null);
  let lo = Math.min(...real), hi = Math.max(...real);
  if (lo > 0 && lo < 0.5 * hi) lo = 0;
  if (!(hi > lo)) hi = lo + (Math.abs(lo) || 1);
  c.font = '20px system-ui, sans-serif';
  // the margin is as wide as the numbers are: none is cut off
  const ends = [hi, lo].map(x => digits(x)), unit = curve.unit || '';
  const left = plot_left = 12 + Math.max(...[...ends, unit].map(text => c.measureText(text).width));
  const X = s => left + (width - left - right) * (s - t[0]) / ((t[t.length - 1] - t[0]) || 1);
  const Y = s => height - bottom - (height - bottom - top) * (s - lo) / (hi - lo);
  c.clearRect(0, 0, width, height);
  c.strokeStyle = '#c3c9d4';
  c.strokeRect(left, top, width - left - right, height - top - bottom);
  c.fillStyle = '#556';
  c.textAlign = 'right';
  c.fillText(ends[0], left - 6, top + 18);
  c.fillText(unit, left - 6, top + 42);
  c.fillText(ends[1], left - 6, height - bottom);
  c.fillText(digits(t[t.length - 1]) + ' s', width - right, height - 8);
  c.textAlign = 'left';
  c.fillText(digits(t[0]) + ' s', left, height - 8);
  c.strokeStyle = '#1f4e9c';
  c.lineWidth = 2.5;
  c.beginPath();
  let drawing = false;
  y.forEach((v, k) => {
    if (v === null) drawing = false;
    else if (drawing) c.lineTo(X(t[k]), Y(v));
    else c.moveTo(X(t[k]), Y(v)), drawing = true;
  });
  c.stroke();
  c.strokeStyle = '#d03c2b';
  c.lineWidth = 1.5;
  c.beginPath();
  c.moveTo(X(now.m.t), top);
  c.lineTo(X(now.m.t), height - bottom);
  c.stroke();
}

/* ---- the eye ---- */

/* From y, in space z, to what is up: against gravity */
const tilt = new T.Quaternion();
if (meta.up) tilt.setFromUnitVectors(new T.Vector3(0, flat ? 1 : 0, flat ? 0 : 1), new T.Vector3(...meta.up));

function camera() {
  const d = Math.PI / 180, ce = Math.cos(eye.elevation * d), se = Math.sin(eye.elevation * d);
  const toward = flat ? new T.Vector3(Math.sin(eye.azimuth * d) * ce, se, Math.cos(eye.azimuth * d) * ce)
                      : new T.Vector3(Math.sin(eye.azimuth * d) * ce, -Math.cos(eye.azimuth * d) * ce, se);
  const cam = by_id('perspective').checked && !flat ? perspective : straight;
  const aspect = canvas.clientWidth / Math.max(canvas.clientHeight, 1), half = eye.away * Math.tan(17.5 * d);
  uniforms.ortho.value = cam === straight;
  toward.applyQuaternion(tilt);
  cam.up.set(0, flat ? 1 : 0, flat ? 0 : 1).applyQuaternion(tilt);
  cam.position.copy(eye.to).addScaledVector(toward, eye.away);
  cam.lookAt(eye.to);
  if (cam === perspective) {
    cam.aspect = aspect;
    cam.near = eye.away / 1000;
    cam.far = eye.away + 50;
  } else {
    cam.left = -half * aspect, cam.right = half * aspect, cam.top = half, cam.bottom = -half;
  }
  cam.updateProjectionMatrix();
  cam.updateMatrixWorld();
  const cut = Number(by_id('cut').value) / 1000;
  uniforms.cutoff.value = cut ? eye.away + 1.8 * (2 * cut - 1) : -1e9;
  return cam;
}

/* Turns nothing, and moves the eye so that all that the trajectory fills is seen, with a margin. */
const corners = Array.from({ length: 8 }, (_, k) =>
  new T.Vector3(...[0, 1, 2].map(j => scale * (k >> j & 1 ? R.hi : R.lo)[j])));
function fit() {
  const cam = camera(), m = cam.matrixWorld.elements, tan = Math.tan(17.5 * Math.PI / 180);
  const aspect = canvas.parentElement.clientWidth / Math.max(canvas.parentElement.clientHeight, 1);
  const right = new T.Vector3(m[0], m[1], m[2]), above = new T.Vector3(m[4], m[5], m[6]), near = new T.Vector3(m[8], m[9], m[10]);
  eye.to.copy(middle);
  eye.away = Math.max(...corners.map(x => {
    const d = x.clone().sub(middle), beside = Math.max(Math.abs(d.dot(right)) / aspect, Math.abs(d.dot(above)));
    return 1.06 * beside / tan + (cam === perspective ? d.dot(near) : 0);
  })) || 4.2;
}

/* ---- the address: time and view, so that it can be passed on ---- */

let fitted = true; // nobody has moved the eye
let telling = 0;
function tell_address() {
  const says = new URLSearchParams({ t: now ? now.m.t : 0, colour: by_id('colour').value });
  if (!fitted) {
    const say = { az: eye.azimuth, el: eye.elevation, away: eye.away, x: eye.to.x / scale, y: eye.to.y / scale, z: eye.to.z / scale };
    for (const k in say) says.set(k, Number(say[k].toPrecision(6)));
  }
  try {
    history.replaceState(null, '', '#' + says);
  } catch { /* a page within another may not */ }
}
/* The frame at or next to the time that the address says; null: it says none. The eye is where it says. */
function heed_address() {
  const says = new URLSearchParams(location.hash.slice(1)), number = k => says.has(k) ? Number(says.get(k)) : NaN;
  const view = ['az', 'el', 'away', 'x', 'y', 'z'].map(number);
  const colour = says.get('colour') === 'kind' ? 'material' : says.get('colour'); // 'kind': of version 1
  if (colours[colour]) by_id('colour').value = colour;
  if (view.every(isFinite) && view[2] > 0) {
    fitted = false;
    eye.azimuth = view[0], eye.elevation = Math.min(Math.max(view[1], -89), 89), eye.away = Math.min(Math.max(view[2], 0.01), 40);
    eye.to.set(view[3], view[4], view[5]).multiplyScalar(scale);
  }
  const t = number('t');
  if (!isFinite(t)) return null;
  return meta.frames.reduce((best, f, k) => Math.abs(f.t - t) < Math.abs(meta.frames[best].t - t) ? k : best, 0);
}

function axes(cam) {
  const c = by_id('axes').getContext('2d'), names = ['x', 'y', 'z'], m = cam.matrixWorldInverse.elements;
  c.clearRect(0, 0, 90, 90);
  c.font = '12px system-ui, sans-serif';
  c.strokeStyle = c.fillStyle = '#445';
  for (let j = 0; j < meta.dim; j++) {
    const x = 45 + 30 * m[4 * j], y = 45 - 30 * m[4 * j + 1];
    c.beginPath();
    c.moveTo(45, 45);
    c.lineTo(x, y);
    c.stroke();
    c.fillText(names[j], x + (x > 45 ? 3 : -9), y + (y > 45 ? 10 : -3));
  }
}

function draw() {
  const w = canvas.parentElement.clientWidth, h = canvas.parentElement.clientHeight;
  gl.setPixelRatio(Math.min(devicePixelRatio, 2));
  gl.setSize(w, h, false);
  if (fitted) fit();
  gl.getDrawingBufferSize(line_uniforms.pixels.value);
  const cam = camera();
  gl.autoClear = true;
  gl.render(scene, cam);
  if (network.visible) {
    gl.autoClear = false;
    gl.clearDepth();
    gl.render(overlay, cam);
  }
  axes(cam);
  clearTimeout(telling); // not for each frame that is played, of which browsers complain
  telling = setTimeout(tell_address, 300);
}

/* v turned by the orientation of grain i, or back */
function turned(f, i, v, back) {
  const [w, x, y, z] = f.q.subarray(4 * i, 4 * i + 4);
  const q = new T.Quaternion(x, y, z, w).normalize();
  return v.clone().applyQuaternion(back ? q.invert() : q);
}
/* Where a ray, from a point relative to the centre of grain i, meets its triangles; Infinity: nowhere */
function meets_solid(f, i, from, direction) {
  const { n, corner } = f.solids[f.shape[i]], r = scale * f.radius[i], hit = new T.Vector3();
  const ray = new T.Ray(turned(f, i, from, true).divideScalar(r), turned(f, i, direction, true));
  const at = k => new T.Vector3(corner[k], corner[k + 1], corner[k + 2]);
  let nearest = Infinity;
  for (let t = 0; t < n; t++)
    if (ray.intersectTriangle(at(9 * t), at(9 * t + 3), at(9 * t + 6), false, hit))
      nearest = Math.min(nearest, r * hit.sub(ray.origin).dot(ray.direction));
  return nearest;
}

/* The grain under a point of the canvas: the row of the nearest that the ray meets, perhaps as an image;
   -1: none */
function pick(px, py) {
  if (!now) return -1;
  const cam = camera(), box = canvas.getBoundingClientRect();
  const ray = new T.Raycaster();
  ray.setFromCamera(new T.Vector2(2 * (px - box.left) / box.width - 1, 1 - 2 * (py - box.top) / box.height), cam);
  const { origin, direction } = ray.ray;
  const ahead = cam.getWorldDirection(new T.Vector3());
  let best = -1, nearest = Infinity;
  for (let k = 0; k < now.shown.n; k++) {
    const i = now.shown.row[k];
    const c = new T.Vector3(...drawn(now, k)).multiplyScalar(scale), r = scale * now.radius[i];
    if (c.clone().sub(cam.position).dot(ahead) < uniforms.cutoff.value) continue;
    c.sub(origin);
    const b = c.dot(direction), h = r * r - c.lengthSq() + b * b;
    if (h < 0) continue;
    const shape = now.shape ? now.shape[i] : 0;
    const t = shape ? meets_solid(now, i, c.negate(), direction) : flat ? b : b - Math.sqrt(h);
    if (t < nearest) nearest = t, best = i;
  }
  return best;
}

/* ---- hands ---- */

let held = null;
canvas.addEventListener('pointerdown', e => {
  held = { x: e.clientX, y: e.clientY, far: 0, slide: flat || e.button !== 0 || e.shiftKey };
  canvas.setPointerCapture(e.pointerId);
});
canvas.addEventListener('pointermove', e => {
  if (!held) return;
  const dx = e.clientX - held.x, dy = e.clientY - held.y;
  held.x = e.clientX, held.y = e.clientY, held.far += Math.abs(dx) + Math.abs(dy);
  if (held.far < 4) return;
  fitted = false;
  if (held.slide) {
    const cam = camera(), m = cam.matrixWorld.elements;
    const k = 2 * eye.away * Math.tan(17.5 * Math.PI / 180) / canvas.clientHeight;
    eye.to.addScaledVector(new T.Vector3(m[0], m[1], m[2]), -k * dx);
    eye.to.addScaledVector(new T.Vector3(m[4], m[5], m[6]), k * dy);
  } else {
    eye.azimuth -= 0.4 * dx;
    eye.elevation = Math.min(Math.max(eye.elevation + 0.4 * dy, -89), 89);
  }
  draw();
});
canvas.addEventListener('pointerup', e => {
  if (held && held.far < 4) {
    const i = pick(e.clientX, e.clientY);
    chosen = i < 0 ? null : now.id[i];
    show(now);
  }
  held = null;
});
canvas.addEventListener('contextmenu', e => e.preventDefault());
canvas.addEventListener('wheel', e => {
  e.preventDefault();
  fitted = false;
  eye.away = Math.min(Math.max(eye.away * Math.exp(0.001 * e.deltaY), 0.01), 40);
  draw();
}, { passive: false });

let playing = false, wanted = 0, loading = false;

async function go(k) {
  wanted = Math.min(Math.max(k, 0), meta.frames.length - 1);
  if (loading) return;
  loading = true;
  try {
    while (!now || now.k !== wanted) show(await load(wanted));
  } catch (e) {
    trouble('This frame cannot be read: ' + e.message);
    playing = false;
  }
  loading = false;
}
let last = 0;
function tick(time) {
  if (playing && !loading && time - last >= 1000 / Number(by_id('rate').value || 25)) {
    last = time;
    go(now.k + 1 < meta.frames.length ? now.k + 1 : 0);
  }
  requestAnimationFrame(tick);
}
function toggle() {
  playing = !playing;
  by_id('play').innerHTML = playing ? '&#10074;&#10074;' : '&#9654;';
}
by_id('play').addEventListener('click', toggle);
by_id('frame').max = meta.frames.length - 1;
by_id('frame').addEventListener('input', e => go(Number(e.target.value)));
by_id('plot').addEventListener('click', e => {
  const box = e.target.getBoundingClientRect(), t = meta.frames.map(f => f.t);
  const s = ((e.clientX - box.left) / box.width * 560 - plot_left) / (550 - plot_left);
  const at = t[0] + s * (t[t.length - 1] - t[0]);
  go(t.reduce((best, x, k) => Math.abs(x - at) < Math.abs(t[best] - at) ? k : best, 0));
});
by_id('colour').addEventListener('change', () => show(now));
by_id('curve').addEventListener('change', plot);
by_id('marks').addEventListener('change', e => {
  uniforms.marks.value = e.target.checked;
  draw();
});
for (const id of ['network', 'walls']) by_id(id).addEventListener('change', () => show(now));
for (const id of ['perspective', 'cut']) by_id(id).addEventListener('input', draw);
addEventListener('resize', draw);
addEventListener('keydown', e => {
  if (/^(INPUT|SELECT)$/.test(e.target.tagName) && e.target.type !== 'checkbox') return;
  if (e.key === ' ') e.preventDefault(), toggle();
  if (e.key === 'ArrowRight') go(now.k + 1);
  if (e.key === 'ArrowLeft') go(now.k - 1);
});

by_id('title').textContent = document.title;
by_id('said').textContent = meta.said;
by_id('network_line').hidden = !meta.solved;
if (flat) by_id('perspective').parentElement.hidden = by_id('cut').parentElement.hidden = true;
by_id('fit').addEventListener('click', () => {
  fitted = true;
  eye.azimuth = flat ? 0 : 30, eye.elevation = flat ? 0 : 20;
  draw();
});
/* The first frame with grains, where they are poured into an empty box */
const first_filled = Math.max(meta.frames.findIndex(f => f.n > 0), 0), asked = heed_address();
await go(asked === null ? first_filled : asked);
addEventListener('hashchange', () => {
  const k = heed_address();
  if (k !== null && k !== now.k) go(k);
  else show(now);
});
requestAnimationFrame(tick);

/* For those who drive the page by a program: go(k), pick(x, y) -> row, what is shown. */
window.nsd = { meta, go, pick, draw, eye, get fitted() { return fitted; }, get frame() { return now; }, get chosen() { return chosen; },
  seen(i) {
    const v = new T.Vector3(...drawn(now, now.shown.row.indexOf(i))).multiplyScalar(scale).project(camera());
    const box = canvas.getBoundingClientRect();
    return [box.left + (v.x + 1) / 2 * box.width, box.top + (1 - v.y) / 2 * box.height];
  } };
