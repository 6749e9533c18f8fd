#if DEPTH_ONLY
in vec3 v_position;
void main() {}
#else
in vec3 v_position, v_normal, v_rest;
in float v_mottle, v_value, v_stain;

uniform vec3 colour;
uniform float wetness;
uniform float clearness; // how much is seen of what lies behind
uniform vec4 mixture;    // colour and clearness of what a liquid is mixed with
uniform float cell;     // size of a pattern cell, m
uniform float selected; // 0 or 1
#ifdef ONLY // of one material; no values, nothing tinted, no stain on metal
const int material = ONLY;
const bool plain = true;
#else
uniform int material; // SporeMaterial
const bool plain = false;
#endif
uniform vec3 axis;      // streaks of brushed metal run along it, rest axes

#ifdef TEXTURED
in vec2 v_place;
uniform sampler2D texture_map;
const float patchiness = 0.2; // the picture has its own patches and vessels
#else
const float patchiness = 1.0;
#endif

out vec4 result;

// Noise that is finer than a pixel fades out instead of sparkling.
float detail(float frequency) {
  float footprint = -v_position.z * viewport.z * frequency / cell;
  return clamp(1.6 - 1.6 * footprint, 0.0, 1.0);
}

// 1 on a thread of that half width (pattern cells): where noise crosses its middle value.
float vessel(vec3 p, float width) {
  vec4 n = noise(p);
  return 1.0 - smoothstep(0.3 * width, width, abs(n.x - 0.5) / (0.15 + length(n.yzw)));
}

bool is_reached(vec3 place) {
  for (int i = 0; i < int(tint.w); i++) {
    vec3 way = place - cone_pivot[i].xyz, limits = cone_limits[i].xyz;
    float depth = length(way);
    if (depth >= limits.y && depth <= limits.z && dot(way, cone_along[i].xyz) >= depth * limits.x) return true;
  }
  return false;
}

// What is wet with blood shines; unevenly at its edge.
float soaked(float unevenness) {
  return smoothstep(0.04, 0.8, v_stain * (1.25 + unevenness));
}

// Each liquid takes its share of the light that comes through both (Beer and Lambert).
vec3 mixed(vec3 base) {
  return v_stain > 0.0 ? exp(mix(log(base + 1e-3), log(mixture.rgb + 1e-3), v_stain)) : base;
}

void main() {
  vec3 normal = normalize(gl_FrontFacing ? v_normal : -v_normal);
  float open = ambient_open(), lit = light_reaches(v_position, normal);
#ifdef TEXTURED
  vec3 base = colour * texture(texture_map, v_place).rgb;
#else
  vec3 base = colour;
#endif
  vec3 outcome;
  if (!plain && v_value >= 0.0) {
    outcome = shade_plain(scale_colour(v_value), v_position, normal);
  } else if (material == 2) {
    outcome = shade_tissue(mixed(base), wetness, v_position, normal, normal, open, lit);
  } else if (material == 1) {
    vec3 across = v_rest - axis * dot(v_rest, axis);
    vec3 streak = (noise(vec3(across * 60.0) + axis * dot(v_rest, axis) * 1.5).yzw) * 0.05 * detail(60.0);
    outcome = shade_metal(base, v_position, normal, mat3(rotation) * streak, open, lit);
    if (!plain && v_stain > 0.0)
      outcome = mix(outcome, shade_tissue(blood_colour, 1.0, v_position, normal, normal, open, lit), 0.9 * soaked(v_mottle - 0.5));
  } else {
    // Blood shows through unevenly: pale and dark patches, and a fine grain.
    vec4 grain = noise(v_rest * 2.7);
    float patches = patchiness * (v_mottle - 0.5 + 0.22 * (grain.x - 0.5));
    float blood = clamp(1.5 * (base.r - base.g) / (base.r + 0.001), 0.1, 1.0);
    vec3 albedo = base * (1.0 + mix(vec3(0.75), vec3(0.75, 1.5, 1.4), blood) * patches);
#if QUALITY
    vec4 broad = noise(v_rest * 1.1 + 5.3), fine = noise(v_rest * 7.3 + 3.1);
    albedo *= 1.0 + patchiness * vec3(0.16, 0.24, 0.24) * (fine.x - 0.5) * detail(7.3);
    float thread = vessel(v_rest * 1.15 + 0.14 * grain.yzw + 0.03 * fine.yzw + 11.0, 0.022 + 0.025 * broad.x);
    thread *= smoothstep(0.47, 0.66, v_mottle + 0.25 * (broad.x - 0.5)) * detail(6.0);
    albedo *= mix(vec3(1.0), vec3(0.72, 0.42, 0.46), 0.55 * patchiness * thread * blood);
    vec3 bump = broad.yzw * 0.16 + grain.yzw * 0.11 * detail(2.7) + fine.yzw * 0.030 * detail(7.3);
    bump += noise(v_rest * 17.0).yzw * 0.012 * detail(17.0);
#else
    vec3 bump = grain.yzw * 0.11 * detail(2.7);
#endif
    float wet = soaked(1.4 * (v_mottle - 0.5) + 1.2 * (grain.x - 0.5));
    albedo = mix(albedo, blood_colour, 0.9 * wet);
    bump = mat3(rotation) * bump * (1.0 - 0.3 * wet);
    bump -= normal * dot(normal, bump);
    if (!plain && tint.w > 0.0 && !is_reached(v_position)) albedo = mix(albedo, tint.rgb, 0.75);
    outcome = shade_tissue(max(albedo, 0.0), mix(wetness, max(wetness, 0.7), wet), v_position, normalize(normal - 0.25 * bump), normalize(normal - bump), open, lit);
  }
  // Behind a cut, the inside is told from the outside.
  if (!gl_FrontFacing && dot(clip_plane.xyz, clip_plane.xyz) > 0.0) outcome *= 0.6;
  float rim = 1.0 - clamp(dot(normal, normalize(-v_position)), 0.0, 1.0);
  outcome += selected * vec3(0.10, 0.42, 1.0) * (0.04 + 0.9 * rim * rim * rim);
  // Through water one sees less at a low angle, and nothing behind a glint.
  float glint = smoothstep(0.9, 2.0, max(outcome.r, max(outcome.g, outcome.b)));
  float clear = material == 2 && clearness > 0.0 ? mix(clearness, mixture.a, v_stain) : clearness;
  float covers = mix(1.0, max(0.8 * rim * rim * rim, glint), clear);
  result = finish(outcome, covers);
}
#endif
