// The direction through a point of the film; not of unit length.
vec3 camera_direction(vec2 position, Film film) {
  precise vec3 direction = film.corner + film.right * position.x + film.down * position.y;
  return direction;
}
