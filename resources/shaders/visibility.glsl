// How much of the room (ambient_open) and of the lamp (light_reaches) a point sees; 1 is all.
#if QUALITY
uniform sampler2D occlusion_map;
uniform sampler2DShadow shadow_map;

float ambient_open() { return texture(occlusion_map, gl_FragCoord.xy / viewport.xy).r; }

// Sixteen taps on a disc, turned from pixel to pixel: a soft edge instead of steps.
float light_reaches(vec3 position, vec3 normal) {
  if (up.w == 0.0) return 1.0;
  vec4 clip = shadow * vec4(position + normal * light.w * 0.004, 1.0);
  vec3 place = clip.xyz / clip.w * 0.5 + 0.5;
  float turn = 6.2832 * dither(gl_FragCoord.xy), reach = 0.0045, sum = 0.0;
  for (int i = 0; i < 16; i++) {
    float angle = turn + 2.39996 * float(i), radius = reach * sqrt((float(i) + 0.5) / 16.0);
    sum += texture(shadow_map, vec3(place.xy + radius * vec2(cos(angle), sin(angle)), place.z - 0.0008));
  }
  return sum / 16.0;
}
#else
float ambient_open() { return 1.0; }
float light_reaches(vec3 position, vec3 normal) { return 1.0; }
#endif
