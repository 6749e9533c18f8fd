// Smoke: thick in the middle of a puff, wispy toward its rim, lit by the lamp from all through it.
flat in vec4 v_sphere;
flat in vec2 v_kind;
in vec3 v_position;
in vec2 v_corner;

uniform vec3 colour;
#if QUALITY
uniform sampler2D depth_map;
#endif

out vec4 result;

// How much of a puff stands before what is solid: it thins where it runs into that, and no edge is seen.
float before_solids() {
#if QUALITY
  float depth = texture(depth_map, gl_FragCoord.xy / viewport.xy).r;
  if (depth >= 1.0) return 1.0;
  float z = -projection[3].z / (2.0 * depth - 1.0 + projection[2].z);
  return clamp((v_position.z - z) / v_sphere.w, 0.0, 1.0);
#else
  return 1.0;
#endif
}

void main() {
  float inside = 1.0 - dot(v_corner, v_corner), strength;
  if (inside <= 0.0) discard;
  vec3 pattern = vec3(1.7 * v_corner + vec2(v_kind.y, 2.3 * v_kind.y), 3.1 * v_kind.y);
  float wisps = 0.65 * noise(pattern).x + 0.35 * noise(2.7 * pattern + 11.0).x;
  float density = inside * inside * smoothstep(0.28, 0.78, wisps);
  vec3 out_of_it = (v_position - v_sphere.xyz) / v_sphere.w - sqrt(inside) * normalize(v_sphere.xyz);
  float towards = dot(out_of_it, lamp(v_position, strength));
  vec3 lit = colour * ((0.75 + 0.3 * towards) * strength + 0.15);
  result = finish(lit, v_kind.x * density * before_solids());
}
