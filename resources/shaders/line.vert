// One instance a segment: a rectangle `width` pixels wide, clipped at the near plane before it is projected.
layout(location = 0) in vec3 from;
layout(location = 1) in vec3 to;

uniform vec3 offset;
uniform float width;
uniform float near;

out float v_across; // -1 .. 1 over the width and a pixel beside it
out vec3 v_position;

void main() {
  vec3 a = mat3(rotation) * (from + offset), b = mat3(rotation) * (to + offset);
  if (a.z > -near && b.z < -near) a = mix(b, a, (b.z + near) / (b.z - a.z));
  else if (b.z > -near && a.z < -near) b = mix(a, b, (a.z + near) / (a.z - b.z));
  vec4 clip_a = projection * vec4(a, 1.0), clip_b = projection * vec4(b, 1.0);
  bool end = (gl_VertexID & 1) == 1;
  float side = (gl_VertexID >> 1) == 1 ? 1.0 : -1.0;
  vec2 run = (clip_b.xy / clip_b.w - clip_a.xy / clip_a.w) * viewport.xy;
  float length2 = dot(run, run);
  vec2 normal = length2 > 1e-8 ? vec2(-run.y, run.x) * inversesqrt(length2) : vec2(1, 0);
  v_across = side;
  v_position = end ? b : a;
  gl_ClipDistance[0] = -beyond_clip(v_position);
  gl_Position = end ? clip_b : clip_a;
  gl_Position.xy += normal * side * (width + 1.0) / viewport.xy * gl_Position.w;
}
