/** GLSL of the volumes. Cells: coordinates of a padded texture, a voxel is one unit long. */

export const quad = `out vec2 at; void main() { at = uv; gl_Position = vec4(position.xy, 0., 1.); }`;

/** `raw`: (value × occupancy, occupancy); `exact`: the value alone, empty: < -1e38; `soft`: raw blurred twice by (1 2 1)/4. */
const sampling = `
precision highp float; precision highp sampler3D;
uniform sampler3D raw, soft; uniform sampler2D lut; uniform vec3 shape; uniform vec2 range; uniform float threshold;
#ifdef MAPPED
uniform sampler3D other; uniform mat4 toOther; uniform vec3 otherShape;
#endif
const float BORDER = .35, NONE = -1e38; // a sheet one voxel thick still reaches .375
bool shownValue(float v) { return v > NONE && !(v < threshold); }
vec3 colour(float v) {
  float t = clamp((v - range.x) * range.y, 0., 1.);
  return texelFetch(lut, ivec2(min(int(t * 256.), 255), 0), 0).rgb;
}
float inside(vec3 p) {
  vec2 s = texture(soft, p / shape).rg;
  float border = s.g - BORDER;
  return threshold > NONE ? min(border, 4. * (s.r - threshold * s.g)) : border;
}
/** The smooth value at a place near occupied voxels. */
float valueAt(vec3 p) {
  vec2 s = texture(raw, p / shape).rg;
  if (s.g < .02) s = texture(soft, p / shape).rg;
  return s.r / max(s.g, 1e-4);
}
float cell(ivec3 c) {
#ifdef EXACT
  return texelFetch(raw, c, 0).r;
#else
  vec2 s = texelFetch(raw, c, 0).rg; return s.g > .5 ? s.r : 2. * NONE;
#endif
}
vec3 shade(vec3 p, float v) {
#ifdef MAPPED
  vec3 o = (toOther * vec4(p, 1.)).xyz / otherShape;
  bool in_ = all(greaterThan(o, vec3(0.))) && all(lessThan(o, vec3(1.))) && texture(other, o).g > BORDER;
  return in_ ? vec3(.30, .69, .43) : vec3(.85, .26, .24);
#else
  return colour(v);
#endif
}
`;

