// Dark and warm, lighter behind the middle, as if the lamp reached the far wall; or pale, as paper.
out vec4 result;

void main() {
  vec2 p = gl_FragCoord.xy / viewport.xy - vec2(0.5, 0.45);
  float glow = 1.0 / (1.0 + 5.0 * dot(p, p));
  vec3 colour = mix(vec3(0.018, 0.011, 0.011), vec3(0.125, 0.078, 0.070), glow * glow);
  if (backdrop.x > 0.0) colour = mix(vec3(0.78, 0.80, 0.83), vec3(1.0), glow);
  result = finish(colour, 1.0);
#if !QUALITY
  result.rgb += dither(gl_FragCoord.xy) * 0.0012;
#endif
}
