// Glare of the lens: what is brighter than white, blurred along one direction (0: only taken out and made smaller).
uniform sampler2D colour_map;
uniform vec2 direction;

out vec4 result;

void main() {
  vec2 size = vec2(textureSize(colour_map, 0));
  if (direction == vec2(0.0)) {
    vec2 place = gl_FragCoord.xy / viewport.xy;
    vec3 sum = vec3(0.0);
    for (int i = 0; i < 16; i++) {
      vec3 light_in = texture(colour_map, place + (vec2(i & 3, i >> 2) - 1.5) * 0.25 / viewport.xy).rgb;
      sum += min(max(light_in - 0.9, 0.0), 6.0);
    }
    result = vec4(sum / 16.0, 1.0);
    return;
  }
  vec3 sum = vec3(0.0);
  float weights = 0.0;
  for (int i = -12; i <= 12; i++) {
    float weight = exp(-float(i * i) / 40.0) + 0.25 * exp(-abs(float(i)) / 5.0);
    sum += weight * texture(colour_map, (gl_FragCoord.xy + direction * float(i)) / size).rgb;
    weights += weight;
  }
  result = vec4(sum / weights, 1.0);
}