/** One ray a pixel, through one volume. STYLE: 0 surface, 1 translucent, 2 iso-surface, 3 cells. */
export const march = `${sampling}
uniform sampler3D coarse; uniform sampler2D sceneDepth, solidDepth; uniform mat4 clipToCells, cellsToClip; uniform mat3 toWorldNormal;
uniform vec3 low, high, sun, ghost; uniform float stride, opacity, density, seed;
in vec2 at; out vec4 o;
vec3 cells(float d) { vec4 p = clipToCells * vec4(vec3(at, d) * 2. - 1., 1.); return p.xyz / p.w; }
float noise(vec2 p) { return fract(52.9829189 * fract(dot(p + 5.588238 * seed, vec2(.06711056, .00583715)))); }
float depthOf(vec3 p) { vec4 c = cellsToClip * vec4(p, 1.); return clamp(.5 * c.z / c.w + .5, 0., 1.); }
vec3 lit(vec3 base, vec3 n, vec3 eye, vec3 p) {
  vec3 N = normalize(toWorldNormal * n);
  if (dot(N, eye) > 0.) { N = -N; n = -n; }
  float hidden = .5 * (texture(soft, (p + 2.5 * n) / shape).g + texture(soft, (p + 5. * n) / shape).g); // occlusion by what is near
  float light = (.52 + .13 * N.z) * (1. - .5 * hidden) + .44 * max(dot(N, sun), 0.) + .07 * max(-dot(N, eye), 0.);
  float shine = pow(max(dot(reflect(eye, N), sun), 0.), 28.) * .16;
  return min(base * light + shine, 1.);
}
vec3 slope(vec3 p) {
  vec2 e = vec2(1.1, 0.);
  return -normalize(vec3(inside(p + e.xyy) - inside(p - e.xyy), inside(p + e.yxy) - inside(p - e.yxy), inside(p + e.yyx) - inside(p - e.yyx)) + 1e-6);
}
void main() {
  o = vec4(0.);
#if STYLE != 1
  gl_FragDepth = 1.;
#endif
  vec3 eye = cells(0.), ray = cells(1.) - eye;
  float far = length(ray), scene = min(texture(sceneDepth, at).r, texture(solidDepth, at).r);
  ray /= far;
  ray = mix(ray, vec3(1e-7), lessThan(abs(ray), vec3(1e-7))); // along an axis, nothing is divided by 0
  vec3 seen = normalize(transpose(inverse(toWorldNormal)) * ray); // the direction in the world
  vec3 a = (low - eye) / ray, b = (high - eye) / ray, n = min(a, b), f = max(a, b);
  float t0 = max(max(max(n.x, n.y), n.z), 0.), t1 = min(min(f.x, f.y), f.z);
  if (scene < 1.) t1 = min(t1, distance(cells(scene), eye) - .02);
  if (t0 >= t1) return;
  vec3 entry = vec3(n.x == t0, n.y == t0, n.z == t0) * -sign(ray);
  vec3 groups = shape / 4., last = vec3(textureSize(coarse, 0)) - 1.;
#if STYLE == 3
  // From voxel to voxel (Amanatides and Woo 1987), with steps over empty groups of 4³.
  vec3 p = eye + (t0 + 1e-4) * ray, step_ = sign(ray), side = entry;
  ivec3 c = ivec3(floor(p)), end = ivec3(shape) - 1;
  vec3 delta = abs(1. / ray), next = (vec3(c) + step(0., ray) - eye) / ray;
  float t = t0;
  for (int i = 0; i < 3000; i++) {
    if (t >= t1 || any(lessThan(c, ivec3(0))) || any(greaterThan(c, end))) return;
    if (texelFetch(coarse, c / 4, 0).g == 0.) {
      vec3 edge = (4. * (vec3(c / 4) + step(0., ray)) - eye) / ray;
      t = min(min(edge.x, edge.y), edge.z);
      side = -step_ * vec3(edge.x == t, edge.y == t, edge.z == t);
      p = eye + (t + 1e-4) * ray;
      c = ivec3(floor(p)); next = (vec3(c) + step(0., ray) - eye) / ray;
      continue;
    }
    float v = cell(c);
    if (shownValue(v)) {
      p = eye + t * ray - vec3(c);
      vec3 w = mix(min(p, 1. - p), vec3(1.), abs(side)); // the distance from the face's edges
      float line = smoothstep(0., .045, min(min(w.x, w.y), w.z));
      o = vec4(shade(vec3(c) + .5, v) * mix(.72, 1., line), 1.) * opacity;
      gl_FragDepth = depthOf(eye + t * ray);
      return;
    }
    t = min(min(next.x, next.y), next.z);
    vec3 m = vec3(next.x == t, next.y == t, next.z == t);
    if (m.x + m.y + m.z > 1.) m = m.x > 0. ? vec3(1., 0., 0.) : vec3(0., 1., 0.);
    c += ivec3(m * step_); next += m * delta; side = -m * step_;
  }
#else
  float dt = stride, t = t0;
#if STYLE == 1
  t += dt * noise(gl_FragCoord.xy);
#else
  if (inside(eye + t0 * ray) > 0.) { // cut open, or the eye is inside: what is met is flat
    vec3 p = eye + (t0 + .01) * ray;
    o = vec4(shade(p, valueAt(p)), 1.) * opacity;
    gl_FragDepth = depthOf(p);
    return;
  }
  t += dt * noise(gl_FragCoord.xy);
#if STYLE == 2
  bool within = texture(soft, (eye + t0 * ray) / shape).g > BORDER;
#endif
#endif
  for (int i = 0; i < 2500; i++) {
    if (t >= t1) break;
    vec3 p = eye + t * ray, c = floor(p * .25);
    vec2 best = texelFetch(coarse, ivec3(clamp(c, vec3(0.), last)), 0).rg;
#if STYLE == 2
    if (best.g == 0. || (best.r < threshold && best.g > .9)) { // not even the border of all
#else
    if (best.g == 0. || best.r < threshold) { // nothing to see in these 4³ voxels: go on behind them
#endif
      vec3 edge = (4. * (c + step(0., ray)) - p) / ray;
      t += max(min(min(edge.x, edge.y), edge.z), 0.) + dt * .51; continue;
    }
#if STYLE == 1
    vec2 s = texture(raw, p / shape).rg; float v = s.r / max(s.g, 1e-4);
    if (s.g > .25 && !(v < threshold)) {
      float at_ = clamp((v - range.x) * range.y, 0., 1.);
      float alpha = 1. - exp(-density * opacity * s.g * (.12 + 1.9 * at_ * sqrt(at_)) * dt);
      o += (1. - o.a) * alpha * vec4(shade(p, v), 1.);
      if (o.a > 1. - .02 * stride) return;
    }
#else
#if STYLE == 2
    bool now = texture(soft, p / shape).g > BORDER; // the border of all, faintly, around the iso-surface
    if (now != within) {
      within = now;
      vec3 e = vec3(1.3, 0., 0.);
      vec3 N = normalize(toWorldNormal * normalize(vec3(
        texture(soft, (p + e.xyy) / shape).g - texture(soft, (p - e.xyy) / shape).g,
        texture(soft, (p + e.yxy) / shape).g - texture(soft, (p - e.yxy) / shape).g,
        texture(soft, (p + e.yyx) / shape).g - texture(soft, (p - e.yyx) / shape).g) + 1e-6));
      float rim = 1. - abs(dot(N, seen));
      float alpha = (.05 + .3 * rim * rim * rim) * opacity;
      o += (1. - o.a) * alpha * vec4(ghost, 1.);
    }
    if (best.r < threshold) { t += dt; continue; }
#endif
    if (inside(p) > 0.) {
      float u = max(t - dt, t0), v = t;
      for (int j = 0; j < 7; j++) { float m = .5 * (u + v); if (inside(eye + m * ray) > 0.) v = m; else u = m; }
      p = eye + v * ray;
      vec3 N = slope(p), q = p - .8 * N;
      vec4 hit = vec4(lit(shade(p, valueAt(q)), N, seen, p), 1.) * opacity;
      o += (1. - o.a) * hit;
      gl_FragDepth = depthOf(p);
      return;
    }
#endif
    t += dt;
  }
#endif
}`;

