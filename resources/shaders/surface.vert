layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec4 rest; // xyz: place at rest in pattern cells, so that the pattern sticks; w: slow mottling 0..1
layout(location = 3) in float value; // of the scale of colours, 0..1; below 0: tissue
layout(location = 4) in float stain; // 0..1: how much blood covers it
#ifdef TEXTURED
layout(location = 5) in vec2 place; // in the texture
out vec2 v_place;
#endif

uniform vec3 offset; // of the mesh's origin from the eye, world axes

out vec3 v_position;
#if !DEPTH_ONLY
out vec3 v_normal, v_rest;
out float v_mottle, v_value, v_stain;
#endif

void main() {
  v_position = mat3(rotation) * (position + offset);
#if DEPTH_ONLY == 2
  gl_Position = shadow * vec4(v_position, 1.0);
#else
  gl_Position = projection * vec4(v_position, 1.0);
#endif
  gl_ClipDistance[0] = -beyond_clip(v_position);
#if !DEPTH_ONLY
  v_normal = mat3(rotation) * normal;
  v_rest = rest.xyz;
  v_mottle = rest.w;
  v_value = value;
  v_stain = stain;
#ifdef TEXTURED
  v_place = place;
#endif
#endif
}
