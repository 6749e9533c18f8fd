flat in vec4 v_sphere;
flat in float v_value, v_stain;
in vec3 v_ray;

uniform vec3 colour;
uniform float dim; // alpha of the hidden part of an overlay; 1 elsewhere

#if !DEPTH_ONLY
out vec4 result;
#endif

void main() {
#if DEPTH_ONLY == 2
  vec3 direction = normalize(vec3(shadow[0].z, shadow[1].z, shadow[2].z));
  vec3 across = v_ray - v_sphere.xyz;
  float inside = v_sphere.w * v_sphere.w - dot(across, across);
  if (inside < 0.0) discard;
  vec3 position = v_ray - direction * sqrt(inside);
  if (beyond_clip(position) > 0.0) position = v_ray + direction * sqrt(inside);
  if (beyond_clip(position) > 0.0) discard;
  vec4 clip = shadow * vec4(position, 1.0);
#else
  // The ray through this pixel from the eye: |t ray - centre| = radius, nearest t.
  vec3 ray = normalize(v_ray);
  float along = dot(ray, v_sphere.xyz);
  vec3 miss = v_sphere.xyz - along * ray;
  float inside = v_sphere.w * v_sphere.w - dot(miss, miss);
  if (inside < 0.0) discard;
  vec3 position = ray * (along - sqrt(inside));
  float facing = 1.0; // -1: the near side is cut away, and the far side is seen from within
  if (beyond_clip(position) > 0.0) {
    position = ray * (along + sqrt(inside));
    facing = -1.0;
    if (beyond_clip(position) > 0.0 || position.z > 0.0) discard;
  }
  vec4 clip = projection * vec4(position, 1.0);
#endif
#ifndef HIDDEN
  gl_FragDepth = 0.5 + 0.5 * clip.z / clip.w;
#endif
#if !DEPTH_ONLY
  vec3 normal = facing * (position - v_sphere.xyz) / v_sphere.w;
  vec3 albedo = v_value >= 0.0 ? scale_colour(v_value) : mix(colour, blood_colour, 0.9 * smoothstep(0.04, 0.8, 1.25 * v_stain));
#if QUALITY
  float open = ambient_open(), lit = light_reaches(position, normal);
  vec3 outcome = shade_tissue(albedo, 0.35, position, normal, normal, open, lit);
#else
  vec3 outcome = shade_plain(albedo, position, normal);
#endif
  result = finish(outcome * (0.8 + 0.2 * facing), dim);
#endif
}
