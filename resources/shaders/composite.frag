// Several samples a pixel, each turned into film before they are averaged: a bright glint must not outshine its edge.
uniform sampler2D colour_map, glow_map;

out vec4 result;

void main() {
  vec2 place = gl_FragCoord.xy / viewport.xy;
  vec3 glare = 0.22 * texture(glow_map, place).rgb, sum = vec3(0.0);
  float shade = vignette(gl_FragCoord.xy);
  ivec2 scale = textureSize(colour_map, 0) / ivec2(viewport.xy), first = ivec2(gl_FragCoord.xy) * scale;
  for (int y = 0; y < scale.y; y++)
    for (int x = 0; x < scale.x; x++)
      sum += tone_map((texelFetch(colour_map, first + ivec2(x, y), 0).rgb + glare) * shade);
  sum /= float(scale.x * scale.y);
  // One step of 8 bits is widest in light where it is dark on the screen; the noise follows.
  result = vec4(sum + dither(gl_FragCoord.xy) * 0.009 * (0.04 + sum), 1.0);
}
