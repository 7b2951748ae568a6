#pragma once

#include <algorithm>

#include "interface/trace.h"

namespace coppice::twins {

// The pixel of a picture's ray, see FILM_STRIP; found by counting the strips.
inline uvec2 film_pixel(uint ray, const Film& film) {
  uint top = 0, rows = std::min(FILM_STRIP, film.height);
  while (ray >= rows * film.width) {
    ray -= rows * film.width;
    top += rows;
    rows = std::min(FILM_STRIP, film.height - top);
  }
  return {ray / rows, top + ray % rows};
}

}  // namespace coppice::twins
