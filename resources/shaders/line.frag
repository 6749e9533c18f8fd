in float v_across;
in vec3 v_position;

uniform vec3 colour;
uniform float width;
uniform float dim;
uniform float fade; // distance at which a line has vanished, m; 0: never

out vec4 result;

void main() {
  float alpha = clamp((1.0 - abs(v_across)) * 0.5 * (width + 1.0), 0.0, 1.0) * dim;
  if (fade > 0.0) alpha *= clamp(1.0 - length(v_position) / fade, 0.0, 1.0);
  result = finish(colour, alpha);
}
