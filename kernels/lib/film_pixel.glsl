// Exact while the quotient is below 2^22: the estimate is one off at most. CPU devices divide integers lane by lane.
uvec2 divided(uint value, uint divisor, float inverse) {
  uint quotient = uint(float(value) * inverse);
  int rest = int(value - quotient * divisor);
  if (rest < 0) return uvec2(quotient - 1u, uint(rest) + divisor);
  return uint(rest) < divisor ? uvec2(quotient, rest) : uvec2(quotient + 1u, uint(rest) - divisor);
}

// The pixel of a picture's ray, see FILM_STRIP.
uvec2 film_pixel(uint ray, Film film) {
  uint strip_rays = FILM_STRIP * film.width;
  uvec2 strip = divided(ray, strip_rays, 1.0 / float(strip_rays));
  uint rows = min(FILM_STRIP, film.height - strip.x * FILM_STRIP);
  uvec2 column = divided(strip.y, rows, 1.0 / float(rows));
  return uvec2(column.x, strip.x * FILM_STRIP + column.y);
}
