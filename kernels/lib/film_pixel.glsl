// The pixel of a picture's ray, see FILM_STRIP.
uvec2 film_pixel(uint ray, Film film) {
  uint strip = ray / (FILM_STRIP * film.width);
  uint rows = min(FILM_STRIP, film.height - strip * FILM_STRIP);
  uint in_strip = ray - strip * FILM_STRIP * film.width;
  uint column = rows == FILM_STRIP ? in_strip / FILM_STRIP : in_strip / rows;
  return uvec2(column, strip * FILM_STRIP + in_strip - column * rows);
}
