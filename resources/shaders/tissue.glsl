// Light on living tissue and on metal, in view space.

// Microfacet lobe, GGX distribution with the height-correlated Smith term approximated by a mix (Hammon 2017).
float ggx(float n_h, float n_v, float n_l, float alpha) {
  float a2 = alpha * alpha, d = n_h * n_h * (a2 - 1.0) + 1.0;
  return a2 / (PI * d * d) * 0.5 / mix(2.0 * n_l * n_v, n_l + n_v, alpha);
}

float schlick(float cosine, float normal_reflectance) {
  float x = 1.0 - cosine, x2 = x * x;
  return normal_reflectance + (1.0 - normal_reflectance) * x2 * x2 * x;
}

// Camera light beside the lens: direction and strength, gently weaker with distance.
vec3 lamp(vec3 position, out float strength) {
  vec3 to_light = light.xyz - position;
  float d2 = dot(to_light, to_light), reference = light.w * light.w;
  strength = 2.0 * reference / (reference + d2);
  strength *= 0.4 + 0.6 * strength;
  return to_light * inversesqrt(d2);
}

// What a mirror sees: a dim warm room with one soft box, up and to the left behind the viewer.
vec3 room(vec3 direction, float box) {
  vec3 walls = mix(vec3(0.050, 0.030, 0.026), vec3(0.15, 0.135, 0.125), 0.5 + 0.5 * dot(direction, up.xyz));
  float inside = clamp(dot(direction, vec3(-0.38, 0.75, 0.54)) * 5.0 - 3.9, 0.0, 1.0);
  return walls + box * vec3(1.0, 0.96, 0.90) * inside * inside;
}

// albedo: linear light; film: normal of the wet film; open: 1 where nothing occludes; lit: 0 in shadow.
vec3 shade_tissue(vec3 albedo, float wetness, vec3 position, vec3 normal, vec3 film, float open, float lit) {
  float strength;
  vec3 view = normalize(-position), to_light = lamp(position, strength), halfway = normalize(view + to_light);
  float n_v = clamp(dot(normal, view), 0.02, 1.0), n_l = dot(normal, to_light), positive = clamp(n_l, 0.0, 1.0);
  // Light that enters comes out farther on, red farther than green and blue: each channel wraps by its own width.
  const vec3 wrap = vec3(0.34, 0.10, 0.08);
  vec3 diffuse = clamp((n_l + wrap) / ((1.0 + wrap) * (1.0 + wrap)), 0.0, 1.0);
  diffuse = mix(diffuse * vec3(0.30, 0.05, 0.04), diffuse, lit);
  // The lens carries a weaker light of its own: what faces the viewer is never black.
  diffuse = diffuse * 1.25 * mix(0.6 + 0.4 * open, 1.0, lit * 0.5) + 0.22 * n_v * n_v * open;
  vec3 ambient = mix(vec3(0.055, 0.028, 0.025), vec3(0.125, 0.115, 0.110), 0.5 + 0.5 * dot(normal, up.xyz));
  // Occluded tissue is lit by tissue: it reddens rather than greys.
  ambient *= pow(vec3(open), vec3(0.8, 1.3, 1.35));
  // Light that leaves at a low angle has travelled longer through blood: deeper colour toward the outline.
  float longer = 1.0 - n_v;
  vec3 colour = albedo * mix(vec3(1.0), vec3(0.80, 0.48, 0.46), longer * longer) * (diffuse * strength + ambient);
  float rough = ggx(clamp(dot(normal, halfway), 0.0, 1.0), n_v, max(positive, 0.02), 0.30) * positive * 0.065;
  float f_v = clamp(dot(film, view), 0.02, 1.0), f_l = clamp(dot(film, to_light), 0.0, 1.0);
  float wet = min(ggx(clamp(dot(film, halfway), 0.0, 1.0), f_v, max(f_l, 0.02), FILM_ALPHA), 60.0) * f_l * lit;
  wet = wet * 2.6 + min(ggx(f_v, f_v, f_v, FILM_ALPHA), 60.0) * f_v * 0.45;
  wet *= schlick(clamp(dot(view, halfway), 0.0, 1.0), 0.028) * wetness;
  colour += (rough * lit + wet) * strength;
  colour += room(reflect(-view, film), 1.7 * lit) * schlick(f_v, 0.028) * (0.15 + 0.85 * wetness) * open;
  return colour;
}

// As tissue, for many small things at little cost.
vec3 shade_plain(vec3 albedo, vec3 position, vec3 normal) {
  float strength;
  vec3 to_light = lamp(position, strength);
  float n_l = dot(normal, to_light), glint = clamp(n_l * 1.9 - 0.9, 0.0, 1.0);
  vec3 diffuse = clamp((n_l + vec3(0.34, 0.10, 0.08)) / vec3(1.8, 1.21, 1.17), 0.0, 1.0);
  glint *= glint * glint;
  glint *= glint;
  return albedo * (diffuse * (1.25 * strength) + 0.15 + 0.06 * dot(normal, up.xyz)) + 0.16 * glint * glint;
}

// Brushed steel: streaks run along the instrument; the lobe is stretched across them.
vec3 shade_metal(vec3 tint, vec3 position, vec3 normal, vec3 streak, float open, float lit) {
  float strength;
  vec3 view = normalize(-position), to_light = lamp(position, strength), halfway = normalize(view + to_light);
  vec3 bent = normalize(normal + streak), mirrored = reflect(-view, bent);
  float n_v = clamp(dot(bent, view), 0.05, 1.0), n_l = clamp(dot(bent, to_light), 0.0, 1.0);
  float sharp = ggx(clamp(dot(bent, halfway), 0.0, 1.0), n_v, max(n_l, 0.05), 0.10) * n_l;
  float broad = ggx(clamp(dot(bent, halfway), 0.0, 1.0), n_v, max(n_l, 0.05), 0.35) * n_l;
  vec3 reflectance = tint + (1.0 - tint) * schlick(n_v, 0.0);
  // A bright strip above, the dark of the cavity at the sides, the red of the organs below.
  float height = dot(mirrored, up.xyz), strip = clamp(1.0 - abs(height - 0.55) * 2.6, 0.0, 1.0);
  vec3 mirror = vec3(0.03, 0.022, 0.02) + vec3(0.95, 0.94, 0.92) * strip * strip;
  mirror += vec3(0.20, 0.065, 0.05) * clamp(-0.2 - height, 0.0, 1.0) + room(mirrored, 0.5);
  return reflectance * (mirror * (0.25 + 0.75 * open) + (0.5 * sharp + 0.8 * broad) * lit) * strength;
}
