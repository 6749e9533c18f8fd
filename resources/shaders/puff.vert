// One instance a puff: a square through its middle that faces the eye.
layout(location = 0) in vec4 sphere; // camera-relative centre needs `offset`; w: radius
layout(location = 1) in vec2 kind;   // opacity, seed of its pattern

uniform vec3 offset;

flat out vec4 v_sphere; // view space
flat out vec2 v_kind;
out vec3 v_position; // on the square, view space
out vec2 v_corner;   // -1..1

void main() {
  v_corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 centre = mat3(rotation) * (sphere.xyz + offset);
  vec3 forward = centre * inversesqrt(max(dot(centre, centre), 1e-12));
  vec3 right = normalize(cross(forward, abs(forward.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  v_position = centre + sphere.w * (v_corner.x * right + v_corner.y * cross(right, forward));
  v_sphere = vec4(centre, sphere.w);
  v_kind = kind;
  gl_ClipDistance[0] = -beyond_clip(centre);
  gl_Position = projection * vec4(v_position, 1.0);
}
