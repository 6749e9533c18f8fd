// Ambient occlusion from the depth of the picture: how far neighbours rise above a point's tangent plane
// (McGuire et al. 2011, "The Alchemy screen-space ambient obscurance algorithm").
uniform sampler2D depth_map;

out vec4 result;

vec3 place(vec2 pixel) {
  float depth = 2.0 * texelFetch(depth_map, ivec2(clamp(pixel, vec2(0.0), viewport.xy - 1.0)), 0).r - 1.0;
  float z = -projection[3].z / (depth + projection[2].z);
  vec2 p = 2.0 * pixel / viewport.xy - 1.0;
  return vec3(-z * p.x / projection[0].x, -z * p.y / projection[1].y, z);
}

// The nearer of two differences, so that the edge of another surface does not tilt the normal.
vec3 slope(vec3 before, vec3 here, vec3 after) {
  vec3 a = here - before, b = after - here;
  return abs(a.z) < abs(b.z) ? a : b;
}

void main() {
  vec2 pixel = gl_FragCoord.xy;
  result = vec4(1.0);
  if (texelFetch(depth_map, ivec2(pixel), 0).r >= 1.0) return;
  vec3 here = place(pixel);
  vec3 along = slope(place(pixel - vec2(1, 0)), here, place(pixel + vec2(1, 0)));
  vec3 across = slope(place(pixel - vec2(0, 1)), here, place(pixel + vec2(0, 1)));
  vec3 normal = normalize(cross(across, along));
  float reach = 0.075 * light.w, pixels = min(reach / (-here.z * viewport.z), 0.25 * viewport.y);
  float turn = 6.2832 * (dither(pixel) + 0.5), sum = 0.0;
  const int SAMPLES = 20;
  for (int i = 0; i < SAMPLES; i++) {
    float share = (float(i) + 0.5) / float(SAMPLES), angle = turn + 2.39996 * float(i);
    vec3 to = place(floor(pixel + share * pixels * vec2(cos(angle), sin(angle))) + 0.5) - here;
    float d2 = dot(to, to), range = max(0.0, 1.0 - d2 / (reach * reach));
    sum += range * max(0.0, dot(to, normal) - 0.012 * reach) / (d2 + 0.004 * reach * reach) * share;
  }
  float open = 1.0 - min(1.0, 2.6 * sum * reach / float(SAMPLES));
  result = vec4(max(0.0, open));
}
