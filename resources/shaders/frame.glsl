// Shared by every pass. Positions are in metres, camera-relative: the eye is at the origin of view space and looks along -z.
// The picture is drawn upside down (projection flips y), so that rows are read back top first.
layout(std140) uniform Frame {
  mat4 projection;
  mat4 rotation;  // world axes to view axes
  mat4 shadow;    // view space to the light's clip space
  vec4 light;     // view space; w: distance of the target, m
  vec4 viewport;  // width, height, size of a pixel at distance 1, strength of the vignette
  vec4 up;        // world's up in view space; w: shadow map is there
  vec4 clip_plane; // view space: hides what lies where this is above 0; zeros hide nothing
  vec4 tint;       // colour of what no cone reaches; w: number of cones, 0: nothing is tinted
  vec4 lens;       // its distortion; shares that blood and water cover; that haze takes from the target's light
  vec4 backdrop;   // 1: light; 0: dark
  vec4 cone_pivot[32], cone_along[32], cone_limits[32]; // view space; limits: cosine of the angle, least and most, m
};

// Above 0: the plane hides the place.
float beyond_clip(vec3 position) { return dot(clip_plane.xyz, position) + clip_plane.w; }
