// The straight picture as a lens shows it: camera.c has the same mapping for what the mouse points at.
uniform sampler2D colour_map;

out vec4 result;

// Where the straight picture has what the lens shows there: 0..1 each way.
vec2 straightened(vec2 place) {
  vec2 p = 2.0 * place - 1.0, size = viewport.xy * viewport.xy;
  float off = dot(p * p, size) / (size.x + size.y);
  return 0.5 + 0.5 * p * (1.0 - lens.x) / (1.0 - lens.x * off);
}

void main() { result = vec4(texture(colour_map, straightened(gl_FragCoord.xy / viewport.xy)).rgb, 1.0); }
