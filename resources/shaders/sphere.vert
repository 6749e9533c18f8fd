// One instance a sphere: a square that faces the eye and just covers the sphere's outline in perspective.
layout(location = 0) in vec4 sphere; // camera-relative centre needs `offset`; w: radius
layout(location = 1) in float value;
layout(location = 2) in float stain; // 0..1: how much blood covers it

uniform vec3 offset;

flat out vec4 v_sphere; // view space
flat out float v_value, v_stain;
out vec3 v_ray;         // through the square, view space

void main() {
  vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1) * 2.0 - 1.0;
  vec3 centre = mat3(rotation) * (sphere.xyz + offset);
  float radius = sphere.w, d2 = max(dot(centre, centre), 1e-12);
#if DEPTH_ONLY == 2
  // Orthographic light: the square stands across its direction, through the centre.
  vec3 forward = normalize(vec3(shadow[0].z, shadow[1].z, shadow[2].z));
  float grow = 1.0;
#else
  vec3 forward = centre * inversesqrt(d2);
  float grow = inversesqrt(max(1.0 - radius * radius / d2, 0.04));
#endif
  vec3 right = normalize(cross(forward, abs(forward.y) < 0.9 ? vec3(0, 1, 0) : vec3(1, 0, 0)));
  v_ray = centre + radius * grow * (corner.x * right + corner.y * cross(right, forward));
  v_sphere = vec4(centre, radius);
  v_value = value;
  v_stain = stain;
#if DEPTH_ONLY == 2
  gl_Position = shadow * vec4(v_ray, 1.0);
#else
  gl_Position = projection * vec4(v_ray, 1.0);
#ifdef HIDDEN
  float back = centre.z - radius;
  gl_Position.z = min(-(projection[2].z * back + projection[3].z) / back, 0.99999) * gl_Position.w;
#endif
#endif
}
