// From light to a pixel's colour, and noise for patterns.
const float PI = 3.14159265;
const vec3 blood_colour = vec3(0.24, 0.006, 0.006); // of what is wet with it

// Filmic curve x(x + t) / (x(x + u) + v): a toe that keeps dark tissue dark, a shoulder that keeps highlights coloured.
// A little of the brightest channel leaks into the others, as in film: strong red light turns toward white.
vec3 tone_map(vec3 colour) {
  float peak = max(colour.r, max(colour.g, colour.b));
  colour += 0.04 * peak * peak / (1.0 + peak);
  return colour * (colour + 0.12) / (colour * (colour + 0.46) + 0.30);
}

float vignette(vec2 pixel) {
  vec2 p = pixel / viewport.xy - 0.5;
  float d = dot(p, p);
  return 1.0 - viewport.w * d * (0.6 + d);
}

// Below one step of 8 bits: breaks up the bands of dark gradients.
float dither(vec2 pixel) { return fract(52.98 * fract(dot(pixel, vec2(0.0671, 0.00584)))) - 0.5; }

// Smoke between the lens and what is seen there, lit by the lamp.
vec3 behind_haze(vec3 colour) {
  if (lens.w == 0.0) return colour;
  float depth = projection[3][2] / (2.0 * gl_FragCoord.z - 1.0 + projection[2][2]);
  return mix(vec3(0.26, 0.235, 0.225), colour, pow(1.0 - lens.w, depth / light.w));
}

// What a pass writes. Full quality keeps linear light for the composite pass; else it ends here.
vec4 finish(vec3 colour, float alpha) {
#if QUALITY
  return vec4(behind_haze(colour), alpha);
#else
  return vec4(tone_map(behind_haze(colour) * vignette(gl_FragCoord.xy)), alpha);
#endif
}

float hash(vec3 p) {
  p = fract(p * 0.3183 + vec3(0.71, 0.113, 0.419));
  p *= 17.0;
  return fract(p.x * p.y * p.z * (p.x + p.y + p.z));
}

// Value noise in 0..1 with its gradient in yzw.
vec4 noise(vec3 p) {
  vec3 cell = floor(p), f = p - cell;
  vec3 w = f * f * (3.0 - 2.0 * f), dw = 6.0 * f * (1.0 - f);
  float a = hash(cell), b = hash(cell + vec3(1, 0, 0)), c = hash(cell + vec3(0, 1, 0)), d = hash(cell + vec3(1, 1, 0));
  float e = hash(cell + vec3(0, 0, 1)), g = hash(cell + vec3(1, 0, 1)), h = hash(cell + vec3(0, 1, 1)), i = hash(cell + vec3(1));
  float kx = b - a, ky = c - a, kz = e - a, kxy = a - b - c + d, kyz = a - c - e + h, kzx = a - b - e + g;
  float kxyz = b + c + e + i - a - d - g - h;
  return vec4(a + kx * w.x + ky * w.y + kz * w.z + kxy * w.x * w.y + kyz * w.y * w.z + kzx * w.z * w.x + kxyz * w.x * w.y * w.z,
              dw * vec3(kx + kxy * w.y + kzx * w.z + kxyz * w.y * w.z, ky + kyz * w.z + kxy * w.x + kxyz * w.z * w.x,
                        kz + kzx * w.x + kyz * w.y + kxyz * w.x * w.y));
}