export const sheetVertex = `out vec3 at; void main() { vec4 p = modelMatrix * vec4(position, 1.); at = p.xyz; gl_Position = projectionMatrix * viewMatrix * p; }`;

/** A plane through a volume. */
export const sheet = `${sampling}
uniform mat4 toCells; uniform vec3 low, high; uniform bool nearest; uniform float opacity; in vec3 at; out vec4 o;
void main() {
  vec3 p = (toCells * vec4(at, 1.)).xyz;
  if (any(lessThan(p, low)) || any(greaterThan(p, high))) discard;
#ifdef EXACT
  float v = cell(ivec3(floor(p)));
  if (!shownValue(v)) discard;
  o = vec4(shade(p, v), opacity);
#else
  if (inside(p) < 0.) discard;
  o = vec4(shade(p, valueAt(p)), opacity);
#endif
}`;

/** Points that were drawn on the CPU: their colours and depths, a pixel each. */
export const splat = `precision highp float; uniform highp sampler2D colours, depths; in vec2 at; out vec4 o;
void main() { float d = texture(depths, at).r; if (d >= 1.) discard; o = vec4(texture(colours, at).rgb, 1.); gl_FragDepth = d; }`;

/** Scene, opaque and translucent volumes, one over the other. */
export const compose = `precision highp float; uniform sampler2D scene, solid, cloud, front; uniform float weight; in vec2 at; out vec4 o;
void main() {
  vec3 c = texture(scene, at).rgb; vec4 s = texture(solid, at), v = texture(cloud, at), f = texture(front, at);
  c = c * (1. - s.a) + s.rgb; c = c * (1. - v.a) + v.rgb; c = c * (1. - f.a) + f.rgb;
  o = vec4(c, 1.) * weight;
}`;

export const copy = `precision highp float; uniform sampler2D picture, front; in vec2 at; out vec4 o;
void main() { vec4 f = texture(front, at); o = vec4(texture(picture, at).rgb * (1. - f.a) + f.rgb, 1.); }`;
