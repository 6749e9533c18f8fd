// The straight picture as a lens shows it: camera.c has the same mapping for what the mouse points at. Drops on the front
// bend light once more, blood dims and reddens it. Where drops lie depends on how much covers the front alone, so that a
// run that is repeated looks the same.
uniform sampler2D colour_map;

out vec4 result;

// Where the straight picture has what the lens shows there: 0..1 each way.
vec2 straightened(vec2 place) {
  vec2 p = 2.0 * place - 1.0, size = viewport.xy * viewport.xy;
  float off = dot(p * p, size) / (size.x + size.y);
  return 0.5 + 0.5 * p * (1.0 - lens.x) / (1.0 - lens.x * off);
}

// At most one drop in each cell of a grid over the front. xy: the slope of the drop there, 0 beside it; z: its thickness,
// 0..1. A cell has its drop once `covered` has come to the cell's turn; from then on the drop grows.
vec3 drop_at(vec2 at, float cells, float seed, float covered) {
  at.x += 0.37 * hash(vec3(floor(at.y * cells), seed, 5.0)); // no column of drops stands above another
  vec2 cell = floor(at * cells);
  float turn = hash(vec3(cell, seed)), size = smoothstep(0.0, 0.5, covered - turn);
  if (size == 0.0) return vec3(0.0);
  vec2 middle = 0.5 + 0.24 * (vec2(hash(vec3(cell, seed + 3.0)), hash(vec3(cell, seed + 7.0))) - 0.5);
  float radius = mix(0.10, 0.36, size) * (0.6 + 0.4 * hash(vec3(cell, seed + 11.0)));
  vec2 off = (fract(at * cells) - middle) / radius;
  off += 0.35 * (noise(vec3(at * cells * 3.0, seed)).yz * 0.5);
  float inside = 1.0 - dot(off, off);
  return inside > 0.0 ? vec3(off * inside, inside) : vec3(0.0);
}

void main() {
  vec2 place = gl_FragCoord.xy / viewport.xy, at = gl_FragCoord.xy / viewport.y;
#ifdef DRY
  result = vec4(texture(colour_map, straightened(place)).rgb, 1.0);
#else
  float blood = lens.y, water = lens.z;
  vec3 clear = drop_at(at, 4.0, 1.0, water) + drop_at(at, 9.0, 2.0, water);
  vec3 red = drop_at(at, 2.3, 4.0, blood) + drop_at(at, 5.0, 5.0, blood);
  // A smear between the drops: wider the more covers the front, and streaked the way the shaft was wiped by tissue.
  float streak = noise(vec3(at.x * 3.0 + at.y, at.y * 11.0 - at.x * 2.0, 0.5)).x;
  float smear = smoothstep(0.9 - blood, 1.5 - blood, 0.6 * noise(vec3(at * 2.6, 9.0)).x + 0.5 * streak);
  float veil = smoothstep(1.0 - water, 1.7 - water, noise(vec3(at * 2.2, 21.0)).x);
  vec2 seen = straightened(place) - 0.14 * clear.xy - 0.10 * red.xy;
  // What lies on the glass is out of focus, and so is what is seen through it.
  vec2 blur = (0.002 + 0.012 * smear + 0.010 * veil + 0.012 * red.z) * vec2(viewport.y / viewport.x, 1.0);
  vec3 colour = texture(colour_map, seen).rgb + texture(colour_map, seen + blur).rgb + texture(colour_map, seen - blur).rgb +
                texture(colour_map, seen + blur * vec2(1.0, -1.0)).rgb + texture(colour_map, seen - blur * vec2(1.0, -1.0)).rgb;
  colour *= 0.2;
  colour = mix(colour, vec3(dot(colour, vec3(0.33))) * 1.1 + 0.02, 0.25 * veil);
  // Blood lets red through (Beer and Lambert); where the lamp lights it from the front it is dark red itself.
  float thick = 1.3 * smear + 2.2 * red.z;
  colour = colour * exp(-thick * vec3(0.35, 2.6, 2.4)) + (1.0 - exp(-0.8 * thick)) * vec3(0.055, 0.003, 0.002);
  colour += 0.10 * max(0.0, dot(clear.xy, vec2(-0.8, -0.8)));
  result = vec4(colour, 1.0);
#endif
}
