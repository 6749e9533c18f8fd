// Blurs occlusion along one direction, but not over edges of depth.
uniform sampler2D depth_map; // occlusion_map: visibility.glsl
uniform vec2 direction;

out vec4 result;

float distance_at(ivec2 pixel) {
  return projection[3].z / (2.0 * texelFetch(depth_map, pixel, 0).r - 1.0 + projection[2].z);
}

void main() {
  ivec2 pixel = ivec2(gl_FragCoord.xy), last = ivec2(viewport.xy) - 1;
  float here = distance_at(pixel), sum = 0.0, weights = 0.0;
  for (int i = -4; i <= 4; i++) {
    ivec2 other = clamp(pixel + ivec2(direction) * i, ivec2(0), last);
    float apart = abs(distance_at(other) - here) / (0.02 * light.w);
    float weight = exp(-0.09 * float(i * i)) * max(0.0, 1.0 - apart);
    sum += weight * texelFetch(occlusion_map, other, 0).r;
    weights += weight;
  }
  result = vec4(sum / max(weights, 1e-4));
}
