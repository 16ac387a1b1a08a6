// Light that makes shape readable from every side: a sky and ground hemisphere, a key light that stands in the world,
// a fill light that goes with the camera, and a rim.
vec3 shade(vec3 albedo, vec3 normal, vec3 position, float gloss, float shine) {
  vec3 to_eye = normalize(frame.eye_alpha.xyz - position);
  vec3 key = frame.key_direction.xyz;
  vec3 sky = mix(vec3(0.16, 0.13, 0.12), vec3(0.36, 0.39, 0.44), 0.5 + 0.5 * normal.y);
  float key_light = max(dot(normal, key), 0.0);
  float fill_light = max(dot(normal, frame.fill_direction.xyz), 0.0);
  float facing = max(dot(normal, to_eye), 0.0);
  // Grazing surfaces see less of the sky here, where things crowd: outlines stay apart.
  sky *= mix(0.65, 1.0, smoothstep(0.0, 0.5, facing));
  vec3 light = sky + key_light * vec3(0.80, 0.76, 0.70) + fill_light * vec3(0.24, 0.26, 0.30);

  float rim = (1.0 - facing) * (1.0 - facing);
  rim *= rim;
  vec3 half_key = normalize(key + to_eye);
  vec3 half_fill = normalize(frame.fill_direction.xyz + to_eye);
  float highlight = shine * (pow(max(dot(normal, half_key), 0.0), gloss) * step(0.0, dot(normal, key)) +
                             0.35 * pow(max(dot(normal, half_fill), 0.0), gloss));
  vec3 colour = albedo * light + highlight + rim * 0.03 * vec3(0.8, 0.9, 1.0);
  // Rolls off softly above 0.7 instead of clipping.
  vec3 over = max(colour - 0.7, 0.0);
  return min(colour, 0.7) + 0.3 * (1.0 - exp(-over / 0.3));
}

// The share of light stopped by a shell of that opacity seen at this angle (cosine); more where it is seen grazing, so
// that its outline reads at any opacity.
float shell_opacity(float opacity, float facing) {
  float grazing = 1.0 - facing;
  float alpha = 1.0 - pow(1.0 - min(opacity, 0.999), 1.0 / max(facing, 0.14));
  return opacity >= 0.999 ? 1.0 : min(alpha + 0.25 * opacity * grazing * grazing, 1.0);
}

vec3 paint_back_face(vec3 colour) {
  return frame.target.w > 0.5 && !gl_FrontFacing ? vec3(1.0, 0.0, 1.0) : colour;
}
